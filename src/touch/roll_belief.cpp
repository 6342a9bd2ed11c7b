#include "roll_belief.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "outline/turn.hpp"
#include "rollfix/touch.hpp"

// Notation:
//   u_j, p_j       a node's place of the roll's first contact, and the probability of its stretch: `place`,
//                  `log_weight`
//   c_j, t_j       where the finger's centre was then, and how the part's tangent pointed, both in the world, if the
//                  first contact is at u_j: means of a normal distribution with information Q_j: `at`, `tangent`,
//                  `information`
//   o(u), a(u)     the centre and the tangent's angle in the part's frame: `point`
//   e_j            residual of a pose (X, phi): (c_j - X - R(phi) o(u_j), t_j - a(u_j) - phi)
//   L              likelihood of the pose, sum_j p_j N(e_j; Q_j): `tilted`; its largest term, but for how dense the
//                  belief is, is r^2 = e^T Q e - 2 log(density / largest): `square`
// The belief of one roll, docs/belief.md, as a contact of docs/touch.md, "How it works".
namespace rollfix::touch {
namespace {

// Nodes of one piece of the belief at most: one on a long straight side, with centres that are known well.
constexpr double kMostNodes = 2000;
// What centres and tangents are known to at best: shares of the perimeter, radians. The covariance may be singular.
constexpr double kLeastCentre = 1e-9;
constexpr double kLeastAngle = 1e-11;
// Centres that are no evidence are about exact, so that they say where the part is if the first contact is known.
constexpr double kReference = 1e-6;
// Places that differ by less are one: of the perimeter, and radians.
constexpr double kSamePlace = 1e-9;

// Three numbers together are beyond so many standard deviations as rarely as one is beyond kPossibleSigmas.
constexpr double kPoseSigmas = 5.2;

/// p(s) + r n in the part's frame.
Vec2 centre_at(const CentrePath& path, const PosePiece::End& end) {
  return path.part().point(end.s) + path.radius() * Vec2(std::sin(end.tangent), -std::cos(end.tangent));
}

/// Where a path has this place of the boundary.
/// `is_corner`: on a pivot at this corner with this tangent, else on a stretch along a spiral. None: the path leaves it
/// out.
std::optional<PathPlace> find_place(const CentrePath& path, double s, double tangent, bool is_corner) {
  const Boundary boundary = path.part().boundary();
  const double slack = kSamePlace * path.part().perimeter();
  for (std::size_t k = 0; k < path.stretches().size(); ++k) {
    const CentreStretch& stretch = path.stretches()[k];
    if (stretch.corner != is_corner) continue;
    if (is_corner) {
      const double u = stretch.u.middle() + nearest_angle(tangent - stretch.u.middle());
      const bool is_here = boundary.distance(s, stretch.s) <= slack &&
                           std::abs(u - stretch.u.middle()) <= 0.5 * stretch.u.width() + kSamePlace;
      if (is_here) return PathPlace{k, std::clamp(u, stretch.u.lo, stretch.u.hi)};
      continue;
    }
    const double u = boundary.canonical(s);
    if (u >= stretch.u.lo && u <= stretch.u.hi) return PathPlace{k, u};
  }
  return std::nullopt;
}

/// The centre's and the tangent's covariance at an end of a piece.
/// The piece has that of the part's pose; the centre in the world moves by the arm R c from the pose's origin times
/// dphi.
Eigen::Matrix3d covariance_at(const CentrePath& path, const PosePiece::End& end) {
  Eigen::Matrix3d by = Eigen::Matrix3d::Identity();
  by.topRightCorner<2, 1>() = turned_left(end.pose.mean.turned(centre_at(path, end)));
  return by * end.pose.covariance * by.transpose();
}

/// A pose with the cosine and the sine of its heading: for many nodes.
class Placed {
 public:
  explicit Placed(const Pose& pose) : pose_(pose), cosine_(std::cos(pose.heading)), sine_(std::sin(pose.heading)) {}

  /// e_j of the notation; the turn modulo 2 pi.
  Eigen::Vector3d miss_of(const RollNode& node) const {
    const Vec2& centre = node.point.centre;
    const double turn = node.tangent - node.point.angle - pose_.heading;
    return {node.at.x() - pose_.x - cosine_ * centre.x() + sine_ * centre.y(),
            node.at.y() - pose_.y - sine_ * centre.x() - cosine_ * centre.y(),
            turn - kFullTurn * std::rint(turn / kFullTurn)};
  }
  /// In standard deviations, squared, and by how dense the belief is.
  double square_of(const RollNode& node) const {
    const Eigen::Vector3d off = miss_of(node);
    return off.dot(node.information * off) - 2 * node.log_density;
  }

