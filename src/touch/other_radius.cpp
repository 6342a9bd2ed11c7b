#include "steps.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "belief/posterior.hpp"
#include "cell_search.hpp"
#include "centre_path.hpp"
#include "outline/turn.hpp"
#include "pose_fit.hpp"
#include "problem.hpp"

// Notation:
//   r, dr          the finger's radius, and by how much it grows
//   (X, phi)       the part's pose
//   e_k            residuals of touch k, in standard deviations: of the centre along the normal, de/dr = 1 / sd, and of
//                  the normal where it was felt
// Least squares over (X, phi, r) by Gauss-Newton's steps on r, each from the pose that fits best with the last r.
namespace rollfix::touch {
namespace {

// Radii to start from: shares of the stated one; without one shares of the part's perimeter. Each serves for radii
// nearer to it than this share of itself.
constexpr double kShares[] = {0.6, 0.85, 1.15, 1.5};
constexpr double kPerimeterShares[] = {0.003, 0.006, 0.012, 0.024, 0.048};
constexpr double kReach = 0.25;
constexpr double kReachWithout = 0.5;
// Poses to start from at each, and so many of them that are followed, each by Gauss-Newton steps on the radius.
constexpr std::size_t kStarts = 24;
constexpr std::size_t kFollowed = 3;
constexpr int kSteps = 5;
// One that differs by less than this many standard deviations of a place is not another radius.
constexpr double kSameRadius = 1;
// Comparisons of each search: what takes longer is no usual mistake.
constexpr std::size_t kRadiusBudget = kTouchBudget / 200;

TouchProblem with_radius(const TouchProblem& problem, double radius) {
  TouchProblem result = problem;
  result.finger = disk(radius);
  return result;
}

/// By how much the radius has to grow so that the touches fit best, and their sum of squares then: the pose moves along
/// with it, so its three unknowns are solved for as well.
struct RadiusStep {
  double step = 0;
  double square = 0;
};

/// Nothing where the touches do not say it.
/// Normal equations of (dx, dy, dphi, dr). A touch's residual along the normal grows by n . (move of the pose) + dr;
/// its place on the boundary, which moves along the tangent, is eliminated by taking the normal part alone.
std::optional<RadiusStep> radius_step(const PoseFit& fit, const FittedPose& fitted) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d slope = Eigen::Vector4d::Zero();
  const auto add = [&](const Eigen::Vector4d& row, double residual) {
    matrix += row * row.transpose();
    slope += row * residual;
  };
  for (std::size_t k = 0; k < fitted.places.size(); ++k) {
    const Measured& touch = fit.touches()[k];
    const CentrePoint at = fit.path(k).at(fitted.places[k]);
    // The outward normal of the part at the contact, in the world.
    const double tangent = at.angle + fitted.pose.heading;
    const Vec2 normal(std::sin(tangent), -std::cos(tangent));
    const Vec2 centre = fitted.pose.world(at.centre);
    const Vec2 arm = centre - fit.about();
    // dphi moves the centre by left(arm): its part along n is the third number.
    add(Eigen::Vector4d(normal.x(), normal.y(), normal.y() * arm.x() - normal.x() * arm.y(), 1) / touch.place_unit,
        (touch.at - centre).dot(normal) / touch.place_unit);
    if (!touch.tangent) continue;
    add({0, 0, 1 / touch.angle_unit, 0}, nearest_angle(*touch.tangent - tangent) / touch.angle_unit);
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(matrix);
  // A singular matrix: radius and pose can't be told apart, as with too few touches.
  if (!(solver.info() == Eigen::Success && solver.vectorD().minCoeff() > 1e-9 * solver.vectorD().maxCoeff())) {
    return std::nullopt;
  }
  const Eigen::Vector4d step = solver.solve(slope);
  // By the linear model the squares fall by step . slope.
  return RadiusStep{step(3), fitted.square - step.dot(slope)};
}

/// A pose to go on from.
struct Start {
  Pose pose;
  RadiusStep next;
};

/// Poses that fit about, with a finger whose radius may be off by so much; the most promising first.
/// `off`: the tolerance of places is widened by it, so that the cells of any radius that near are kept.
std::vector<Start> starts_of(const TouchProblem& problem, double radius, double off) {
  const CentrePath path(problem.part, radius);
  if (path.stretches().empty()) return {};
  PathTree tree(path);
  std::vector<Measured> touches = measured(problem);
  for (Measured& touch : touches) {
    touch.tree = &tree;
    touch.place_most = std::hypot(touch.place_most, off);
  }
  const TouchPair pair = choose_pair(touches);
  const std::vector<Cell> cells = CellSearch(touches, pair, kRadiusBudget).search().fit;
  PoseFit fit(touches, problem.pose);
  std::vector<Start> starts;
  const std::size_t count = std::min(kStarts, cells.size());
  for (std::size_t k = 0; k < count; ++k) {
    // Spread evenly over the cells.
    const Cell& cell = cells[(2 * k + 1) * cells.size() / (2 * count)];
    const PathTree::Node& node = tree.node(cell.first);
    const Held held{pair.first, {static_cast<std::size_t>(node.stretch), node.u.middle()}};
    const FittedPose fitted = fit.fit(fit.pose_at(held, cell.heading.middle));
    if (const auto next = radius_step(fit, fitted)) starts.push_back({fitted.pose, *next});
  }
  // By what the next step promises, not by the squares now.
  std::sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.next.square < b.next.square; });
  if (starts.size() > kFollowed) starts.resize(kFollowed);
  return starts;
}

