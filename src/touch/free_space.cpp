#include "free_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "problem.hpp"

// Notation:
//   p(t)         a place on a path along which nothing was felt; the same in the part's frame is R(-phi) (p - X)
//   d            its distance from the part, below 0 inside: PartDistance
//   r, delta     the finger's radius, and how far the path may be off; it is blocked where d < r - delta: `bound_`
//   cell         poses (X, phi) about a middle; p is within `moved(p)` of where the middle has it
// A cell goes where a path is blocked in all of its poses: d at the middle < r - delta - moved. With noise a pose has
// its weight times P(d > r), d normal about the least one of the path: docs/touch.md, "Where nothing was touched".
// Idea: sphere tracing: where the part is d away, the next d - (r - delta) of a path need no look.
namespace rollfix::touch {

/// How a cell sees places of the world: where its middle pose has them in the part's frame, and how far from there, at
/// most, any other of its poses.
struct CellView {
  Vec2 first = Vec2::Zero();   // the first contact, in the world, and ...
  Vec2 middle = Vec2::Zero();  // ... in the part's frame
  double cosine = 1;           // of its heading
  double sine = 0;
  double slack = 0;
  double swing = 0;

  Vec2 in_part(const Vec2& place) const {
    const Vec2 off = place - first;
    return middle + Vec2(cosine * off.x() + sine * off.y(), cosine * off.y() - sine * off.x());
  }
  double moved(const Vec2& place) const { return slack + swing * (place - first).norm(); }
};

/// Cells to be looked at together.
struct Sieve {
  const std::vector<Cell>& cells;
  std::vector<CellView> views;
  const PathTree& tree;
  const Measured& first;
};

namespace {

// Of the part's diagonal: the rounding of a distance.
constexpr double kRoundingOfDistance = 1e-9;
// Steps along a path are no shorter than this share of what it may be off.
constexpr double kLeastStep = 0.1;
// Cells with wider headings move a path too far to be blocked by them.
constexpr double kWideHeading = 0.7;
// A path ends so many of its tolerances before a contact: there the finger meets the part.
constexpr double kBeforeContact = 2;
// Beyond so many standard deviations from the part a path is free.
constexpr double kSurelyFree = 6;
// Where cells are looked at together, steps that look for a place that is blocked in all of their poses are no shorter
// than this share of what these poses differ by: what is missed is seen in halves of them.
constexpr double kStepOfSpread = 0.25;

/// Length: the largest tolerance of a place; with noise kPossibleSigmas of the largest sd of a touch's place, or of the
/// common one.
double slack_of(const TouchProblem& problem, const std::vector<Measured>& contacts) {
  double most = 0;
  for (const Measured& contact : contacts) {
    if (contact.has_place) most = std::max(most, contact.place_most);
  }
  if (!problem.noise) return most;
  double sd = problem.noise->position;
  for (const MeasuredTouch& touch : problem.touches) sd = std::max(sd, touch.position_sd.value_or(0));
  return kPossibleSigmas * sd;
}

/// Where the finger's centre was as it met the part, or left it.
/// Of each touch its place, of each roll with centres its first and its last row.
std::vector<Vec2> ends_of_contacts(const TouchProblem& problem) {
  std::vector<Vec2> ends;
  for (const MeasuredTouch& touch : problem.touches) ends.push_back(touch.at);
  for (const Log& roll : problem.rolls) {
    const FingerRows& rows = roll.fingers.front();
    if (rows.x.empty()) continue;
    ends.emplace_back(rows.x.front(), rows.y.front());
    ends.emplace_back(rows.x.back(), rows.y.back());
  }
  return ends;
}

/// Without its last bit before a contact.
/// kBeforeContact of the slack is cut off at an end that is within the slack of a contact, at most half of the path.
Clear before_contacts(const Clear& path, const std::vector<Vec2>& contacts, double slack) {
  const Vec2 along = path.to - path.from;
  const double length = along.norm();
  const auto is_contact = [&](const Vec2& end) {
    return std::any_of(contacts.begin(), contacts.end(),
                       [&](const Vec2& contact) { return (contact - end).norm() <= slack; });
  };
  const double cut = length > 0 ? std::min(kBeforeContact * slack / length, 0.5) : 0;
  const Vec2 from = path.from + (is_contact(path.from) ? cut : 0) * along;
  const Vec2 to = path.to - (is_contact(path.to) ? cut : 0) * along;
  return {from, to};
}

/// Log of the probability that a standard normal number is below x.
/// No less than log(1e-300).
double log_normal(double x) { return std::log(std::max(0.5 * std::erfc(-x / std::sqrt(2.0)), 1e-300)); }

/// Goes along a path: `look` has a place of it, and says how far ahead nothing has to be looked at; below 0: it has
/// seen enough.
/// True: `look` has seen enough. Steps are no shorter than `least_step`; the path's end is always looked at. A path of
/// no length is one place.
template <class Look>
bool walk(const Clear& path, double least_step, const Look& look) {
  const double length = (path.to - path.from).norm();
  for (double at = 0;;) {
    const Vec2 place = length > 0 ? Vec2(path.from + at / length * (path.to - path.from)) : path.from;
    const double ahead = look(place);
    if (ahead < 0) return true;
    if (at >= length) return false;
    at = std::min(at + std::max(ahead, least_step), length);
  }
}

/// The first contact is at its disc's middle, within radius and tolerance; other places of the world swing about it by
/// 2 sin(h / 2) of their distance.
CellView view_of(const Cell& cell, const PathTree& tree, const Measured& first) {
  const PathTree::Node& node = tree.node(cell.first);
  const double swing = cell.heading.is_all() ? 2 : 2 * std::sin(0.5 * cell.heading.half);
  return {first.at,
          node.middle,
          std::cos(cell.heading.middle),
          std::sin(cell.heading.middle),
          node.radius + first.place_most,
          swing};
}

/// How far a pose of the cell may have a place from where the middle of another has it: of all places of a straight
/// path the most at one of its ends.
double apart(const CellView& middle, const CellView& cell, const Vec2& place) {
  return (middle.in_part(place) - cell.in_part(place)).norm() + cell.moved(place);
}

}  // namespace

/// Without paths nothing is computed: `is_empty`.
FreeSpace::FreeSpace(const TouchProblem& problem, const std::vector<Measured>& contacts)
    : part_(problem.part), radius_(radius_of(problem)) {
  if (problem.clear.empty()) return;
  const double slack = slack_of(problem, contacts);
  sd_ = problem.noise ? slack / kPossibleSigmas : 0;
  bound_ = radius_ - slack - kRoundingOfDistance * part_.diagonal();
  least_step_ = kLeastStep * slack;
  if (!problem.part.closed() && bound_ <= 0) return;  // such a path may as well have gone by
  const std::vector<Vec2> ends = ends_of_contacts(problem);
  for (const Clear& path : problem.clear) paths_.push_back(before_contacts(path, ends, slack));
}

/// Sphere tracing with the exact distance.
bool FreeSpace::is_blocked(const Pose& pose) {
  const Pose back{0, 0, -pose.heading};
  return std::any_of(paths_.begin(), paths_.end(), [&](const Clear& path) {
    return walk(path, least_step_, [&](const Vec2& place) {
      return part_.nearest(back.turned(place - Vec2(pose.x, pose.y))).distance - bound_;
    });
  });
}

/// A path is blocked in all poses where d < r - delta - moved(p) at some place p: d is 1-Lipschitz.
bool FreeSpace::blocks_all(const Cell& cell, const PathTree& tree, const Measured& first) {
  if (cell.heading.half > kWideHeading) return false;
  const CellView view = view_of(cell, tree, first);
  return std::any_of(paths_.begin(), paths_.end(), [&](const Clear& path) {
    return walk(path, least_step_, [&](const Vec2& place) {
      const Vec2 in_part = view.in_part(place);
      const double bound = bound_ - view.moved(place);
      const double free = part_.at_least(in_part) - bound;
      // The quick lower bound is enough to go on by; only near the part the exact distance is computed.
      return free > least_step_ ? free : part_.nearest(in_part).distance - bound;
    });
  });
}

/// One walk along each path by the middle view. `spread`: how far any pose of any view may have a place from there.
/// Free: d >= bound + spread at all places looked at. Blocked: d < bound - spread at one. Else unknown.
FreeSpace::Way FreeSpace::way_of(std::span<const CellView> views) {
  const CellView& middle = views[views.size() / 2];
  Way way = Way::free;
  for (const Clear& path : paths_) {
    double spread = 0;
    for (const CellView& view : views) {
      spread = std::max({spread, apart(middle, view, path.from), apart(middle, view, path.to)});
    }
    const auto look = [&](const Interval& distance) {
      if (distance.hi < bound_ + spread) way = Way::unknown;
      if (distance.hi < bound_ - spread) return -1.0;
      // Step as far as all poses are free; once that is lost, as far as no place is blocked in all.
      if (way == Way::free) return distance.lo - bound_ - spread;
      return std::max(distance.lo - bound_ + spread, kStepOfSpread * spread);
    };
    const bool is_blocked = walk(path, least_step_, [&](const Vec2& place) {
      const Vec2 in_part = middle.in_part(place);
      const double ahead = look(part_.between(in_part));
      if (ahead < 0 && way == Way::unknown) return ahead;
      if (ahead > least_step_) return ahead;
      const double distance = part_.nearest(in_part).distance;
      return look({distance, distance});
    });
    if (is_blocked) return Way::blocked;
  }
  return way;
}

/// Cells that are neighbours have poses that hardly differ: those from `begin` to `end` together where one look is
/// enough, else in halves.
/// A single cell by its own, tighter test.
void FreeSpace::add_unblocked(const Sieve& sieve, std::size_t begin, std::size_t end, std::vector<Cell>& to) {
  if (end - begin == 1) {
    if (!blocks_all(sieve.cells[begin], sieve.tree, sieve.first)) to.push_back(sieve.cells[begin]);
    return;
  }
  const Way way = way_of(std::span(sieve.views).subspan(begin, end - begin));
  if (way == Way::blocked) return;
  if (way == Way::free) {
    const std::span cells = std::span(sieve.cells).subspan(begin, end - begin);
    to.insert(to.end(), cells.begin(), cells.end());
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  add_unblocked(sieve, begin, middle, to);
  add_unblocked(sieve, middle, end, to);
}

/// `first`: the contact that the cells' first nodes are of. Keeps the cells' order.
void FreeSpace::drop_blocked(std::vector<Cell>& cells, const PathTree& tree, const Measured& first) {
  if (is_empty() || cells.empty()) return;
  Sieve sieve{cells, {}, tree, first};
  for (const Cell& cell : cells) sieve.views.push_back(view_of(cell, tree, first));
  std::vector<Cell> kept;
  add_unblocked(sieve, 0, cells.size(), kept);
  cells = std::move(kept);
}

/// Each path by its place that is nearest to the part, or deepest in it: by how far that is from where it may be, with
/// what the path and the pose may be off.
double FreeSpace::log_free(const PosteriorNode& node) {
  const Pose back{0, 0, -node.pose.heading};
  double sum = 0;
  for (const Clear& path : paths_) {
    double least = std::numeric_limits<double>::infinity();
    NearestOfPart closest;
    walk(path, least_step_, [&](const Vec2& place) {
      const Vec2 in_part = back.turned(place - Vec2(node.pose.x, node.pose.y));
      const double no_nearer = part_.at_least(in_part) - std::min(least, radius_ + kSurelyFree * sd_);
      if (no_nearer > least_step_) return no_nearer;
      const NearestOfPart one = part_.nearest(in_part);
      if (one.distance < least) {
        least = one.distance;
        closest = one;
      }
      if (least < radius_ - 2 * kSurelyFree * sd_) return -1.0;  // deep enough
      return one.distance - std::min(least, radius_ + kSurelyFree * sd_);
    });
    const Vec2 away = node.pose.turned(closest.away);
    const Vec2 arm = node.pose.turned(closest.contact);
    // d(distance)/d(x, y, phi): the part's nearest point moves with the pose.
    const Eigen::Vector3d by_pose(-away.x(), -away.y(), -(away.y() * arm.x() - away.x() * arm.y()));
    const double variance = sd_ * sd_ + by_pose.dot(node.covariance * by_pose);
    // P(d > r), d normal with the variance of the path and of the pose.
    sum += log_normal((least - radius_) / std::sqrt(variance));
  }
  return sum;
}

/// `square` grows as a residual's would, so that the best pose is one that leaves the paths free.
void FreeSpace::weigh(std::vector<PosteriorNode>& nodes) {
  if (is_empty()) return;
  for (PosteriorNode& node : nodes) {
    const double log_share = log_free(node);
    node.log_density += log_share;
    node.log_weight += log_share;
    node.square -= 2 * log_share;
  }
}

}  // namespace rollfix::touch
