#include "rollfix/documents.hpp"

namespace rollfix {

std::string format_solution(const Solution& solution, Layout layout, bool explain) {
  if (solution.at_rest() != nullptr) return format_touches(*solution.at_rest(), layout);
  if (solution.moving() != nullptr) return format_hold(*solution.moving(), layout);
  return format_answer(*solution.roll(), layout, explain);
}

}  // namespace rollfix
