#include "posterior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "outline/turn.hpp"
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
    for (const PathPlace& place : best.places) {  // each about as wide as its own sd
      const auto touch = static_cast<std::size_t>(&place - best.places.data());
      if (touch != first_) node.log_density += std::log(fit_.touches()[touch].place_unit);
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
        if (k != first_) places[k] = downhill(fit_.path(), fit_.in_part(pose, k), places[k]);
      }
    }
  }

  Normals summed(const Held& held, const Pose& pose, const std::vector<PathPlace>& places, double& log_likelihood) {
    Normals sum = fit_.prior_normals(pose);
    const CentrePoint point = fit_.path().at(held.place);
    const Normals of_first = fit_.normals_at(pose, first_, point);
    sum.matrix += of_first.matrix;
    sum.slope += of_first.slope;
    log_likelihood = -0.5 * fit_.prior_square(pose) - 0.5 * distance_at(point, fit_.in_part(pose, first_)).square;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (k == first_) continue;
      const TiltedTouch tilted = tilted_touch(fit_, pose, k, places[k]);
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
  double step = 0;
  std::vector<std::vector<KnownPose>> known;
};

Column column_of(PoseFit& fit, std::int32_t node, std::size_t touch) {
  const PathTree::Node& at = fit.tree().node(node);
  const PathPlace middle{static_cast<std::size_t>(at.stretch), at.u.middle()};
  const Measured& one = fit.touches()[touch];
  InPart alike{Vec2::Zero(), one.tangent, one.place_unit, one.angle_unit};
  const double weight = distance_at(fit.path().at(middle), alike).weight;
  const int count = std::max(1, static_cast<int>(std::ceil(at.u.width() * std::sqrt(weight) / kStep)));
  Column column;
  column.node = node;
  column.step = at.u.width() / count;
  for (int k = 0; k < count; ++k) column.places.push_back(at.u.lo + (k + 0.5) * column.step);
  column.known.resize(column.places.size());
  return column;
}

/// One in so many cells of a component is started from to see how well it fits at all; no fewer and no more than these.
constexpr std::size_t kCellsPerLook = 6;
constexpr std::size_t kLeastLooks = 4;
constexpr std::size_t kMostLooks = 40;

/// The least sum of squares that is found from a few of a component's cells.
double least_square(PoseFit& fit, const CellSets& sets, const std::vector<std::size_t>& component,
                    std::size_t first_touch) {
  std::vector<std::size_t> cells;
  for (const std::size_t g : component) cells.insert(cells.end(), sets.groups[g].begin(), sets.groups[g].end());
  const std::size_t looks = std::min(cells.size(), std::clamp(cells.size() / kCellsPerLook, kLeastLooks, kMostLooks));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t look = 0; look < looks; ++look) {
    const Cell& cell = sets.cells[cells[(2 * look + 1) * cells.size() / (2 * looks)]];
    const PathTree::Node& node = fit.tree().node(cell.first);
    const Held held{first_touch, {static_cast<std::size_t>(node.stretch), node.u.middle()}};
    least = std::min(least, fit.fit(fit.pose_at(held, cell.heading.middle)).square);
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
    const auto stretch = static_cast<std::size_t>(fit.tree().node(first).stretch);
    const double length = length_per_u(fit.path(), stretch);
    if (hopeless[g] || !(length > 0)) continue;
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
        node.log_weight = node.log_density + std::log(column.step * length);
        if (std::isfinite(node.log_weight)) result.nodes.push_back(node);
      }
    }
  }
  return result;
}

}  // namespace rollfix::touch
