#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rollfix/error.hpp"
#include "searches.hpp"

// Where rolls of these lengths can start.
// Notation: P, L, perimeter, and a reading's length; first contacts of an open outline: [max -L, P - max L].
namespace rollfix::locating {
namespace {

// A perimeter is known to its rounding, which each lap of a roll adds once more: after so many laps that is as much as
// a placement may be off.
constexpr double kMostLaps = 1e6;

/// Throws InputError: it can't be told where on the closed part such a roll ends.
void require_lengths_that_tell(const ContactEquations& question, std::size_t finger) {
  const double most = kMostLaps * question.part.perimeter();
  for (const Reading& reading : question.readings) {
    const double length = reading.length[finger];
    if (std::abs(length) <= most) continue;
    throw InputError(fmt::format(
        "expected a roll of no more than {:.0f} laps of {}, whose perimeter is {:.9g}; found length {:.9g}: "
        "check the units",
        kMostLaps, question.part.name(), question.part.perimeter(), length));
  }
}

}  // namespace

Interval first_contacts(const ContactEquations& question, std::size_t finger) {
  const Part& part = question.part;
  // Every s of a closed part can start every roll: s and s + P are one place.
  Interval range{0, part.perimeter()};
  if (part.closed()) {
    require_lengths_that_tell(question, finger);
    return range;
  }
  for (const Reading& reading : question.readings) {
    const double length = reading.length[finger];
    if (std::abs(length) > part.perimeter() * (1 + kLengthAccuracy)) {
      throw InputError(
          fmt::format("expected a roll no longer than the open curve {}, {:.9g}; found length {:.9g}: "
                      "check the units, or whether the curve should be closed",
                      part.name(), part.perimeter(), length));
    }
    // Both s and s + L are on the curve, 0 <= s + L <= P. A roll as long as the curve leaves one place.
    range.lo = std::max(range.lo, -length);
    range.hi = std::min(range.hi, part.perimeter() - length);
  }
  range.hi = std::max(range.lo, range.hi);
  return range;
}

}  // namespace rollfix::locating
