#include "rollfix/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "searches.hpp"

// The facade: what is asked is judged, searched, and what was found is counted.
// Notation:
//   f, f_k          as in search_one.cpp and corner_sets.cpp: eqs. (4), (5), (8) and (9) of the paper (Jia, IROS 2001)
//   parity          on a smooth closed part f is continuous and periodic, so that it crosses 0 evenly often; likewise
//                   two closed plane curves meet evenly often: an odd number of crossings is a search gone wrong
// Follows docs/search.md, "Once per reading" and "Two fingers".
namespace rollfix::locating {
namespace {

/// Throws InputError: a length or a turn that is not finite.
void require_finite(const Reading& reading) {
  bool finite = std::isfinite(reading.turn);
  for (const double length : reading.length) finite = finite && std::isfinite(length);
  if (finite) return;
  if (reading.fingers() == 1) {
    throw InputError(fmt::format("expected a reading of two finite numbers, found length {}, turn {}",
                                 reading.length[0], reading.turn));
  }
  throw InputError(fmt::format("expected a reading of three finite numbers, found lengths {} and {}, turn {}",
                               reading.length[0], reading.length[1], reading.turn));
}

/// Headings are never further apart than pi: a facing with so wide a tolerance would say nothing.
void require_tolerance(const LocateOptions& options) {
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance)) {
    throw InputError(fmt::format("expected a finite tolerance of at least 0, found {}", options.tolerance));
  }
  if (options.facing && !(options.tolerance < 0.5 * kFullTurn)) {
    throw InputError(fmt::format(
        "expected a tolerance below half a turn, as every facing is within that; found {:.6g} rad, which is "
        "{:.6g} deg: radians, or degrees?",
        options.tolerance, options.tolerance / kDegree));
  }
}

// A larger facing, as a double, is off by more than the turn's accuracy.
constexpr double kMostFacing = 1e6;

/// Throws InputError: readings or a facing that do not determine places. One finger needs one reading; two fingers have
/// two unknown contacts, so they need two equations, of which the facing can be one.
void require_enough(std::span<const Reading> readings, const LocateOptions& options) {
  if (readings.empty()) {
    throw InputError(
        "expected at least one reading (length, turn), of two fingers two (length a, length "
        "b, turn), found none");
  }
  for (const Reading& reading : readings) {
    require_finite(reading);
    if (reading.fingers() != readings.front().fingers()) {
      throw InputError("expected readings of one finger or of two, found both");
    }
  }
  if (readings.front().fingers() == 2 &&
      !std::all_of(readings.begin(), readings.end(), [](const Reading& reading) { return reading.is_exact(); })) {
    throw InputError(
        "expected readings of two fingers off the corners of both, found one on a corner, where its turn is not known; "
        "choose other instants of the log (`at`)");
  }
  if (readings.front().fingers() == 1) {
    if (options.facing) throw InputError("`facing`: compares two fingers, found readings of one");
    return;
  }
  if (options.facing && !std::isfinite(*options.facing)) {
    throw InputError(fmt::format("expected a finite facing angle, found {}", *options.facing));
  }
  if (options.facing && std::abs(*options.facing) > kMostFacing) {
    throw InputError(fmt::format(
        "expected a facing of at most {:.0f} rad, found {:.6g}: whole turns say nothing, and so many leave no digits "
        "for the rest; check the units",
        kMostFacing, *options.facing));
  }
  if (readings.size() == 1 && !options.facing) {
    throw InputError(
        "expected at least two readings of two fingers, found one: one equation for two unknown contacts leaves a "
        "curve of answers; give a second reading or the facing angle");
  }
}

/// Marks a search as incomplete if it counts an odd number of crossings. A smooth closed part's f is continuous and
/// periodic, so it crosses 0 an even number of times, and so do two closed plane curves. The test is left out where a
/// placement is not one single crossing, for open parts, for parts with corners, and with more equations than unknowns.
void check_parity(const ContactEquations& question, Search& search) {
  const Part& part = question.part;
  if (!part.closed() || !part.corners().empty() || question.rows() != question.fingers()) return;
  const bool one_finger = question.fingers() == 1;
  const bool all_cross =
      std::all_of(search.placements.begin(), search.placements.end(), [&](const Placement& placement) {
        const bool simple = one_finger ? !placement.whole_loop[0] : placement.roots.size() == 1;
        return placement.kind == Kind::crossing && simple;
      });
  if (!all_cross || search.placements.size() % 2 == 0) return;
  search.status = Status::incomplete;
  // One is missing or one is too many, and it is not known where: the whole boundary is unresolved.
  search.unresolved.push_back(PerFinger<Interval>::of(question.fingers(), {0, part.perimeter()}));
}

}  // namespace

namespace {

/// Checks the question, searches, and sets the status: complete only if nothing is unresolved and the parity is right.
Search search(const Part& part, std::span<const Reading> readings, const LocateOptions& options) {
  require_enough(readings, options);
  require_tolerance(options);
  LocateOptions clamped = options;
  clamped.tolerance = std::max(options.tolerance, kLeastTolerance);
  ContactEquations question{part, readings};
  if (options.facing) question.facing = without_laps(*options.facing);
  Search search = question.fingers() == 1 ? search_one(question, clamped) : search_two(question, clamped);
  search.status = search.unresolved.empty() ? Status::complete : Status::incomplete;
  if (search.status == Status::complete) check_parity(question, search);
  return search;
}

}  // namespace

}  // namespace rollfix::locating

namespace rollfix {

Search locate(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options) {
  return locating::search(part, readings, options);
}

Search locate(const Part& part, const Reading& reading, const LocateOptions& options) {
  return locating::search(part, {&reading, 1}, options);
}

}  // namespace rollfix
