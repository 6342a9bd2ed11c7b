#include "rollfix/locate/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "corner_sets.hpp"
#include "placements.hpp"
#include "rollfix/error.hpp"
#include "root_search.hpp"
#include "sweep.hpp"

namespace rollfix {
namespace {

/// The first contacts whose rolls stay on the part: all of a closed outline, of an open one what leaves room for
/// every reading.
Interval first_contacts(const Part& part, const std::vector<Reading>& readings) {
  if (readings.empty()) throw InputError("expected at least one reading (length, turn), found none");
  Interval range{0, part.perimeter()};
  for (const Reading& reading : readings) {
    if (!std::isfinite(reading.length) || !std::isfinite(reading.turn)) {
      throw InputError(fmt::format("expected a reading of two finite numbers, found length {}, turn {}", reading.length,
                                   reading.turn));
    }
    if (part.closed()) continue;
    if (std::abs(reading.length) > part.perimeter() * (1 + kLengthAccuracy)) {
      throw InputError(
          fmt::format("expected a roll no longer than the open curve {}, {:.9g}; found length {:.9g}: "
                      "check the units, or whether the curve should be closed",
                      part.name(), part.perimeter(), reading.length));
    }
    range.lo = std::max(range.lo, -reading.length);
    range.hi = std::min(range.hi, part.perimeter() - reading.length);
  }
  range.hi = std::max(range.lo, range.hi);
  return range;
}

/// Keeps of each piece what a further reading allows as well.
void narrow(const Part& part, const Reading& reading, RootSearch& search, Findings& findings,
            const LocateOptions& options) {
  std::vector<Piece> before;
  before.swap(findings.pieces);
  std::vector<Piece> kept;
  for (const Piece& piece : before) {
    if (!findings.unresolved.empty()) {
      findings.unresolved.push_back({piece.lo, piece.hi});
    } else if (piece.lo == piece.hi) {
      if (residual_at(part, {reading}, piece.lo) <= options.tolerance) kept.push_back(piece);
    } else {
      findings.pieces.clear();
      sweep(part, reading, {piece.lo, piece.hi}, search, findings, options);
      for (Piece& part_of_piece : findings.pieces) {
        part_of_piece.exact = part_of_piece.exact && piece.exact;
        kept.push_back(part_of_piece);
      }
    }
  }
  findings.pieces = std::move(kept);
}

/// A first contact at a convex corner: the finger may have pivoted there by any amount, the same for all readings.
void add_start_corners(const Part& part, const std::vector<Reading>& readings, const Interval& range,
                       Findings& findings, const LocateOptions& options) {
  for (const Corner& corner : part.corners()) {
    if (corner.is_concave() || !range.contains(corner.s)) continue;
    const double residual = residual_at(part, readings, corner.s);
    if (residual > std::max(options.tolerance, kTurnAccuracy)) continue;
    findings.pieces.push_back({corner.s, corner.s, false, true});
    findings.roots.push_back({corner.s, residual <= kTurnAccuracy, true});
  }
}

/// The same intervals, those that touch made one.
std::vector<Interval> joined(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& one, const Interval& two) { return one.lo < two.lo; });
  std::vector<Interval> result;
  for (const Interval& interval : intervals) {
    if (!result.empty() && interval.lo <= result.back().hi) {
      result.back().hi = std::max(result.back().hi, interval.hi);
    } else {
      result.push_back(interval);
    }
  }
  return result;
}

/// On a smooth closed part f is continuous and periodic: it crosses 0 evenly often.
void check_parity(const Part& part, const std::vector<Reading>& readings, Search& search) {
  if (!part.closed() || !part.corners().empty() || readings.size() > 1) return;
  const auto crosses = [](const Placement& placement) { return placement.kind == Kind::crossing; };
  const bool all_cross = std::all_of(search.placements.begin(), search.placements.end(), crosses);
  if (all_cross && search.placements.size() % 2 != 0 && search.placements.front().extent.width() < part.perimeter()) {
    search.status = Status::incomplete;
    search.unresolved.push_back({0, part.perimeter()});
  }
}

}  // namespace

Search locate(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options) {
  const Interval range = first_contacts(part, readings);
  Findings findings;
  findings.pieces.reserve(16);
  findings.roots.reserve(16);
  RootSearch root_search(options, part.perimeter(), findings);
  sweep(part, readings.front(), range, root_search, findings, options);
  for (std::size_t k = 1; k < readings.size(); ++k) narrow(part, readings[k], root_search, findings, options);
  add_start_corners(part, readings, range, findings, options);

  Search search;
  search.placements = make_placements(part, readings, std::move(findings.pieces), findings.roots);
  search.unresolved = joined(std::move(findings.unresolved));
  search.status = search.unresolved.empty() ? Status::complete : Status::incomplete;
  search.counts = findings.counts;
  if (search.status == Status::complete) check_parity(part, readings, search);
  return search;
}

Search locate(const Part& part, const Reading& reading, const LocateOptions& options) {
  return locate(part, std::vector<Reading>{reading}, options);
}

std::string Search::verdict() const {
  if (status == Status::incomplete) return "undecided";
  if (placements.empty()) return "inconsistent";
  if (placements.size() > 1) return fmt::format("ambiguous ({})", placements.size());
  const Placement& only = placements.front();
  if (only.whole_loop) return "unobservable";
  return only.kind == Kind::stretch ? "ambiguous (1 stretch)" : "unique";
}

}  // namespace rollfix
