#include "posterior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "outline/turn.hpp"
#include "roll_belief.hpp"

// Notation:
//   u_1             place of the first touch's contact, a node of the grid: `Held`, on columns of stretches, `Column`
//   (X, phi)        the part's pose; given u_1 two numbers of it are free, which the other touches tell
//   r^2             least sum of squares given u_1: `FittedPose::square`, its normal matrix `information`
//   L_i             likelihood of a further touch, summed over the boundary near its nearest place: TiltedTouch
//   log w           `log_weight`: log of the integral of the product of all L_i over the pose, about its mode, and of
//                   the length that the node stands for
// Follows docs/touch.md, "How it works".
// Idea: quadrature over one unknown, and about each of its values Laplace's method for the rest, by Newton's steps from
// the best pose to the mode of the product.
namespace rollfix::touch {
namespace {

// The grid's step is at most so many standard deviations of the first touch's place as all touches know it: the
// midpoint rule is off by next to nothing of a normal density, and what a node stands for makes its own distribution
// wider. At most it moves a touch by so many of its own: near a fold of a curve of poses a little of the place moves
// them far. It is never finer than the first touch's own: the density is no narrower. Where the search had to stop at
// coarser cells, which are a continuum then, it has no more steps than on one of the finest.
constexpr double kStep = 0.7;
constexpr double kStepOfTouch = 3;
constexpr int kMostPlacesOfCell = 7;
// Starts at headings no further apart than this, radians, so that each best pose is found from one of them.
constexpr double kStartApart = 0.35;
constexpr int kMostStarts = 9;
// So many neighbouring cells have one best pose.
constexpr std::size_t kFewCells = 4;
// Two best poses at one place that are nearer, in standard deviations, are one.
constexpr double kSamePose = 0.2;
// A fit that is as near to a known pose, with squares that are what the information says but for this, ends there.
constexpr double kSameSquare = 0.002;
// Newton's steps from the best pose to the mode of the tilted likelihood; one worth less than this, half the square of
// standard deviations, is taken along without another look.
constexpr int kMostTilts = 4;
constexpr double kSmallTilt = 0.05;
constexpr double kLargeTilt = 4;

/// The pose about which all others lie, given the first touch's place.
class NodeMaker {
 public:
  NodeMaker(PoseFit& fit, std::size_t first_touch) : fit_(fit), first_(first_touch) {}

  /// `best`: the fit with the first touch held there. A node whose squares exceed the least met so far by kHopeless is
  /// worth little, and takes the cheap way.
  PosteriorNode node_at(const Held& held, const FittedPose& best) {
    least_square_ = std::min(least_square_, best.square);
    return best.square > least_square_ + kHopeless ? rough_node(best) : tilted_node(held, best);
  }

 private:
  /// Laplace about the best pose, each further touch's integral taken as the peak times its own standard deviation.
  PosteriorNode rough_node(const FittedPose& best) {
    PosteriorNode node;
    node.square = best.square;
    node.best = best.pose;
    node.pose = best.pose;
    node.covariance = fit_.at_origin(best.pose, best.information.inverse());
    node.log_density = -0.5 * best.square;
    for (std::size_t k = 0; k < best.places.size(); ++k) {  // each about as wide as its own sd
      const Measured& touch = fit_.touches()[k];
      if (touch.roll != nullptr) {
        const RollNode& at = touch.roll->at(best.places[k]);
        // A roll's squares hold its density: that is taken out, and the node's weight counts instead. That of the first
        // contact is added later.
        node.log_density += k == first_ ? at.log_peak - at.log_density : at.log_peak + at.log_weight - at.log_density;
      } else if (k != first_) {
        node.log_density += std::log(touch.place_unit);
      }
    }
    // The normal integral over the pose, but for (2 pi)^(3/2), which all nodes have.
    node.log_density -= 0.5 * std::log(best.information.determinant());
    return node;
  }

