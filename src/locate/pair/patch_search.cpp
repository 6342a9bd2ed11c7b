#include "patch_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"

namespace rollfix {
namespace {

// The other contact is told apart to this share of the perimeter: where the curvature is 1,000 / P, to 1e-10 rad.
constexpr double kResolution = 1e-13;
// A continuum shorter than this share of the perimeter can't be told from a place.
constexpr double kShortestContinuum = 1e-9;

/// How far the first contact's tangent must be from fitting every component, at least or at most, while the other
/// curve's values are in these ranges. On a line, sets meet when each two of them do.
class PatchFit {
 public:
  PatchFit(const RollPatch& patch, const PairLimits& limits) : patch_(patch), limits_(limits) {}

  /// `sure`: for every value in the ranges, else for some.
  double slack(const std::vector<Range>& values, bool sure) const {
    const Range& start = patch_.tangents.front();
    std::vector<Range> wanted{start};
    for (std::size_t row = 0; row < values.size(); ++row) {
      const Range& value = values[row];
      if (limits_.facing && row + 1 == values.size()) {
        const double middle = value.middle() - patch_.facing;
        const double lap = kFullTurn * std::round((start.middle() - middle) / kFullTurn) - patch_.facing;
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

 private:
  const RollPatch& patch_;
  const PairLimits& limits_;
};

std::vector<Range> values_at(const RollPoint& point) {
  std::vector<Range> values;
  for (const double value : point.value) values.push_back({value, value});
  return values;
}

}  // namespace

void search_patches(const RollCurve& patched, RollCurve& other, bool patched_is_a, const PairLimits& limits,
                    PairFindings& findings) {
  if (other.root() < 0) return;
  std::vector<Range> values(other.rows());
  for (const RollPatch& patch : patched.patches()) {
    const PatchFit fit(patch, limits);
    std::vector<std::int32_t> waiting{other.root()};
    while (!waiting.empty()) {
      const std::int32_t index = waiting.back();
      waiting.pop_back();
      ++findings.counts.intervals;
      bool wide = false;
      for (std::size_t row = 0; row < values.size(); ++row) {
        values[row] = other.components(index)[row].value;
        wide = wide || (limits.facing && row + 1 == values.size() && values[row].spread() > std::numbers::pi);
      }
      if (!wide && fit.slack(values, false) > limits.tolerance) continue;
      const RollCurve::Node node = other.node(index);
      bool fits = !wide && node.on_one_piece() && fit.slack(values, true) <= limits.tolerance;
      if (!wide && !fits && node.on_one_piece() && other.piece(node).pivot_at) {
        // The patch is convex and a pivot's curve is straight: it is inside where both of its ends are.
        fits = fit.slack(values_at(other.first(node)), true) <= limits.tolerance &&
               fit.slack(values_at(other.last(node)), true) <= limits.tolerance;
      }
      const double finest = kResolution * limits.perimeter;
      if (!node.on_one_piece() || (!fits && node.width() > finest)) {
        const auto [left, right] = other.halves(index);
        for (const std::int32_t half : {right, left}) {
          if (half >= 0) waiting.push_back(half);
        }
        continue;
      }
      const RollPiece& piece = other.piece(node);
      const Interval here{patch.s, patch.s};
      const Interval there{piece.s(node.lo), piece.s(node.hi)};
      PairPiece found;
      found.box = patched_is_a ? PairBox{here, there} : PairBox{there, here};
      found.corner = true;
      if (there.width() > kShortestContinuum * limits.perimeter && fit.slack(values, true) <= kTurnAccuracy) {
        found.exact = true;  // the pivots make up for whatever the other contact does there
        found.line = {{found.box[0].lo, found.box[1].lo}, {found.box[0].hi, found.box[1].hi}};
      }
      findings.pieces.push_back(found);
      findings.roots.push_back({{found.box[0].lo, found.box[1].lo}, 0, true});
    }
  }
}

}  // namespace rollfix
