#include <algorithm>
#include <utility>

#include "searches.hpp"
#include "sets_of_one.hpp"
#include "sweep.hpp"

namespace rollfix {
namespace {

/// Keeps of each piece what a further reading allows as well.
Findings narrowed(const Part& part, const Reading& reading, Findings before, LocateOptions& options) {
  const std::vector<Reading> only{reading};
  Findings kept = std::move(before);
  const std::vector<Piece> pieces = std::exchange(kept.pieces, {});
  for (const Piece& piece : pieces) {
    if (!kept.unresolved.empty()) {
      kept.unresolved.push_back({piece.lo, piece.hi});
    } else if (piece.lo == piece.hi) {
      if (residual_at({part, only}, piece.lo) <= options.tolerance) kept.pieces.push_back(piece);
    } else {
      Swept swept = sweep(part, reading, {piece.lo, piece.hi}, options);
      options.budget = swept.budget;
      for (Piece& part_of_piece : swept.findings.pieces) {
        part_of_piece.exact = part_of_piece.exact && piece.exact;
        kept.pieces.push_back(part_of_piece);
      }
      const Findings& found = swept.findings;
      kept.roots.insert(kept.roots.end(), found.roots.begin(), found.roots.end());
      kept.unresolved.insert(kept.unresolved.end(), found.unresolved.begin(), found.unresolved.end());
      kept.counts.intervals += found.counts.intervals;
      kept.counts.evaluations += found.counts.evaluations;
    }
  }
  return kept;
}

/// A first contact at a convex corner: the finger may have pivoted there by any amount, the same for all readings.
void add_start_corners(const Question& question, const Interval& range, double tolerance, Findings& findings) {
  for (const Corner& corner : question.part.corners()) {
    if (corner.is_concave() || !range.contains(corner.s)) continue;
    const double residual = residual_at(question, corner.s);
    if (residual > tolerance) continue;
    findings.pieces.push_back({corner.s, corner.s, false, true});
    findings.roots.push_back({corner.s, residual <= kTurnAccuracy, true});
  }
}

/// The same intervals, those that touch made one.
std::vector<PerFinger<Interval>> joined(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& one, const Interval& two) { return one.lo < two.lo; });
  std::vector<PerFinger<Interval>> result;
  for (const Interval& interval : intervals) {
    if (!result.empty() && interval.lo <= result.back()[0].hi) {
      result.back()[0].hi = std::max(result.back()[0].hi, interval.hi);
    } else {
      result.emplace_back(interval);
    }
  }
  return result;
}

}  // namespace

Search search_one(const Question& question, const LocateOptions& options) {
  const Interval range = first_contacts(question, 0);
  Swept swept = sweep(question.part, question.readings.front(), range, options);
  Findings found = std::move(swept.findings);
  LocateOptions left = options;
  left.budget = swept.budget;
  for (std::size_t k = 1; k < question.readings.size(); ++k) {
    found = narrowed(question.part, question.readings[k], std::move(found), left);
  }
  add_start_corners(question, range, options.tolerance, found);

  Search search;
  search.placements = make_placements(question, std::move(found.pieces), found.roots);
  search.unresolved = joined(std::move(found.unresolved));
  search.counts = found.counts;
  return search;
}

}  // namespace rollfix
