#pragma once

#include <string>
#include <vector>

#include "rollfix/arguments/output_argument.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/output/report.hpp"

namespace rollfix::app {

/// How the answer to touches is wanted.
struct TouchOutput {
  OutputArgument figure;
  bool json = false;
  bool verbose = false;
  std::string certificate{};  // the name of its file; empty: none
};

/// `locate` of touches without rolling: the poses that fit. Throws InputError.
Report locate_touches(const std::vector<std::string>& touches, const RollArguments& arguments,
                      const TouchOutput& output);

}  // namespace rollfix::app
