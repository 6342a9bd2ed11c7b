#include "rollfix/locate_request.hpp"

#include "rollfix/typed_number.hpp"

namespace rollfix::app {

Tolerance tolerance_of(const LocateArguments& arguments, const Part& part, const std::vector<Rounding>& roundings) {
  return arguments.tolerance.empty() ? tolerance_from_rounding(part, roundings)
                                     : tolerance_from_option(arguments.tolerance);
}

std::size_t budget_of(const LocateArguments& arguments, std::size_t by_default) {
  return arguments.budget.empty() ? by_default : read_count(arguments.budget, "--budget", 1);
}

ExitCode exit_code_of(bool complete, bool anything_fits) {
  if (!complete) return ExitCode::incomplete;
  return anything_fits ? ExitCode::fits : ExitCode::nothing_fits;
}

void add_direction_notes(const Part& part, bool lengths_turned_round, Report& report) {
  if (part.reversed()) report.notes.push_back(reversed_note(part));
  if (lengths_turned_round) report.notes.emplace_back("the log's lengths changed their signs to match");
}

}  // namespace rollfix::app