 private:
  Pose pose_;
  double cosine_;
  double sine_;
};

/// Of one node alone.
Eigen::Vector3d miss_of(const RollNode& node, const Pose& pose) { return Placed(pose).miss_of(node); }

/// How the residual changes along the boundary.
Eigen::Vector3d by_place(const RollNode& node, const Pose& pose) {
  const Vec2 along = -pose.turned(node.point.along);
  return {along.x(), along.y(), -node.point.bend};
}

}  // namespace

/// Nodes in order of their places; `log_density` is made a share of the largest, so at most 0.
RollBelief::RollBelief(const CentrePath& path, const std::vector<PosePiece>& pieces, RollCentre centre)
    : path_(path), centre_(centre) {
  for (const PosePiece& piece : pieces) add(piece);
  std::sort(nodes_.begin(), nodes_.end(), [](const RollNode& a, const RollNode& b) {
    return std::tie(a.place.stretch, a.place.u) < std::tie(b.place.stretch, b.place.u);
  });
  double most = -std::numeric_limits<double>::infinity();
  for (const RollNode& node : nodes_) most = std::max(most, node.log_density);
  for (RollNode& node : nodes_) {
    node.log_density -= most;
    headings_.push_back({node.tangent - node.point.angle, node.heading_information, node.log_density});
  }
  logs_.resize(nodes_.size());
  add_slopes();
}

/// How the density changes from node to node.
/// By the divided differences of the nodes before and behind. At an end of a run of nodes the slope and the bend stay
/// 0.
void RollBelief::add_slopes() {
  const auto joined = [&](std::size_t k) {  // with the next one
    if (k + 1 >= nodes_.size() || nodes_[k].place.stretch != nodes_[k + 1].place.stretch) return false;
    const double apart = nodes_[k + 1].place.u - nodes_[k].place.u;
    return apart > 0 && apart <= nodes_[k].width + nodes_[k + 1].width;
  };
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    RollNode& node = nodes_[k];
    node.ends_before = k == 0 || !joined(k - 1);
    node.ends_behind = !joined(k);
    if (node.ends_before || node.ends_behind) continue;
    const RollNode& last = nodes_[k - 1];
    const RollNode& next = nodes_[k + 1];
    const double before = (node.log_density - last.log_density) / (node.place.u - last.place.u);
    const double behind = (next.log_density - node.log_density) / (next.place.u - node.place.u);
    node.density_slope = -0.5 * (before + behind);
    // Only where the density is concave: else `slide` has no minimum.
    node.density_bend = std::max(0.0, -(behind - before) / (0.5 * (next.place.u - last.place.u)));
  }
}

/// In so many nodes that from one to the next neither the heading nor the centre moves by more than a standard
/// deviation, nor the density by more than a factor e.
void RollBelief::add(const PosePiece& piece) {
  // How far apart its ends are, by what they say.
  const double heading = nearest_angle(piece.hi.pose.mean.heading - piece.lo.pose.mean.heading);
  double apart = std::abs(heading) / std::sqrt(std::max(piece.lo.pose.covariance(2, 2), kLeastAngle * kLeastAngle));
  if (centre_ == RollCentre::evidence) {
    const Eigen::Matrix3d covariance = covariance_at(path_, piece.lo);
    const Vec2 slid = centre_at(path_, piece.hi) - centre_at(path_, piece.lo);
    apart += slid.norm() / std::sqrt(std::max(0.5 * covariance.topLeftCorner<2, 2>().trace(),
                                              std::pow(kLeastCentre * path_.part().perimeter(), 2)));
  }
  const auto count = static_cast<int>(std::ceil(std::clamp(std::max(apart, std::abs(piece.rise)), 1.0, kMostNodes)));
  for (int k = 0; k < count; ++k) {
    add_node(piece, piece.lo, piece.hi, static_cast<double>(k) / count, (k + 1.0) / count);
  }
}

