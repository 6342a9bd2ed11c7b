#include "rollfix/locate/placement.hpp"

#include <fmt/format.h>

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
  const char* noun = stretches == 1 ? "stretch" : "stretches";
  if (stretches == 0) return fmt::format("ambiguous ({})", places);
  if (places == 1) return "ambiguous (1 stretch)";
  return fmt::format("ambiguous ({}, of them {} {})", places, stretches, noun);
}

Verdict Search::verdict() const {
  if (status == Status::incomplete) return {Verdict::undecided};
  if (placements.empty()) return {Verdict::inconsistent};
  std::size_t stretches = 0;
  for (const Placement& placement : placements) {
    for (const bool whole_loop : placement.whole_loop) {
      if (whole_loop) return {Verdict::unobservable};
    }
    stretches += placement.kind == Kind::stretch ? 1 : 0;
  }
  if (placements.size() == 1 && stretches == 0) return {Verdict::unique, 1};
  // Several placements of one finger are counted alike, whatever their kinds.
  if (placements.size() > 1 && placements.front().start.size() == 1) stretches = 0;
  return {Verdict::ambiguous, placements.size(), stretches};
}

}  // namespace rollfix
