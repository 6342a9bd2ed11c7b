#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rollfix/arguments/output_argument.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/output/report.hpp"

namespace rollfix::app {

/// `advise` of a jaw beside a wheel without skin: how its pin moves next. `travel`: as typed. Throws InputError.
Report advise_rig(const RollArguments& arguments, const std::string& travel, const OutputArgument& output, bool json);

/// `advise` of touches without rolling: which approach tells the remaining poses apart. `approaches`: as typed.
/// Throws InputError.
Report advise_touches(const std::vector<std::string>& touches, const RollArguments& arguments,
                      const std::vector<std::string>& approaches, const OutputArgument& output, bool json);

}  // namespace rollfix::app
