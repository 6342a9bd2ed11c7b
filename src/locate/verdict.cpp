#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "rollfix/locate.hpp"
#include "rollfix/turning_function.hpp"

// What placements come to, and how that is said.
namespace rollfix {

const char* name_of(Status status) { return status == Status::complete ? "complete" : "incomplete"; }

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::crossing:
      return "crossing";
    case Kind::touching:
      return "touching";
    case Kind::stretch:
      return "stretch";
    case Kind::corner:
      break;
  }
  return "corner";
}

std::string Verdict::text() const {
  const bool is_said = fits_badly && name != inconsistent;  // where nothing fits, nothing fits badly
  return is_said ? places_text() + ", but the rows fit badly" : places_text();
}

std::string Verdict::places_text() const {
  switch (name) {
    case unique:
      return "unique";
    case unobservable:
      return "unobservable";
    case inconsistent:
      return "inconsistent";
    case undecided:
      return "undecided";
    case ambiguous:
      break;
  }
  // Places and stretches are counted together; the stretches among them are named.
  const char* noun = stretches == 1 ? "stretch" : "stretches";
  if (stretches == 0) return fmt::format("ambiguous ({})", places);
  if (places == 1) return "ambiguous (1 stretch)";
  return fmt::format("ambiguous ({}, of them {} {})", places, stretches, noun);
}

bool Placement::contains(const Boundary& boundary, const PerFinger<double>& s) const {
  const double slack = kLengthAccuracy * boundary.perimeter;
  for (std::size_t finger = 0; finger < s.size(); ++finger) {
    // Without noise probability is NaN: then the extent, else the 95 % interval.
    const Interval& arc = std::isnan(probability) ? extent[finger] : interval[finger];
    if (!boundary.is_full(arc) && !boundary.contains(arc, s[finger], slack)) return false;
  }
  return true;
}

Verdict verdict_of(Status status, const std::vector<Placement>& placements) {
  if (status == Status::incomplete) return {Verdict::undecided};
  std::size_t count = 0;
  std::size_t stretches = 0;
  for (const Placement& placement : placements) {
    if (placement.is_contradicted) continue;
    // All of a loop fits: such a roll can't tell the place, whatever else is found.
    for (const bool whole_loop : placement.whole_loop) {
      if (whole_loop) return {Verdict::unobservable};
    }
    ++count;
    stretches += placement.kind == Kind::stretch ? 1 : 0;
  }
  if (count == 0) return {Verdict::inconsistent};
  if (count == 1 && stretches == 0) return {Verdict::unique, 1};
  // Several placements of one finger are counted alike, whatever their kinds.
  if (count > 1 && placements.front().start.size() == 1) stretches = 0;
  return {Verdict::ambiguous, count, stretches};
}

}  // namespace rollfix
