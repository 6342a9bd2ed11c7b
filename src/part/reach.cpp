#include "rollfix/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <utility>

#include "cursor.hpp"
#include "part_data.hpp"
#include "reach_search.hpp"
#include "rollfix/error.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/reach.md:
//   stance          contacts on a stretch of a spiral, or pivots at a corner; decided: possible or not: Decision
//   arc, pivot      stretches of s with possible stances, and at corners ranges of tangents: Reach
//   k, depth        the finger's curvature, and how deep a point of the boundary is in it: `deepness`
//   slack           what depth is let pass
// Follows docs/reach.md, "How it is decided" and "The slack".
// Idea: decisions of reach_search.cpp come in the order of the boundary, and what joins on is one arc.
namespace rollfix::part {
namespace {

// Arcs count as a share of the perimeter longer at both ends: rounding of arc lengths that come from elsewhere.
constexpr double kArcRounding = 1e-9;
// The deepest point is found to this share of the part's size.
constexpr double kDeepest = 1e-13;
constexpr int kHitSamples = 24;

/// The slack (a length): as the options say, or docs/reach.md, "The slack". Never above half the radius.
double slack_of(const Part& part, const BoundaryTree& tree, double curvature, const ReachOptions& options) {
  const double most = curvature > 0 ? 0.5 / curvature : std::numeric_limits<double>::infinity();
  if (options.slack) return std::min(*options.slack, most);
  double slack = kReachSlack * tree.diagonal();
  if (curvature > 0) slack = std::min(slack, kReachSlackOfRadius / curvature);
  return std::min(std::max(slack, 2 * part.outline().gap), most);
}

/// Turns decisions, in the order of the boundary, into arcs and pivots. Neighbouring free stances are one arc while the
/// finger can pass the joint between them.
class Assembly {
 public:
  Assembly(const Part& part, Reach& reach) : part_(part), reach_(reach) {}

  /// Fills the arcs, the pivots and `whole_loop` of the Reach.
  void run(const std::vector<Decision>& decisions) {
    const std::vector<Spiral>& spirals = part_.turning().spirals();
    std::size_t next = 0;
    bool first_joins = false;  // the first spiral goes on from the last
    for (std::size_t k = 0; k < spirals.size(); ++k) {
      // For each spiral: the joint at its start, then its own stances.
      const bool joins = pass_joint(k, decisions, next);
      if (k == 0) {
        first_joins = joins;
      } else if (!joins) {
        is_open_ = false;
      }
      for (; next < decisions.size() && decisions[next].stance.spiral == k; ++next) add(decisions[next]);
    }
    if (part_.closed() && first_joins) close();
  }

 private:
  /// The pivots where spiral k starts; can the finger roll over that joint?
  bool pass_joint(std::size_t k, const std::vector<Decision>& decisions, std::size_t& next) {
    const Cursor joint = Cursor::at_spiral(part_.turning(), k);
    if (joint.is_first()) return false;
    PivotReach pivot{joint.lo(), {joint.angle_before(), joint.angle_after()}, {}};
    // Free pivots that adjoin are one range of angles.
    bool has_pivot = false;
    for (; next < decisions.size() && decisions[next].stance.spiral == k && decisions[next].stance.is_pivot; ++next) {
      has_pivot = true;
      const Interval& range = decisions[next].stance.range;
      if (!decisions[next].is_free) continue;
      if (!pivot.angles.empty() && pivot.angles.back().hi == range.lo) {
        pivot.angles.back().hi = range.hi;
      } else {
        pivot.angles.push_back(range);
      }
    }
    // A joint without pivots is passed unless it is a concave corner.
    if (!has_pivot) return !Corner{pivot.s, pivot.whole.width()}.is_concave();
    reach_.pivots.push_back(pivot);
    return pivot.is_whole();
  }

  /// Lengthens the open arc by a free stance, or starts one; a stance that is not free ends it.
  void add(const Decision& decision) {
    const Interval& range = decision.stance.range;
    if (!decision.is_free) {
      is_open_ = false;
    } else if (is_open_) {
      reach_.arcs.back().hi = range.hi;
    } else {
      reach_.arcs.push_back(range);
      is_open_ = true;
    }
  }

  /// An arc that goes on across s = 0.
  void close() {
    std::vector<Interval>& arcs = reach_.arcs;
    const double period = part_.perimeter();
    if (arcs.empty() || arcs.front().lo > 0 || arcs.back().hi < period) return;
    // One arc from 0 to P that goes on across s = 0 has no ends.
    reach_.whole_loop = arcs.size() == 1;
    if (reach_.whole_loop) return;
    arcs.back().hi = period + arcs.front().hi;
    arcs.erase(arcs.begin());
  }