/// The share of the piece from `from` to `to`, in [0, 1]: means at its middle, by linear interpolation between the
/// ends.
void RollBelief::add_node(const PosePiece& piece, const PosePiece::End& lo, const PosePiece::End& hi, double from,
                          double to) {
  const double share = 0.5 * (from + to);
  const double s = lo.s + share * (hi.s - lo.s);
  const double tangent = lo.tangent + share * (hi.tangent - lo.tangent);
  // Cells of the belief in a corner are as short as its table of places is accurate.
  const bool is_point = !(hi.s - lo.s > kSamePlace * path_.part().perimeter());
  std::optional<PathPlace> place = is_point ? find_place(path_, s, tangent, true) : std::nullopt;
  const bool is_corner = place.has_value();
  if (!place) place = find_place(path_, s, tangent, false);
  if (!place) return;  // out of the finger's reach
  RollNode node;
  node.place = *place;
  node.point = path_.at(*place);
  // In the world: the part's heading and the tangent in its own frame.
  const double first_tangent = lo.pose.mean.heading + lo.tangent;
  const double last_tangent = hi.pose.mean.heading + hi.tangent;
  node.tangent = first_tangent + share * nearest_angle(last_tangent - first_tangent);
  node.at = (1 - share) * lo.pose.mean.world(centre_at(path_, lo)) + share * hi.pose.mean.world(centre_at(path_, hi));
  // A grain on the diagonal keeps it regular. The centre of a reference is known to kReference.
  Eigen::Matrix3d covariance = 0.5 * (covariance_at(path_, lo) + covariance_at(path_, hi));
  const double grain = (centre_ == RollCentre::reference ? kReference : kLeastCentre) * path_.part().perimeter();
  covariance.diagonal() += Eigen::Vector3d(grain * grain, grain * grain, kLeastAngle * kLeastAngle);
  // The marginal of the tangent: rows of the centre stay 0.
  if (centre_ == RollCentre::unused) {
    node.information(2, 2) = 1 / covariance(2, 2);
    node.log_peak = 0.5 * std::log(node.information(2, 2));
  } else {
    const Eigen::LDLT<Eigen::Matrix3d> solver(covariance);
    node.information = solver.solve(Eigen::Matrix3d::Identity());
    node.log_peak = -0.5 * solver.vectorD().array().log().sum();
  }
  node.heading_information = 1 / covariance(2, 2);
  // The density of a piece grows as exp(rise t), t in [0, 1]: the share of its mass between `from` and `to`.
  const double rise = piece.rise;
  const double part =
      std::abs(rise) < 1e-9 ? to - from : std::exp(rise * from) * std::expm1(rise * (to - from)) / std::expm1(rise);
  // A pivot is worth r per radian; of a point, where it has no length, P / (2 pi).
  const double pivot = path_.radius() > 0 ? path_.radius() : path_.part().perimeter() / kFullTurn;
  const double length = is_corner ? pivot * std::abs(hi.tangent - lo.tangent) : hi.s - lo.s;
  node.width = (is_corner ? std::abs(hi.tangent - lo.tangent) : hi.s - lo.s) * (to - from);
  node.log_weight = std::log(piece.probability * part);
  node.log_density =
      node.log_weight - std::log(std::max(length, kLeastCentre * path_.part().perimeter()) * (to - from));
  if (std::isfinite(node.log_weight) && std::isfinite(node.log_peak)) nodes_.push_back(node);
}

/// By bisection, as nodes are in order of stretch and u.
std::pair<std::size_t, std::size_t> RollBelief::nodes_in(std::size_t stretch, const Interval& u) const {
  const auto before = [](const RollNode& node, const PathPlace& place) {
    return std::tie(node.place.stretch, node.place.u) < std::tie(place.stretch, place.u);
  };
  const auto begin = std::lower_bound(nodes_.begin(), nodes_.end(), PathPlace{stretch, u.lo}, before);
  auto end = std::lower_bound(begin, nodes_.end(), PathPlace{stretch, u.hi}, before);
  // A stretch has its upper end as well.
  const bool is_last = u.hi >= path_.stretches()[stretch].u.hi;
  while (is_last && end != nodes_.end() && end->place.stretch == stretch && end->place.u <= u.hi) ++end;
  return {static_cast<std::size_t>(begin - nodes_.begin()), static_cast<std::size_t>(end - nodes_.begin())};
}

const RollNode& RollBelief::at(const PathPlace& place) const {
  return nodes_[nodes_in(place.stretch, {place.u, place.u}).first];
}

/// e_j = 0: phi = t_j - a(u_j), X = c_j - R(phi) o(u_j).
Pose RollBelief::pose_at(const RollNode& node) const {
  Pose pose{0, 0, node.tangent - node.point.angle};
  const Vec2 place = node.at - pose.turned(node.point.centre);
  return {place.x(), place.y(), pose.heading};
}

/// Over all nodes, from the last answer on, which gives a small bound. The heading's square alone is a lower bound of
/// e^T Q e, its information being that of the marginal.
const RollNode& RollBelief::nearest(const Pose& pose) const {
  const Placed placed(pose);
  std::size_t best = nearest_;
  double least = placed.square_of(nodes_[best]);
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const OfHeading& node = headings_[k];
    const double turn = node.heading - pose.heading;
    const double off = turn - kFullTurn * std::rint(turn / kFullTurn);
    if (off * off * node.information - 2 * node.log_density > least) continue;  // by the heading alone
    const double square = placed.square_of(nodes_[k]);
    if (square > least || (square == least && k > best)) continue;  // whichever was asked for before
    least = square;
    best = k;
  }
  nearest_ = best;
  return nodes_[best];
}