  /// Laplace about the mode of the product of tilted likelihoods: Newton's steps from the best pose, at most
  /// kMostTilts.
  PosteriorNode tilted_node(const Held& held, const FittedPose& best) {
    // Each turn: `pose` and the nearest places in it; the derivatives are taken there.
    Pose pose = best.pose;
    std::vector<PathPlace> places = best.places;
    PosteriorNode node;
    node.square = best.square;
    node.best = best.pose;
    for (int tilt = 0;; ++tilt) {
      double log_likelihood = 0;
      const Normals sum = summed(held, pose, places, log_likelihood);
      Eigen::LDLT<Eigen::Matrix3d> solver(sum.matrix);
      // The log of a tilted likelihood may not be concave there: then the step is by the fit's own information.
      if (!(solver.info() == Eigen::Success && solver.vectorD().minCoeff() > 0)) solver.compute(best.information);
      Eigen::Vector3d step = solver.solve(sum.slope);
      // g^T H^-1 g: the square of the step, in standard deviations.
      const double gain = step.dot(sum.slope);
      // The last step is taken by the quadratic model: half the gain more density, no new sums.
      if (gain <= kSmallTilt || tilt == kMostTilts) {
        if (gain > kLargeTilt) step *= std::sqrt(kLargeTilt / gain);
        node.pose = fit_.moved(pose, step);
        node.covariance = fit_.at_origin(node.pose, solver.solve(Eigen::Matrix3d::Identity()));
        node.log_density =
            log_likelihood + 0.5 * std::min(gain, kLargeTilt) - 0.5 * solver.vectorD().array().log().sum();
        return node;
      }
      // A trust region: no more than sqrt(kLargeTilt) standard deviations a step.
      if (gain > kLargeTilt) step *= std::sqrt(kLargeTilt / gain);
      pose = fit_.moved(pose, step);
      for (std::size_t k = 0; k < places.size(); ++k) {
        // The nearest places are where `tilted_touch` begins.
        if (k != first_) places[k] = fit_.downhill_from(places[k], pose, k);
      }
    }
  }

  /// Log of the product of all likelihoods in a pose, with the first contact held, and its first two derivatives there.
  Normals summed(const Held& held, const Pose& pose, const std::vector<PathPlace>& places, double& log_likelihood) {
    Normals sum = fit_.prior_normals(pose);
    const Normals of_first = fit_.held_normals(pose, first_, held.place);
    sum.matrix += of_first.matrix;
    sum.slope += of_first.slope;
    log_likelihood = -0.5 * fit_.prior_square(pose) - 0.5 * fit_.square_at(pose, first_, held.place, true);
    if (const RollBelief* roll = fit_.touches()[first_].roll) {  // how dense it is there the node's weight says
      const RollNode& at = roll->at(held.place);
      log_likelihood += at.log_peak - at.log_density;
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (k == first_) continue;
      const RollBelief* roll = fit_.touches()[k].roll;
      const TiltedTouch tilted =
          roll != nullptr ? roll->tilted(pose, fit_.about()) : tilted_touch(fit_, pose, k, places[k]);
      sum.matrix += tilted.normals.matrix;
      sum.slope += tilted.normals.slope;
      log_likelihood += tilted.log_likelihood;
    }
    return sum;
  }