  const Part& part_;
  Reach& reach_;
  bool is_open_ = false;  // the last arc goes on
};

/// The search and its results for a disk (curvature 1 / r) or a jaw (0).
Reach reach_of(const Part& part, double curvature, const ReachOptions& options) {
  BoundaryTree tree(part);
  Reach reach;
  reach.curvature = curvature;
  reach.slack = slack_of(part, tree, curvature, options);
  reach.perimeter = part.perimeter();
  reach.closed = part.closed();
  ReachSearch search(tree, curvature, reach.slack, options.budget);
  Assembly(part, reach).run(search.run());
  reach.decided = search.is_decided();
  reach.tests = search.tests();
  return reach;
}

/// The deepest point in one stance of the finger, best first: the stretch with the highest bound on F is halved next,
/// until no bound is above the best point found by more than kDeepest of the size. With nothing inside, depth 0.
Hit deepest_hit(BoundaryTree& tree, double curvature, double s, double angle) {
  const Vec2 point = tree.part().point(s);
  const Vec2 normal(std::sin(angle), -std::cos(angle));
  Hit deepest{s, s, 0, point};
  double best = 0;
  std::priority_queue<std::pair<double, std::int32_t>> open;
  open.push({std::numeric_limits<double>::infinity(), tree.root()});
  // The queue's top bounds F on all that is left.
  while (!open.empty() && open.top().first > best + kDeepest * tree.diagonal()) {
    beat();
    const std::int32_t whole = open.top().second;
    open.pop();
    // Too short to halve: its own point has been looked at.
    const auto [first, second] = tree.halves(whole);
    if (first == second) continue;
    for (const std::int32_t index : {first, second}) {
      const BoundaryTree::Node& node = tree.node(index);
      const double here = deepness(normal, node.on_curve - point, curvature);
      if (here > best) {
        best = here;
        deepest = {s, node.on_curve_s, depth_of(here, curvature), node.on_curve};
      }
      const ChordDeepness on_chord = deepness_on_chord(node, point, normal, curvature);
      const double bound = on_chord.most() + on_chord.beside(node.deviation, curvature);
      if (bound > best) open.push({bound, index});
    }
  }
  return deepest;
}

}  // namespace

}  // namespace rollfix::part

namespace rollfix {

/// Every angle between both limits of the corner.
bool PivotReach::is_whole() const {
  return angles.size() == 1 && angles.front().lo <= whole.lo && angles.front().hi >= whole.hi;
}

bool Reach::is_whole() const {
  const bool all = closed ? whole_loop : arcs.size() == 1 && arcs.front().width() >= perimeter;
  return all && std::all_of(pivots.begin(), pivots.end(), [](const PivotReach& pivot) { return pivot.is_whole(); });
}

/// What lies between one arc and the next; of a closed boundary also across s = 0.
std::vector<Interval> Reach::gaps() const {
  if (arcs.empty()) return {{0, perimeter}};
  std::vector<Interval> found;
  const auto add = [&](double lo, double hi) {
    if (hi > lo) found.push_back({lo, hi});
  };
  if (!closed) add(0, arcs.front().lo);
  for (std::size_t k = 0; k + 1 < arcs.size(); ++k) add(arcs[k].hi, arcs[k + 1].lo);
  const double last = arcs.back().hi;
  if (!closed) {
    add(last, perimeter);
  } else if (!whole_loop) {
    const double next = arcs.front().lo + perimeter;
    // The gap across s = 0. Where the last arc goes past P, the gap before the first arc lies on the first lap.
    if (last < perimeter) {
      add(last, next);
    } else if (next > last) {
      found.insert(found.begin(), {last - perimeter, arcs.front().lo});
    }
  }
  return found;
}

/// 0 to 1; pivots have no length.
double Reach::share() const {
  double length = 0;
  for (const Interval& arc : arcs) length += arc.width();
  return std::min(length / perimeter, 1.0);
}

std::optional<Interval> Reach::arc_at(double s) const {
  const double rounding = part::kArcRounding * perimeter;
  for (const Interval& arc : arcs) {
    // The laps by which the arc is moved so that it starts at or before s.
    const double turns = closed ? std::floor((s + rounding - arc.lo) / perimeter) : 0;
    const Interval moved{arc.lo + turns * perimeter - rounding, arc.hi + turns * perimeter + rounding};
    if (moved.contains(s)) return moved;
  }
  return std::nullopt;
}

bool Reach::contains(double s) const {
  if (arc_at(s)) return true;
  return std::any_of(pivots.begin(), pivots.end(), [&](const PivotReach& pivot) {
    return !pivot.angles.empty() && boundary().distance(s, pivot.s) <= part::kArcRounding * perimeter;
  });
}

Reach reach_of_disk(const Part& part, double radius, const ReachOptions& options) {
  if (!(radius > 0 && std::isfinite(radius))) {
    throw InputError(
        fmt::format("reach: expected a disk whose radius is a finite number above 0, found {}: give it "
                    "in the outline's unit",
                    radius));
  }
  require_not_lost(part, radius, "a disk with a radius", ": give it in the outline's unit");
  return part::reach_of(part, 1 / radius, options);
}

Reach reach_of_jaw(const Part& part, const ReachOptions& options) { return part::reach_of(part, 0, options); }

/// Builds a tree for this one question.
Hit deepest_hit(const Part& part, double curvature, double s, double angle) {
  part::BoundaryTree tree(part);
  return part::deepest_hit(tree, curvature, s, angle);
}

Hit deepest_hit(const Part& part, double curvature, const Interval& contacts) {
  part::BoundaryTree tree(part);
  const TurningFunction& turning = part.turning();
  Hit deepest = part::deepest_hit(tree, curvature, contacts.lo, turning.angle(contacts.lo));
  const Interval pivot{turning.angle(contacts.lo, Side::before), turning.angle(contacts.lo)};
  // Sampled, for a message: contacts of a stretch, or tangents between both limits at a corner.
  for (int k = 0; k <= part::kHitSamples; ++k) {
    const double share = static_cast<double>(k) / part::kHitSamples;
    const double s = contacts.lo + share * contacts.width();
    const double angle = contacts.width() > 0 ? turning.angle(s) : pivot.lo + share * pivot.width();
    const Hit hit = part::deepest_hit(tree, curvature, s, angle);
    if (hit.depth > deepest.depth) deepest = hit;
  }
  return deepest;
}

}  // namespace rollfix
