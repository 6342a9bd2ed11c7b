#include "belief/two/pair_passings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "belief/posterior.hpp"
#include "belief/two/pair_filter.hpp"

// Notation:
//   s               a finger's first contact; L: `length` of a node
//   c               a corner whose turn shows in the noise, or an open outline's end
//   passing         s = c - L, from where the contact is at c in that node, with its standard deviation
// Follows docs/two_fingers.md, "The search".
// Idea: between two passings next to each other a finger has passed the same corners in the same nodes, and on flat
// sides the likelihood is constant; at each it changes, within the passing's standard deviation.
namespace rollfix::belief {

/// A pivot that is smaller is lost in the errors of both orientations.
bool is_felt(const PairModel& model, const Corner& corner) {
  return corner.turn > kFarthest * std::sqrt(model.errors->facing_variance());
}

/// Of each node and each corner c that is felt, and both ends of an open outline: s = c - L, on the first lap. `nodes`:
/// the facing has no length and is left out.
Passings::Passings(const PairModel& model, std::size_t finger, const std::vector<PairNode>& nodes)
    : boundary_(model.places) {
  std::vector<double> places;
  for (const Corner& corner : model.part->corners()) {
    if (is_felt(model, corner)) places.push_back(corner.s);
  }
  if (!boundary_.closed) places.insert(places.end(), {0, boundary_.perimeter});
  const PairErrors& errors = *model.errors;
  const auto i = static_cast<Eigen::Index>(finger);
  double gathered = 0;
  for (const PairNode& node : nodes) {
    if (node.is_facing) continue;
    // What has gathered by this node, with the first contact's error, the scale's times L, and the node's own:
    // length^2.
    gathered += errors.gathered(node.gathered, node.travelled)[i];
    const double length = node.length[finger];
    const double sd = std::sqrt(errors.contact_variance() / std::max(1.0, node.rows) + errors.start()(i, i) + gathered +
                                errors.start()(2 + i, 2 + i) * square(length));
    for (const double place : places) passings_.push_back({boundary_.on_first_lap(place - length), sd});
  }
  std::sort(passings_.begin(), passings_.end(), [](const Passing& a, const Passing& b) { return a.s < b.s; });
}

/// By bisection: lo <= s < hi.
std::span<const Passing> Passings::between(double lo, double hi) const {
  const auto at_or_after = [&](double s) {
    return std::lower_bound(passings_.begin(), passings_.end(), s,
                            [](const Passing& passing, double at) { return passing.s < at; });
  };
  return {at_or_after(lo), at_or_after(hi)};
}

/// On a closed outline also across the seam, a lap back and a lap on.
double Passings::sharpest(double s, double reach) const {
  double least = std::numeric_limits<double>::infinity();
  const double at = boundary_.on_first_lap(s);
  const double laps = boundary_.closed ? boundary_.perimeter : 0;
  for (const double lap : {-laps, 0.0, laps}) {
    for (const Passing& passing : between(at - reach + lap, at + reach + lap)) least = std::min(least, passing.sd);
    if (laps == 0) break;
  }
  return least;
}

/// The neighbours of s on the first lap, the last one before the seam and the first one after it included, shifted to
/// the lap of s.
Interval Passings::gap(double s) const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (passings_.empty()) return {-kInfinite, kInfinite};
  const double at = boundary_.on_first_lap(s);
  const std::span<const Passing> after = between(at, kInfinite);
  const std::size_t before = passings_.size() - after.size();
  const double period = boundary_.closed ? boundary_.perimeter : kInfinite;
  const double above = after.empty() ? passings_.front().s + period : after.front().s;
  const double below = before == 0 ? passings_.back().s - period : passings_[before - 1].s;
  return {below + (s - at), above + (s - at)};
}

}  // namespace rollfix::belief
