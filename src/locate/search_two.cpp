#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "locate/pair/box_search.hpp"
#include "locate/pair/components.hpp"
#include "locate/pair/roll_curve.hpp"
#include "outline/turn.hpp"
#include "searches.hpp"
#include "work/pulse.hpp"

namespace rollfix::locating {

/// First contacts at which several contacts of one finger stand at convex corners and pivot independently: there its
/// curve is a patch, and the other finger's curve can run through the patch's inside. Looks where, to the resolution
/// of the part, on every patch of `patched`; `patched_is_a` says which finger that is. Halving takes from the budget.
void search_patches(const RollCurve& patched, PlaneCurve& other, bool patched_is_a, const PairLimits& limits,
                    std::size_t& budget, PairFindings& findings);

/// Both fingers on a patch each: each pair of them that fits within the tolerance is one place, not an interval.
void add_corner_pairs(const ContactEquations& question, const RollCurve& a, const RollCurve& b,
                      const PairLimits& limits, PairFindings& findings);

// Notation:
//   patch           what A becomes where several contacts of finger a stand at convex corners and pivot independently
//   tau             the tangent's angle at the patched finger's first contact: anything in `tangents.front()`
//   phi_k           the same at its contact after reading k, with the shift: anything in `tangents[k + 1]`, on its own
//   b_k             the other finger's component k, on a node an interval: `values[k]`
// Equations: phi_k - tau = b_k for each reading, and tau = b + `lap` for the facing, `lap` being whole turns less the
// facing. Each of them confines tau to an interval (`wanted`).
// Follows eqs. (8) and (9) of the paper (Jia, IROS 2001) with Theta set-valued at convex corners; docs/search.md, "Two
// fingers", step 6.
// Idea: intervals on a line have a common point when each two of them have (Helly's theorem in one dimension), so that
// tau exists when the worst gap between two intervals is 0. That is bounded over nodes of the other finger's tree.

namespace {

// The other contact is told apart to this share of the perimeter: where the curvature is 1,000 / P, to 1e-10 rad.
constexpr double kResolution = 1e-13;
// A continuum shorter than this share of the perimeter can't be told from a place.
constexpr double kShortestContinuum = 1e-9;

/// How far tau is from fitting every component, radians, while the other curve's values are in given ranges: 0 where
/// some tau fits all of them.
class PatchFit {
 public:
  PatchFit(const RollPatch& patch, const PairLimits& limits) : patch_(patch), limits_(limits) {}

  /// `sure`: an upper bound, for every value in the ranges; else a lower bound, for the best of them.
  double slack(const std::vector<Range>& values, bool sure) const {
    return least(values, [&](double lap) { return slack_of_all(values, sure, lap); });
  }

  /// A lower bound on the slack on a node of one piece, from each two components together: both contain Theta at the
  /// first contact, which cancels in their difference and which bounds on each alone do not know.
  double slack_of_two(const PlaneCurve& curve, std::int32_t index, const std::vector<Range>& values) const {
    return least(values, [&](double lap) { return slack_of_each_two(curve, index, lap); });
  }

 private:
  /// The least slack over the whole turns that the facing leaves open: those that bring the other finger's first
  /// tangent near to tau. Two neighbours are tried, for both may have wide ranges that meet at either end.
  template <class Slack>
  double least(const std::vector<Range>& values, const Slack& slack) const {
    if (!limits_.facing) return slack(0);
    const double behind = patch_.tangents.front().middle() - values.back().middle() + patch_.facing;
    const double lap = kFullTurn * std::floor(behind / kFullTurn) - patch_.facing;
    return std::min(slack(lap), slack(lap + kFullTurn));
  }

  bool is_facing(std::size_t row, std::size_t rows) const { return limits_.facing && row + 1 == rows; }

  /// The worst gap between two of the intervals that confine tau. The patch's own set of tau does not give way, so a
  /// gap to it counts whole; two other intervals share theirs.
  double slack_of_all(const std::vector<Range>& values, bool sure, double lap) const {
    // With `sure` the interval holds the tau that fit every value in the range; it may be empty, most below least.
    std::vector<Range> wanted{patch_.tangents.front()};
    for (std::size_t row = 0; row < values.size(); ++row) {
      const Range& value = values[row];
      if (is_facing(row, values.size())) {
        wanted.push_back(sure ? Range{value.most + lap, value.least + lap}
                              : Range{value.least + lap, value.most + lap});
      } else {
        const Range& end = patch_.tangents[row + 1];
        wanted.push_back(sure ? Range{end.least - value.least, end.most - value.most}
                              : Range{end.least - value.most, end.most - value.least});
      }
    }
    double worst = 0;
    for (std::size_t one = 0; one < wanted.size(); ++one) {
      for (std::size_t two = 0; two < wanted.size(); ++two) {
        if (two == one) continue;
        const double gap = wanted[one].least - wanted[two].most;
        worst = std::max(worst, one == 0 || two == 0 ? gap : 0.5 * gap);
      }
    }
    return worst;
  }