/// A step past the last node is to the first one; ends where both neighbours fit worse.
const RollNode& RollBelief::downhill(const Pose& pose, const RollNode& from) const {
  const Placed placed(pose);
  auto best = static_cast<std::size_t>(&from - nodes_.data());
  double least = placed.square_of(from);
  for (const std::size_t step : {std::size_t{1}, nodes_.size() - 1}) {  // one way, then the other
    for (;;) {
      const std::size_t next = (best + step) % nodes_.size();
      const double square = placed.square_of(nodes_[next]);
      if (square >= least) break;
      least = square;
      best = next;
    }
  }
  return nodes_[best];
}

Eigen::Vector3d RollBelief::residual(const Pose& pose, const RollNode& node) const { return miss_of(node, pose); }

/// How dense the belief is does not count: the miss alone, after the slide within the node.
double RollBelief::worst(const Pose& pose, const RollNode& node) const {
  const double miss = std::max(0.0, square(pose, node, true) + 2 * node.log_density);
  return std::sqrt(miss) / (centre_ == RollCentre::unused ? kPossibleSigmas : kPoseSigmas);
}

/// One Gauss-Newton step along the path, clamped to half the node's width. The residual is linear in u there.
RollBelief::Slide RollBelief::slide(const Pose& pose, const RollNode& node) const {
  const Eigen::Vector3d off = miss_of(node, pose);
  const Eigen::Vector3d by = by_place(node, pose);
  const double weight = by.dot(node.information * by) + node.density_bend;
  // Half the derivative of the squares, with its sign.
  const double slope = -by.dot(node.information * off) - node.density_slope;
  Slide slide;
  if (weight > 0) {
    const double wanted = slope / weight;
    slide.by = std::clamp(wanted, -0.5 * node.width, 0.5 * node.width);
    // At an inner node a clamped step is free as well: the next node goes on from there.
    slide.is_free = slide.by == wanted || (wanted < 0 ? !node.ends_before : !node.ends_behind);
  }
  // Between nodes the density is about what a parabola makes of it.
  const double square = off.dot(node.information * off) - 2 * node.log_density;
  slide.square = std::max(0.0, square - 2 * slide.by * slope + slide.by * slide.by * weight);
  return slide;
}

double RollBelief::square(const Pose& pose, const RollNode& node, bool slides) const {
  if (slides) return slide(pose, node).square;
  const Eigen::Vector3d off = miss_of(node, pose);
  return off.dot(node.information * off) - 2 * node.log_density;
}

/// J^T Q J and -J^T Q e. `slides`: with u eliminated by the Schur complement, as M of pose_fit.cpp, with the belief's
/// own slope and bend.
Normals RollBelief::normals(const Pose& pose, const RollNode& node, const Vec2& about, bool slides) const {
  Eigen::Matrix3d by_step = Eigen::Matrix3d::Identity();
  // A turn about `about` moves the node's centre by its arm from there.
  by_step.topRightCorner<2, 1>() = turned_left(pose.world(node.point.centre) - about);
  const Eigen::Vector3d off = miss_of(node, pose);
  Eigen::Matrix3d information = node.information;
  Eigen::Vector3d slope = information * off;
  if (slides && slide(pose, node).is_free) {
    const Eigen::Vector3d by = information * by_place(node, pose);
    const double weight = by_place(node, pose).dot(by) + node.density_bend;
    information -= by * by.transpose() / weight;
    slope += by * ((-by.dot(off) - node.density_slope) / weight);
  }
  Normals normals;
  normals.matrix = by_step.transpose() * information * by_step;
  normals.slope = by_step.transpose() * slope;
  return normals;
}

/// L = sum_j p_j N(e_j; Q_j), and its log's derivatives as tilted_touch.cpp has them: slope E g, matrix E M - Cov g.
TiltedTouch RollBelief::tilted(const Pose& pose, const Vec2& about) const {
  constexpr double kNothing = 40;  // exp(-40) of the largest
  const Placed placed(pose);
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Eigen::Vector3d off = placed.miss_of(nodes_[k]);
    logs_[k] = nodes_[k].log_weight + nodes_[k].log_peak - 0.5 * off.dot(nodes_[k].information * off);
    most = std::max(most, logs_[k]);
  }
  TiltedTouch result;
  double sum = 0;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    // Such a node adds nothing.
    if (!(logs_[k] > most - kNothing)) continue;
    const double weight = std::exp(logs_[k] - most);
    const Normals one = normals(pose, nodes_[k], about, false);
    sum += weight;
    result.normals.slope += weight * one.slope;
    result.normals.matrix += weight * one.matrix;
    spread += weight * one.slope * one.slope.transpose();
  }
  result.log_likelihood = most + std::log(sum);
  result.normals.slope /= sum;
  result.normals.matrix =
      result.normals.matrix / sum - (spread / sum - result.normals.slope * result.normals.slope.transpose());
  return result;
}

}  // namespace rollfix::touch
