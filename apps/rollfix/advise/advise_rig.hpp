#pragma once

#include <optional>

#include "rollfix/arguments/output_argument.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/output/report.hpp"

namespace rollfix::app {

/// `advise` of a jaw beside a wheel without skin: how its pin moves next. `travel`: as typed. Throws InputError.
Report advise_rig(const RollArguments& arguments, const std::string& travel, const OutputArgument& output, bool json);

}  // namespace rollfix::app