  PoseFit& fit_;
  std::size_t first_;
  // Of all nodes so far.
  double least_square_ = std::numeric_limits<double>::infinity();
};

/// A best pose, the mode about which its node lies, and the group that it was found from first.
struct KnownPose {
  FittedPose fitted;
  Pose mode;
  std::size_t group = 0;
};

/// Whether the node lies about the same mode: from a corner and from the side next to it one is found twice.
/// By the node's own covariance.
bool is_about(const PosteriorNode& node, const Pose& mode) {
  const Eigen::Vector3d apart(node.pose.x - mode.x, node.pose.y - mode.y,
                              nearest_angle(node.pose.heading - mode.heading));
  return apart.dot(node.covariance.inverse() * apart) <= kSamePose * kSamePose;
}

/// How far one pose is from another: the square of it in standard deviations, by this information.
double square_apart(const PoseFit& fit, const Pose& one, const Pose& other, const Eigen::Matrix3d& information) {
  Eigen::Vector3d apart(0, 0, nearest_angle(one.heading - other.heading));
  const Pose turned = fit.moved(other, apart);  // about the same point as the information
  // Heading first, then what is left of the place.
  apart.head<2>() = Vec2(one.x - turned.x, one.y - turned.y);
  return apart.dot(information * apart);
}

/// Which of those that are known at the place a pose is; nullptr if it is none.
/// By the found pose's information.
const KnownPose* find_known(const PoseFit& fit, const FittedPose& found, const std::vector<KnownPose>& known) {
  const auto same = std::find_if(known.begin(), known.end(), [&](const KnownPose& one) {
    return square_apart(fit, one.fitted.pose, found.pose, found.information) <= kSamePose * kSamePose;
  });
  return same == known.end() ? nullptr : &*same;
}

/// Which of them a fit is about to end in, that has come to this pose and square; nullptr if in none.
/// Near a minimum the squares are those of the known fit and of the way to it. Where they are, the descent ends there.
const KnownPose* find_goal(const PoseFit& fit, const Pose& pose, double square, const std::vector<KnownPose>& known) {
  const auto goal = std::find_if(known.begin(), known.end(), [&](const KnownPose& one) {
    const double apart = square_apart(fit, one.fitted.pose, pose, one.fitted.information);
    return apart <= kSamePose * kSamePose && std::abs(square - one.fitted.square - apart) <= kSameSquare;
  });
  return goal == known.end() ? nullptr : &*goal;
}

/// The headings to start from: of a few of the group's cells, and of a wide one several. With fewer, poses are lost.
std::vector<double> start_headings(const CellSets& sets, const std::vector<std::size_t>& group) {
  std::vector<double> headings;
  std::vector<std::size_t> chosen = {group[group.size() / 2]};
  // First, middle and last cell of a large group.
  if (group.size() > kFewCells) chosen = {group.front(), chosen.front(), group.back()};
  for (const std::size_t k : chosen) {
    const HeadingArc& arc = sets.cells[k].heading;
    const double half = std::min(arc.half, std::numbers::pi);
    const int count = std::clamp(static_cast<int>(std::ceil(2 * half / kStartApart)), 1, kMostStarts);
    for (int i = 0; i < count; ++i) headings.push_back(arc.middle + half * ((2 * i + 1.0) / count - 1));
  }
  return headings;
}

/// The grid on one stretch of the first touch, and the poses known at each of its places.
struct Column {
  std::int32_t node = -1;
  std::vector<double> places;
  std::vector<double> log_weights;  // of each: of the length that it stands for, and of a roll of its probability
  std::vector<std::vector<KnownPose>> known;
  double step = 0;  // in u, of a touch
};

/// The roll's own nodes on the stretch.
/// A roll's belief is a grid already: its nodes are the quadrature, with their own weights.
Column column_of_roll(const RollBelief& roll, const PathTree::Node& at, std::int32_t node) {
  Column column;
  column.node = node;
  const auto [begin, end] = roll.nodes_in(static_cast<std::size_t>(at.stretch), at.u);
  for (std::size_t k = begin; k < end; ++k) {
    column.places.push_back(roll.nodes()[k].place.u);
    column.log_weights.push_back(roll.nodes()[k].log_weight);
  }
  column.known.resize(column.places.size());
  return column;
}

/// Neighbouring groups with one stretch for the first touch.
struct Groups {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// `fineness`: steps by u.
/// The midpoint rule on the stretch of a node, with 1 to kMostPlacesOfCell places.
Column column_of(const PoseFit& fit, std::int32_t node, std::size_t touch, double fineness) {
  const PathTree::Node& at = fit.tree(touch).node(node);
  if (const RollBelief* roll = fit.touches()[touch].roll) return column_of_roll(*roll, at, node);
  const int count = std::clamp(
      static_cast<int>(std::ceil(std::min<double>(kMostPlacesOfCell, at.u.width() * fineness))), 1, kMostPlacesOfCell);
  Column column;
  column.node = node;
  column.step = at.u.width() / count;
  const double length = column.step * length_per_u(fit.path(touch), static_cast<std::size_t>(at.stretch));
  // A corner that a point touches has no length: no places.
  if (!(length > 0)) return column;
  for (int k = 0; k < count; ++k) {
    column.places.push_back(at.u.lo + (k + 0.5) * column.step);
    column.log_weights.push_back(std::log(length));
  }
  column.known.resize(column.places.size());
  return column;
}

/// Goes over the cells column by column: all groups with one stretch for the first touch.
class Weigher {
 public:
  Weigher(PoseFit& fit, const CellSets& sets, std::size_t first_touch, std::size_t most_places)
      : fit_(fit), sets_(sets), first_(first_touch), most_places_(most_places), maker_(fit, first_touch) {}