  /// The same worst gap from differences of two components, phi_p - phi_q = b_p - b_q, in which tau cancels; with the
  /// facing row, phi_p - lap = b_p + b.
  double slack_of_each_two(const PlaneCurve& curve, std::int32_t index, double lap) const {
    const double width = curve.node(index).width();
    const PlaneCurve::Component* of = curve.components(index);
    double worst = 0;
    for (std::size_t p = 0; p + 1 < curve.rows(); ++p) {
      const Range& end = patch_.tangents[p + 1];
      for (std::size_t q = p + 1; q < curve.rows(); ++q) {
        const bool faces = is_facing(q, curve.rows());
        const Range value = PlaneCurve::Combination{1, faces ? 1.0 : -1.0, of[p], of[q]}.value(width);
        const Range wanted = faces ? end - Range{lap, lap} : end - patch_.tangents[q + 1];
        worst = std::max({worst, 0.5 * (wanted.least - value.most), 0.5 * (value.least - wanted.most)});
      }
    }
    return worst;
  }

  const RollPatch& patch_;
  const PairLimits& limits_;
};

/// The components at one end of a node, `first` or `last`, as ranges without width.
std::vector<Range> values_at(const PlaneCurve& curve, std::int32_t index, double PlaneCurve::Component::*end) {
  std::vector<Range> values;
  for (std::size_t row = 0; row < curve.rows(); ++row) {
    const double value = curve.components(index)[row].*end;
    values.push_back({value, value});
  }
  return values;
}

/// One patch against the other finger's whole curve: nodes of that curve's tree are excluded, listed as pieces, or
/// halved, depth first.
class PatchSearch {
 public:
  PatchSearch(const RollPatch& patch, PlaneCurve& other, bool patched_is_a, const PairLimits& limits,
              std::size_t& budget, PairFindings& findings)
      : patch_(patch),
        other_(other),
        patched_is_a_(patched_is_a),
        limits_(limits),
        budget_(budget),
        findings_(findings),
        fit_(patch, limits),
        values_(other.rows()) {}

  /// Decides all of the other curve's tree.
  void run() {
    waiting_.push_back(other_.root());
    while (!waiting_.empty()) {
      const std::int32_t index = waiting_.back();
      waiting_.pop_back();
      decide(index);
    }
  }

 private:
  /// Excludes a node, takes it as a piece, or halves it.
  void decide(std::int32_t index) {
    beat();
    ++findings_.counts.intervals;
    for (std::size_t row = 0; row < values_.size(); ++row) values_[row] = other_.components(index)[row].value;
    // On a wider node more than the two neighbouring whole turns can fit.
    const bool one_lap = !limits_.facing || values_.back().spread() <= std::numbers::pi;
    if (one_lap && fit_.slack(values_, false) > limits_.tolerance) return;
    const PlaneCurve::Node node = other_.node(index);
    // Nodes over many pieces come with the part: they cost nothing of the budget.
    if (!node.on_one_piece()) {
      halve(index);
      return;
    }
    if (one_lap && fit_.slack_of_two(other_, index, values_) > limits_.tolerance) return;
    if ((one_lap && fits_all_along(index)) || node.width() <= finest(node)) {
      take(node);
    } else if (budget_ == 0) {
      findings_.unresolved.push_back(box_of(node));
    } else {
      --budget_;
      halve(index);
    }
  }

  /// Is the tolerance kept everywhere on the node?
  bool fits_all_along(std::int32_t index) const {
    if (fit_.slack(values_, true) <= limits_.tolerance) return true;
    // The patch is convex and a pivot's curve is straight: it is inside where both of its ends are.
    const auto fits_at = [&](double PlaneCurve::Component::*end) {
      return fit_.slack(values_at(other_, index, end), true) <= limits_.tolerance;
    };
    return other_.pivot_at(other_.node(index)) && fits_at(&PlaneCurve::Component::first) &&
           fits_at(&PlaneCurve::Component::last);
  }

  /// Nodes are halved down to this width: a share of the perimeter, or of a radian where the finger pivots.
  double finest(const PlaneCurve::Node& node) const {
    return kResolution * (other_.pivot_at(node) ? 1 : limits_.perimeter);
  }

  /// The patched finger stands at the patch's corner; the other one is anywhere on the node, or at its own corner.
  PairBox box_of(const PlaneCurve::Node& node) const {
    const std::optional<double> pivot_at = other_.pivot_at(node);
    const Interval here{patch_.s, patch_.s};
    const Interval there{pivot_at.value_or(node.lo), pivot_at.value_or(node.hi)};
    return patched_is_a_ ? PairBox{here, there} : PairBox{there, here};
  }