/// A radius, and the squares that are left with it.
struct FittedRadius {
  double radius = 0;
  double square = 0;
};

/// The radius that fits best, from a pose. Nothing where it goes off.
/// kSteps Gauss-Newton steps; each radius has its own path of centres. None: the radius leaves twice its reach, is not
/// above 0, fits nowhere, or the touches stop telling it. `square` is that of the last fit.
std::optional<FittedRadius> follow(const TouchProblem& problem, double radius, double reach, const Start& start) {
  std::vector<Measured> touches = measured(problem);
  const double from = radius;
  Pose pose = start.pose;
  double step = start.next.step;
  double square = start.next.square;
  for (int k = 0; k < kSteps; ++k) {
    radius += step;
    // It has left the radii that this start serves for.
    if (!(radius > 0 && std::abs(radius - from) <= 2 * reach)) return std::nullopt;
    const CentrePath path(problem.part, radius);
    if (path.stretches().empty()) return std::nullopt;
    PathTree tree(path);
    for (Measured& touch : touches) touch.tree = &tree;
    PoseFit fit(touches, problem.pose);
    const FittedPose fitted = fit.fit(pose);
    const std::optional<RadiusStep> next = radius_step(fit, fitted);
    if (!next) return std::nullopt;
    pose = fitted.pose;
    step = next->step;
    square = fitted.square;
  }
  return FittedRadius{radius, square};
}

/// The radius near this one that fits best.
/// `reach`: of the radii that this start serves for, length.
std::optional<FittedRadius> fitted_radius(const TouchProblem& given, double radius, double reach) {
  const TouchProblem problem = given.mirrored ? in_mirror(given) : given;
  std::optional<FittedRadius> best;
  for (const Start& start : starts_of(problem, radius, reach)) {
    const std::optional<FittedRadius> found = follow(problem, radius, reach, start);
    if (found && (!best || found->square < best->square)) best = found;
  }
  return best;
}

/// One degree of freedom less, for the radius.
/// None where no check is left, or p < kExplains.
std::optional<TouchFit> fit_with(const TouchAnswer& answer) {
  if (answer.status != Status::complete || answer.poses.empty() || !answer.fit) return std::nullopt;
  TouchFit fit = *answer.fit;
  fit.freedom -= 1;
  if (fit.freedom < 1) return std::nullopt;
  fit.p = belief::p_of_chi_square(fit.chi_square, fit.freedom);
  return fit.p >= kExplains ? std::optional<TouchFit>(fit) : std::nullopt;
}

}  // namespace

/// None of fewer than two touches. Without a stated finger it may have been forgotten: radii are shares of the
/// perimeter then.
std::vector<TouchDiagnosis> other_radii(const TouchProblem& problem) {
  std::vector<TouchDiagnosis> told;
  if (problem.touches.size() < 2) return told;
  const double stated = problem.finger ? problem.finger->disk()->radius : 0;
  // One start: the radius that fits best near it, if it is none that is known, solved as a problem of its own.
  const auto look = [&](double start, double reach) {
    const std::optional<FittedRadius> fitted = fitted_radius(problem, start, reach);
    if (!fitted) return;
    const double radius = fitted->radius;
    if (std::abs(radius - stated) < kSameRadius * problem.noise->position) return;
    // Two starts may lead to one radius.
    for (const TouchDiagnosis& known : told) {
      if (std::abs(known.radius - radius) < kSameRadius * problem.noise->position) return;
    }
    // The fit was local: the whole search tells whether touches with this radius fit at all.
    const TouchAnswer found = solve_plain(with_radius(problem, radius));
    const std::optional<TouchFit> fit = fit_with(found);
    if (!fit) return;
    TouchDiagnosis what{TouchCause::radius};
    what.radius = radius;
    what.fit = *fit;
    what.poses = found.poses.size();
    what.pose = found.poses.front().pose;
    told.push_back(what);
  };
  if (problem.finger) {
    for (const double share : kShares) look(share * stated, kReach * share * stated);
  } else {
    for (const double share : kPerimeterShares) {
      const double start = share * problem.part.perimeter();
      look(start, kReachWithout * start);
    }
  }
  return told;
}

}  // namespace rollfix::touch