  /// Columns in order of the first touch's places; ends early where there are more places than `most_places`.
  Posterior posterior() {
    result_.owner.assign(sets_.groups.size(), Posterior::kNone);
    hopeless_ = hopeless_groups(fit_, sets_, first_);
    for (const std::vector<std::size_t>& component : sets_.components) {
      result_.hopeless += hopeless_[component.front()] ? 1 : 0;
    }
    Groups groups;
    while (groups.begin < sets_.groups.size() && !result_.is_too_long) {
      groups.end = groups.begin + 1;
      // Groups are sorted by the first touch's place, so those of one stretch stand together.
      while (groups.end < sets_.groups.size() && node_of(groups.end) == node_of(groups.begin)) ++groups.end;
      add(groups);
      groups.begin = groups.end;
    }
    return std::move(result_);
  }

 private:
  /// The first touch's node of a group: all of its cells have the same.
  std::int32_t node_of(std::size_t group) const { return sets_.cells[sets_.groups[group].front()].first; }
  PathPlace place_of(std::int32_t node, double u) const {
    return {static_cast<std::size_t>(fit_.tree(first_).node(node).stretch), u};
  }

  /// All places of the column, for each group that is not hopeless. `known` is shared by its groups.
  void add(const Groups& groups) {
    column_ = column_of(fit_, node_of(groups.begin), first_, fineness(groups));
    for (std::size_t g = groups.begin; g < groups.end; ++g) {
      if (hopeless_[g]) continue;
      places_ += column_.places.size();
      result_.is_too_long = places_ > most_places_;
      if (result_.is_too_long) return;
      for (std::size_t k = 0; k < column_.places.size(); ++k) add_place(groups, g, k);
    }
  }

  /// How fine the grid has to be on a stretch, by what is in its middle.
  /// Steps by u: the most that any group asks for, by the sd of u or by how far a step moves the touches, and no more
  /// than the first touch's own sd asks for. The fits are kept: `add_place` does not repeat them.
  double fineness(const Groups& groups) {
    if (fit_.touches()[first_].roll != nullptr) return 0;
    const std::int32_t node = node_of(groups.begin);
    const Held held{first_, place_of(node, fit_.tree(first_).node(node).u.middle())};
    middles_.assign(groups.end - groups.begin, {});
    double most = 0;
    double own = 0;
    for (std::size_t g = groups.begin; g < groups.end; ++g) {
      if (hopeless_[g]) continue;
      const Cell& middle = sets_.cells[sets_.groups[g][sets_.groups[g].size() / 2]];
      FittedPose& fitted = middles_[g - groups.begin];
      fitted = fit_.fit(fit_.pose_at(held, middle.heading.middle), held);
      const ByPlace by_place = fit_.by_place(fitted, held);
      most =
          std::max({most, std::sqrt(by_place.information) / kStep, fit_.touches_moved(by_place.pose) / kStepOfTouch});
      own = by_place.own_information;
    }
    return std::min(most, std::sqrt(own));
  }

