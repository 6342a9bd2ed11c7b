#include "rollfix/locate/locate_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "pair/box_search.hpp"
#include "pair/components.hpp"
#include "pair/pair_placements.hpp"
#include "pair/pair_residual.hpp"
#include "pair/patch_search.hpp"
#include "pair/roll_curve.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace {

void require_enough(const std::vector<PairReading>& readings, const PairOptions& options) {
  for (const PairReading& reading : readings) {
    if (!std::isfinite(reading.length_a) || !std::isfinite(reading.length_b) || !std::isfinite(reading.turn)) {
      throw InputError(fmt::format("expected a reading of three finite numbers, found lengths {} and {}, turn {}",
                                   reading.length_a, reading.length_b, reading.turn));
    }
  }
  if (options.facing && !std::isfinite(*options.facing)) {
    throw InputError(fmt::format("expected a finite facing angle, found {}", *options.facing));
  }
  if (readings.empty()) {
    throw InputError("expected at least two readings (length a, length b, turn) of two fingers, found none");
  }
  if (readings.size() == 1 && !options.facing) {
    throw InputError(
        "expected at least two readings of two fingers, found one: one equation for two unknown contacts leaves a "
        "curve of answers; give a second reading or the facing angle");
  }
}

/// The first contacts of one finger whose rolls stay on the part.
Interval first_contacts(const Part& part, const std::vector<double>& lengths) {
  Interval range{0, part.perimeter()};
  if (part.closed()) return range;
  for (const double length : lengths) {
    if (std::abs(length) > part.perimeter() * (1 + kLengthAccuracy)) {
      throw InputError(
          fmt::format("expected rolls no longer than the open curve {}, {:.9g}; found length {:.9g}: "
                      "check the units, or whether the curve should be closed",
                      part.name(), part.perimeter(), length));
    }
    range.lo = std::max(range.lo, -length);
    range.hi = std::min(range.hi, part.perimeter() - length);
  }
  range.hi = std::max(range.lo, range.hi);
  return range;
}

/// On a smooth closed part the two curves are closed: they cross evenly often.
void check_parity(const Part& part, std::size_t rows, PairSearch& search) {
  if (!part.closed() || !part.corners().empty() || rows != 2) return;
  const bool all_cross = std::all_of(search.placements.begin(), search.placements.end(), [](const auto& placement) {
    return placement.kind == Kind::crossing && placement.roots.size() == 1;
  });
  if (!all_cross || search.placements.size() % 2 == 0) return;
  search.status = Status::incomplete;
  search.unresolved.push_back({Interval{0, part.perimeter()}, Interval{0, part.perimeter()}});
}

/// A corner of one finger's against a corner of the other's: places, not intervals.
void add_corner_pairs(const Part& part, const std::vector<PairReading>& readings, std::optional<double> facing,
                      const RollCurve& a, const RollCurve& b, const PairLimits& limits, PairFindings& findings) {
  for (const RollPatch& on_a : a.patches()) {
    for (const RollPatch& on_b : b.patches()) {
      const PairPoint at{on_a.s, on_b.s};
      if (pair_residual(part, readings, facing, at) > limits.tolerance) continue;
      PairPiece piece;
      piece.box = {Interval{at[0], at[0]}, Interval{at[1], at[1]}};
      piece.corner = true;
      findings.pieces.push_back(piece);
      findings.roots.push_back({at, 0, true});
    }
  }
}

}  // namespace

PairSearch locate(const Part& part, const std::vector<PairReading>& readings, const PairOptions& options) {
  require_enough(readings, options);
  RollEquations equations_a;
  RollEquations equations_b;
  for (const PairReading& reading : readings) {
    equations_a.lengths.push_back(reading.length_a);
    equations_a.shifts.push_back(0);
    equations_b.lengths.push_back(reading.length_b);
    equations_b.shifts.push_back(reading.turn);
  }
  // Whole turns are nothing to it, and a huge angle's would be lost in rounding.
  std::optional<double> facing;
  if (options.facing) {
    facing = std::remainder(*options.facing, 2 * std::numbers::pi);
    equations_a.facing = 0;
    equations_b.facing = facing;
  }
  PairLimits limits;
  limits.tolerance = std::max(options.tolerance, kTurnAccuracy);
  limits.perimeter = part.perimeter();
  limits.same_place = kLengthAccuracy * part.perimeter();
  limits.facing = facing.has_value();

  const Interval range_a = first_contacts(part, equations_a.lengths);
  const Interval range_b = first_contacts(part, equations_b.lengths);
  RollCurve a(part, equations_a, range_a);
  RollCurve b(part, equations_b, range_b);
  PairFindings findings;
  BoxSearch(a, b, limits, options.budget, findings).run();
  search_patches(a, b, true, limits, findings);
  search_patches(b, a, false, limits, findings);
  add_corner_pairs(part, readings, facing, a, b, limits, findings);

  const std::vector<PairCluster> clusters = join_pieces(part, findings, limits.same_place);
  PairSearch search;
  search.placements = make_pair_placements(part, readings, facing, clusters);
  search.unresolved = std::move(findings.unresolved);
  search.status = search.unresolved.empty() ? Status::complete : Status::incomplete;
  search.counts = findings.counts;
  search.counts.evaluations = a.evaluations() + b.evaluations();
  if (search.status == Status::complete) check_parity(part, equations_a.rows(), search);
  return search;
}

std::string PairSearch::verdict() const {
  if (status == Status::incomplete) return "undecided";
  if (placements.empty()) return "inconsistent";
  std::size_t stretches = 0;
  for (const PairPlacement& placement : placements) {
    if (placement.whole_loop[0] || placement.whole_loop[1]) return "unobservable";
    stretches += placement.kind == Kind::stretch ? 1 : 0;
  }
  if (placements.size() == 1) return stretches == 1 ? "ambiguous (1 stretch)" : "unique";
  if (stretches == 0) return fmt::format("ambiguous ({})", placements.size());
  return fmt::format("ambiguous ({}, of them {} {})", placements.size(), stretches,
                     stretches == 1 ? "stretch" : "stretches");
}

}  // namespace rollfix
