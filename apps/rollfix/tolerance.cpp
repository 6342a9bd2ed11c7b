#include "rollfix/tolerance.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rollfix/error.hpp"
#include "rollfix/locate/locate.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {

Tolerance tolerance_from_rounding(const Part& part, const std::vector<Rounding>& roundings) {
  const double least = LocateOptions().tolerance;
  const double most_curvature = part.turning().most_curvature();
  double value = 0;
  for (const Rounding& rounding : roundings) {
    value = std::max(value, rounding.turn + rounding.length * most_curvature);
  }
  if (value <= least) return {least, "default"};
  return {value, "from the digits given"};
}

Tolerance tolerance_from_option(const std::string& text) {
  const double value = read_angle(text, "--tolerance");
  if (value < 0) throw InputError(fmt::format("--tolerance: '{}' is negative, expected an angle of at least 0", text));
  return {std::max(value, kTurnAccuracy), value < kTurnAccuracy ? "the least there is" : "as given"};
}

}  // namespace rollfix::app