  /// Lists the node as a piece with a root at its start; as a continuum where it is wide and f can be 0 all along it.
  void take(const PlaneCurve::Node& node) {
    PairPiece found;
    found.box = box_of(node);
    found.corner = true;
    const double width = found.box[patched_is_a_ ? 1 : 0].width();
    if (width > kShortestContinuum * limits_.perimeter && fit_.slack(values_, true) <= kTurnAccuracy) {
      found.exact = true;  // the pivots make up for whatever the other contact does there
      found.line = {{found.box[0].lo, found.box[1].lo}, {found.box[0].hi, found.box[1].hi}};
    }
    findings_.roots.push_back({{found.box[0].lo, found.box[1].lo}, 0, true});
    findings_.pieces.push_back(std::move(found));
  }

  void halve(std::int32_t index) {
    const auto [left, right] = other_.halves(index);
    // Depth first, the left half next.
    for (const std::int32_t half : {right, left}) {
      if (half >= 0) waiting_.push_back(half);
    }
  }

  const RollPatch& patch_;
  PlaneCurve& other_;
  bool patched_is_a_;
  const PairLimits& limits_;
  std::size_t& budget_;
  PairFindings& findings_;
  PatchFit fit_;
  std::vector<Range> values_;  // of the node that is looked at
  std::vector<std::int32_t> waiting_;
};

}  // namespace

void search_patches(const RollCurve& patched, PlaneCurve& other, bool patched_is_a, const PairLimits& limits,
                    std::size_t& budget, PairFindings& findings) {
  if (other.root() < 0) return;
  for (const RollPatch& patch : patched.patches()) {
    PatchSearch(patch, other, patched_is_a, limits, budget, findings).run();
  }
}

void add_corner_pairs(const ContactEquations& question, const RollCurve& a, const RollCurve& b,
                      const PairLimits& limits, PairFindings& findings) {
  for (const RollPatch& on_a : a.patches()) {
    for (const RollPatch& on_b : b.patches()) {
      const PairPoint at{on_a.s, on_b.s};
      // Both fingers' pivots as sets, all readings together.
      if (residual_at(question, at) > limits.tolerance) continue;
      PairPiece piece;
      piece.box = {Interval{at[0], at[0]}, Interval{at[1], at[1]}};
      piece.corner = true;
      findings.pieces.push_back(piece);
      findings.roots.push_back({at, 0, true});
    }
  }
}

// ---- two fingers
// Notation:
//   s, t            first contacts of finger a and of finger b
//   A(s), B(t)      the two fingers' curves, eqs. (8) and (9) being A(s) = B(t): `a`, `b`, with a component for each
//                   reading, Theta(s + La_k) - Theta(s) and Theta(t + Lb_k) - Theta(t) + theta_k, and for the facing
// Follows eqs. (8) and (9) of the paper (Jia, IROS 2001); docs/search.md, "Two fingers".
// Idea: boxes of (s, t), of which both sides are bounded by a tree over each curve, are decided or halved; where pivots
// at corners make patches of a curve, these are searched besides. What touches is one placement.

namespace {

/// Eqs. (8) and (9) as two curves that meet: of finger a with nothing added, of finger b with the turns.
RollEquations equations_of(const ContactEquations& question, std::size_t finger) {
  RollEquations equations;
  for (const Reading& reading : question.readings) {
    equations.lengths.push_back(reading.length[finger]);
    equations.shifts.push_back(finger == 0 ? 0 : reading.turn);
  }
  if (question.facing) equations.facing = finger == 0 ? 0 : *question.facing;
  return equations;
}

}  // namespace

Search search_two(const ContactEquations& question, const LocateOptions& options) {
  const Part& part = question.part;
  PairLimits limits;
  limits.tolerance = options.tolerance;
  limits.perimeter = part.perimeter();
  limits.same_place = kLengthAccuracy * part.perimeter();
  limits.facing = question.facing.has_value();

  const Interval range_a = first_contacts(question, 0);
  const Interval range_b = first_contacts(question, 1);
  RollCurve a(part, equations_of(question, 0), range_a);
  RollCurve b(part, equations_of(question, 1), range_b);
  PairFindings findings;
  std::size_t budget = options.budget;
  // All pairs (s, t), with at most one contact of each finger that pivots; then first contacts at which several
  // contacts of a finger pivot at once.
  PairBoxSearch(a, b, limits, budget, findings).run();
  search_patches(a, b, true, limits, budget, findings);
  search_patches(b, a, false, limits, budget, findings);
  add_corner_pairs(question, a, b, limits, findings);

  Search search;
  // Connected sets of what all of these found are the placements.
  search.placements = make_placements(question, join_pieces(part, findings, limits.same_place));
  for (const PairBox& box : findings.unresolved) search.unresolved.emplace_back(box);
  search.counts = findings.counts;
  search.counts.evaluations = a.evaluations() + b.evaluations();
  return search;
}

}  // namespace rollfix::locating
