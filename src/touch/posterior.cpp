#include "posterior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "outline/turn.hpp"
#include "roll_belief.hpp"
#include "tilted_touch.hpp"

namespace rollfix::touch {
namespace {

// The grid's step, in standard deviations of the first touch's own place. The density by it is no narrower than they
// are, and the midpoint rule is off by exp(-2 pi^2) of a normal one.
constexpr double kStep = 1;
// Starts at headings no further apart than this, radians, so that each best pose is found from one of them.
constexpr double kStartApart = 0.35;
constexpr int kMostStarts = 9;
// So many neighbouring cells have one best pose.
constexpr std::size_t kFewCells = 4;
// Two best poses at one place that are nearer, in standard deviations, are one.
constexpr double kSamePose = 0.2;
// Newton's steps from the best pose to the mode of the tilted likelihood; one worth less than this, half the square of
// standard deviations, is taken along without another look.
constexpr int kMostTilts = 4;
constexpr double kSmallTilt = 0.05;
constexpr double kLargeTilt = 4;
// Squares that exceed the least known by more are worth exp(-25) of it: such a place is not looked at closely.
constexpr double kHopeless = 50;

/// The pose about which all others lie, given the first touch's place.
class NodeMaker {
 public:
  NodeMaker(PoseFit& fit, std::size_t first_touch) : fit_(fit), first_(first_touch) {}

  PosteriorNode node_at(const Held& held, const FittedPose& best) {
    least_square_ = std::min(least_square_, best.square);
    return best.square > least_square_ + kHopeless ? rough_node(best) : tilted_node(held, best);
  }

 private:
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
        node.log_density += k == first_ ? at.log_peak - at.log_density : at.log_peak + at.log_weight - at.log_density;
      } else if (k != first_) {
        node.log_density += std::log(touch.place_unit);
      }
    }
    node.log_density -= 0.5 * std::log(best.information.determinant());
    return node;
  }

  PosteriorNode tilted_node(const Held& held, const FittedPose& best) {
    Pose pose = best.pose;
    std::vector<PathPlace> places = best.places;
    PosteriorNode node;
    node.square = best.square;
    node.best = best.pose;
    for (int tilt = 0;; ++tilt) {
      double log_likelihood = 0;
      const Normals sum = summed(held, pose, places, log_likelihood);
      Eigen::LDLT<Eigen::Matrix3d> solver(sum.matrix);
      if (!(solver.info() == Eigen::Success && solver.vectorD().minCoeff() > 0)) solver.compute(best.information);
      Eigen::Vector3d step = solver.solve(sum.slope);
      const double gain = step.dot(sum.slope);
      if (gain <= kSmallTilt || tilt == kMostTilts) {
        if (gain > kLargeTilt) step *= std::sqrt(kLargeTilt / gain);
        node.pose = fit_.moved(pose, step);
        node.covariance = fit_.at_origin(node.pose, solver.solve(Eigen::Matrix3d::Identity()));
        node.log_density =
            log_likelihood + 0.5 * std::min(gain, kLargeTilt) - 0.5 * solver.vectorD().array().log().sum();
        return node;
      }
      if (gain > kLargeTilt) step *= std::sqrt(kLargeTilt / gain);
      pose = fit_.moved(pose, step);
      for (std::size_t k = 0; k < places.size(); ++k) {
        if (k != first_) places[k] = fit_.downhill_from(places[k], pose, k);
      }
    }
  }

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
  double least_square_ = std::numeric_limits<double>::infinity();
};

/// A best pose, and the group that it was found from first.
struct KnownPose {
  FittedPose fitted;
  std::size_t group = 0;
};

/// Which of those that are known at the place a pose is; the end if it is none.
std::vector<KnownPose>::const_iterator find_known(const PoseFit& fit, const FittedPose& found,
                                                  const std::vector<KnownPose>& known) {
  return std::find_if(known.begin(), known.end(), [&](const KnownPose& one) {
    const Pose& pose = one.fitted.pose;
    Eigen::Vector3d apart(0, 0, nearest_angle(pose.heading - found.pose.heading));
    const Pose turned = fit.moved(found.pose, apart);  // about the same point as the information
    apart.head<2>() = Vec2(pose.x - turned.x, pose.y - turned.y);
    return apart.dot(found.information * apart) <= kSamePose * kSamePose;
  });
}

/// The headings to start from: of a few of the group's cells, and of a wide one several.
std::vector<double> start_headings(const CellSets& sets, const std::vector<std::size_t>& group) {
  std::vector<double> headings;
  std::vector<std::size_t> chosen = {group[group.size() / 2]};
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
};

/// The roll's own nodes on the stretch.
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

