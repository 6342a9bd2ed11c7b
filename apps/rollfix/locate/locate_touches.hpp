#pragma once

#include <string>
#include <vector>

#include "rollfix/arguments/output_argument.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/outline/outline.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix::app {

/// How the answer to touches is wanted.
struct TouchOutput {
  OutputArgument figure;
  bool json = false;
  bool verbose = false;
  std::string certificate{};  // the name of its file; empty: none
};

/// Throws InputError: outputs that don't go together, or a certificate's file that exists.
void require_outputs(const TouchOutput& output);

/// The answer to touches and rolls, in the form that is wanted. `report` has the notes so far.
Report report_of(const TouchProblem& problem, std::vector<Outline> others, const TouchOutput& output, Report report);

/// `locate` of touches without rolling: the poses that fit. Throws InputError.
Report locate_touches(const std::vector<std::string>& touches, const RollArguments& arguments,
                      const TouchOutput& output);

}  // namespace rollfix::app