  /// Fits with the first touch held at place k, from each of the group's headings. A fit that ends where a known one
  /// does makes its group the owner.
  void add_place(const Groups& groups, std::size_t group, std::size_t k) {
    const Held held{first_, place_of(column_.node, column_.places[k])};
    const KnownPose* goal = nullptr;
    const PoseFit::IsKnown is_known = [&](const Pose& pose, double square) {
      goal = find_goal(fit_, pose, square, column_.known[k]);
      return goal != nullptr;
    };
    const bool is_middle = column_.step > 0 && 2 * k + 1 == column_.places.size();
    const std::vector<std::size_t>& cells = sets_.groups[group];
    for (const double heading : start_headings(sets_, cells)) {
      // `fineness` has fitted from here already.
      if (is_middle && heading == sets_.cells[cells[cells.size() / 2]].heading.middle) {
        add_pose(groups, group, k, held, middles_[group - groups.begin]);
        continue;
      }
      const std::optional<FittedPose> best = fit_.fit_unless(is_known, fit_.pose_at(held, heading), held);
      if (best) {
        add_pose(groups, group, k, held, *best);
      } else {
        result_.owner[group] = goal->group;
      }
    }
  }

  /// Whether some cell of a group has this heading.
  bool has_heading(std::size_t group, double heading) const {
    return std::any_of(sets_.groups[group].begin(), sets_.groups[group].end(), [&](std::size_t k) {
      const HeadingArc& arc = sets_.cells[k].heading;
      return std::abs(nearest_angle(heading - arc.middle)) <= arc.half;
    });
  }

  /// The group that a pose is in, as least squares may lead to another one: by its heading, as its place is the same.
  std::size_t home_of(double heading, const Groups& groups, std::size_t from) const {
    if (has_heading(from, heading)) return from;
    for (std::size_t g = groups.begin; g < groups.end; ++g) {
      if (has_heading(g, heading)) return g;
    }
    return from;
  }

  /// Adds a node, unless its pose or its mode is known at this place: each mode counts once.
  void add_pose(const Groups& groups, std::size_t from, std::size_t k, const Held& held, const FittedPose& best) {
    if (const KnownPose* known = find_known(fit_, best, column_.known[k])) {
      result_.owner[from] = known->group;
      return;
    }
    PosteriorNode node = maker_.node_at(held, best);
    const auto same = std::find_if(column_.known[k].begin(), column_.known[k].end(),
                                   [&](const KnownPose& one) { return is_about(node, one.mode); });
    const bool is_new = same == column_.known[k].end();
    // Of a new mode the group that holds its heading; of a known one that one's, so that nothing is counted twice.
    node.group = is_new ? home_of(best.pose.heading, groups, from) : same->group;
    if (node.group != from) result_.owner[from] = node.group;
    column_.known[k].push_back({best, node.pose, node.group});
    if (!is_new) return;
    node.log_weight = node.log_density + column_.log_weights[k];
    // The node stands for a step of u: uniform on it, with variance step^2 / 12 along the way of the pose.
    if (column_.step > 0) {
      const Eigen::Vector3d along = column_.step * fit_.by_place(best, held).pose;
      node.covariance += fit_.at_origin(node.pose, along * along.transpose() / 12);
    }
    if (std::isfinite(node.log_weight)) result_.nodes.push_back(node);
  }

  PoseFit& fit_;
  const CellSets& sets_;
  std::size_t first_;
  std::size_t most_places_;
  // Of the first touch, looked at so far, with their groups.
  std::size_t places_ = 0;
  NodeMaker maker_;
  std::vector<bool> hopeless_;
  Column column_;
  std::vector<FittedPose> middles_;  // of each group, in the middle of the stretch
  Posterior result_;
};

}  // namespace

Posterior posterior_of(PoseFit& fit, const CellSets& sets, std::size_t first_touch, std::size_t most_places) {
  return Weigher(fit, sets, first_touch, most_places).posterior();
}

}  // namespace rollfix::touch