Column column_of(PoseFit& fit, std::int32_t node, std::size_t touch) {
  const PathTree::Node& at = fit.tree(touch).node(node);
  if (const RollBelief* roll = fit.touches()[touch].roll) return column_of_roll(*roll, at, node);
  const PathPlace middle{static_cast<std::size_t>(at.stretch), at.u.middle()};
  const Measured& one = fit.touches()[touch];
  InPart alike{Vec2::Zero(), true, one.tangent, one.place_unit, one.angle_unit};
  const double weight = distance_at(fit.path(touch).at(middle), alike).weight;
  const int count = std::max(1, static_cast<int>(std::ceil(at.u.width() * std::sqrt(weight) / kStep)));
  const double step = at.u.width() / count;
  const double length = step * length_per_u(fit.path(touch), static_cast<std::size_t>(at.stretch));
  Column column;
  column.node = node;
  if (!(length > 0)) return column;
  for (int k = 0; k < count; ++k) {
    column.places.push_back(at.u.lo + (k + 0.5) * step);
    column.log_weights.push_back(std::log(length));
  }
  column.known.resize(column.places.size());
  return column;
}

/// One in so many cells of a component is started from to see how well it fits at all; no fewer and no more than these.
constexpr std::size_t kCellsPerLook = 6;
constexpr std::size_t kLeastLooks = 4;
constexpr std::size_t kMostLooks = 40;

/// A pose to start from with the first touch on this stretch; none where a roll's belief has nothing there.
std::optional<Pose> start_in(const PoseFit& fit, const PathTree::Node& node, double heading, std::size_t touch) {
  const auto stretch = static_cast<std::size_t>(node.stretch);
  const RollBelief* roll = fit.touches()[touch].roll;
  if (roll == nullptr) return fit.pose_at({touch, {stretch, node.u.middle()}}, heading);
  const auto [begin, end] = roll->nodes_in(stretch, node.u);
  if (begin == end) return std::nullopt;
  return roll->pose_at(roll->nodes()[begin + (end - begin) / 2]);
}

/// The least sum of squares that is found from a few of a component's cells.
double least_square(PoseFit& fit, const CellSets& sets, const std::vector<std::size_t>& component,
                    std::size_t first_touch) {
  std::vector<std::size_t> cells;
  for (const std::size_t g : component) cells.insert(cells.end(), sets.groups[g].begin(), sets.groups[g].end());
  const std::size_t looks = std::min(cells.size(), std::clamp(cells.size() / kCellsPerLook, kLeastLooks, kMostLooks));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t look = 0; look < looks; ++look) {
    const Cell& cell = sets.cells[cells[(2 * look + 1) * cells.size() / (2 * looks)]];
    const PathTree::Node& node = fit.tree(first_touch).node(cell.first);
    const std::optional<Pose> start = start_in(fit, node, cell.heading.middle, first_touch);
    if (start) least = std::min(least, fit.fit(*start).square);
  }
  return least;
}

/// Of each group whether its component fits so badly, next to the best, that it has no probability to speak of.
std::vector<bool> hopeless_groups(PoseFit& fit, const CellSets& sets, std::size_t first_touch) {
  std::vector<double> squares;
  for (const std::vector<std::size_t>& component : sets.components) {
    squares.push_back(least_square(fit, sets, component, first_touch));
  }
  const double least = squares.empty() ? 0 : *std::min_element(squares.begin(), squares.end());
  std::vector<bool> hopeless(sets.groups.size(), false);
  for (std::size_t c = 0; c < squares.size(); ++c) {
    for (const std::size_t g : sets.components[c]) hopeless[g] = squares[c] > least + kHopeless;
  }
  return hopeless;
}

}  // namespace

std::size_t count_places(PoseFit& fit, const CellSets& sets, std::size_t first_touch) {
  std::size_t count = 0;
  Column column;
  for (const std::vector<std::size_t>& group : sets.groups) {
    const std::int32_t first = sets.cells[group.front()].first;
    if (column.node != first) column = column_of(fit, first, first_touch);
    count += column.places.size();
  }
  return count;
}

Posterior posterior_of(PoseFit& fit, const CellSets& sets, std::size_t first_touch) {
  Posterior result;
  result.owner.assign(sets.groups.size(), Posterior::kNone);
  const std::vector<bool> hopeless = hopeless_groups(fit, sets, first_touch);
  for (const std::vector<std::size_t>& component : sets.components)
    result.hopeless += hopeless[component.front()] ? 1 : 0;
  NodeMaker maker(fit, first_touch);
  Column column;
  for (std::size_t g = 0; g < sets.groups.size(); ++g) {
    const std::vector<std::size_t>& group = sets.groups[g];
    const std::int32_t first = sets.cells[group.front()].first;
    const auto stretch = static_cast<std::size_t>(fit.tree(first_touch).node(first).stretch);
    if (hopeless[g]) continue;
    if (column.node != first) column = column_of(fit, first, first_touch);
    const std::vector<double> headings = start_headings(sets, group);
    for (std::size_t k = 0; k < column.places.size(); ++k) {
      const Held held{first_touch, {stretch, column.places[k]}};
      for (const double heading : headings) {
        const FittedPose best = fit.fit(fit.pose_at(held, heading), held);
        const auto known = find_known(fit, best, column.known[k]);
        if (known != column.known[k].end()) {
          result.owner[g] = known->group;
          continue;
        }
        column.known[k].push_back({best, g});
        PosteriorNode node = maker.node_at(held, best);
        node.group = g;
        node.log_weight = node.log_density + column.log_weights[k];
        if (std::isfinite(node.log_weight)) result.nodes.push_back(node);
      }
    }
  }
  return result;
}

}  // namespace rollfix::touch
