#include "touch_and_prior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "outline/turn.hpp"
#include "tilted_touch.hpp"

// Notation:
//   q, t         the measured centre and the direction of the part's tangent there, with standard deviations sd, sd_t
//   X0, phi0     the part's place and heading as they are known beforehand, with sd_0 and sd_phi
//   o(u), a(u)   the finger's centre and the tangent's angle in the part's frame, at place u of the path
//   (X, phi)     the pose: given u and phi, X is about X0 and about q - R(phi) o(u), so normal about their mean
// The density of the pose and of the contact's place is a sum over a grid of u and phi, with X in closed form.
namespace rollfix::touch {
namespace {

// The grid's steps, and how far it goes, in standard deviations of what is known of the two.
constexpr double kGridStep = 0.4;
constexpr double kGridEnd = 6;
// Where the density by u is less than this share of its largest, one set of poses ends.
constexpr double kLogBetweenSets = -7;

double squared(double value) { return value * value; }

/// The nodes of one place on the path, the largest density of which is so.
struct AtPlace {
  std::size_t begin = 0;
  std::size_t end = 0;
  double log_density = 0;
};

/// Touches at one place: along the normal, where they tell something, their mean.
Measured as_one(const std::vector<Measured>& touches) {
  Measured one = touches.front();
  double information = 0;
  Vec2 sum = Vec2::Zero();
  for (const Measured& touch : touches) {
    information += 1 / squared(touch.place_unit);
    sum += touch.at / squared(touch.place_unit);
  }
  one.at = sum / information;
  one.place_unit = 1 / std::sqrt(information);
  return one;
}

/// log of what the other touches' places on the boundary add up to, as each is anywhere by itself.
double log_of_others(const std::vector<Measured>& touches) {
  double sum = -std::log(as_one(touches).place_unit * std::sqrt(2 * std::numbers::pi));
  for (const Measured& touch : touches) sum += std::log(touch.place_unit * std::sqrt(2 * std::numbers::pi));
  return sum;
}

class Grid {
 public:
  explicit Grid(const Asked& asked)
      : touch_(as_one(asked.fit.touches())),
        path_(asked.fit.path(0)),
        prior_(*asked.problem.pose),
        place_sd_(std::hypot(touch_.place_unit, prior_.place_sd)) {
    for (std::size_t k = 0; k < path_.stretches().size(); ++k) add_stretch(k);
    const double log_weight = log_of_others(asked.fit.touches());
    for (PosteriorNode& node : nodes_) node.log_weight += log_weight;
  }

  /// Those of one set, whose places hang together, are of one group.
  std::vector<PosteriorNode> nodes() && {
    double most = -std::numeric_limits<double>::infinity();
    for (const AtPlace& one : places_) most = std::max(most, one.log_density);
    const auto is_low = [&](const AtPlace& one) { return one.log_density < most + kLogBetweenSets; };
    std::size_t set = 0;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (k > 0 && is_low(places_[k - 1]) && !is_low(places_[k])) ++set;
      for (std::size_t node = places_[k].begin; node < places_[k].end; ++node) nodes_[node].group = set;
    }
    const bool goes_round =
        path_.period() > 0 && !places_.empty() && !is_low(places_.front()) && !is_low(places_.back());
    for (PosteriorNode& node : nodes_) node.group = goes_round && node.group == set ? 0 : node.group;
    return std::move(nodes_);
  }

 private:
  /// Steps by u as fine as the density is wide, which a bend makes narrower where the normal is known.
  void add_stretch(std::size_t k) {
    const Interval& all = path_.stretches()[k].u;
    const double length = length_per_u(path_, k);
    if (!(length > 0)) return;
    for (double u = all.lo; u < all.hi;) {
      const CentrePoint point = path_.at({k, u});
      double step = std::min(all.hi - u, kGridStep * place_sd_ / point.along.norm());
      if (touch_.tangent && point.bend != 0) {
        const double turn_sd = std::hypot(touch_.angle_unit, prior_.heading_sd);
        step = std::min(step, kGridStep * turn_sd / std::abs(point.bend));
      }
      add_place(path_.at({k, u + 0.5 * step}), step, std::log(step * length));
      u += step;
    }
  }

  void add_place(const CentrePoint& point, double step, double log_length) {
    const double arm = point.centre.norm();
    const double known_arm = (touch_.at - Vec2(prior_.mean.x, prior_.mean.y)).norm();
    if (std::abs(arm - known_arm) > kGridEnd * place_sd_) return;  // in any heading
    double information = 1 / squared(prior_.heading_sd);
    double heading = prior_.mean.heading;
    double square = 0;
    if (touch_.tangent) {
      const double off = nearest_angle(*touch_.tangent - point.angle - heading);
      information += 1 / squared(touch_.angle_unit);
      heading += off / (squared(touch_.angle_unit) * information);
      square = squared(off) / (squared(touch_.angle_unit) + squared(prior_.heading_sd));
    }
    const double sd = 1 / std::sqrt(information);
    const double half = std::min(kGridEnd * sd, std::numbers::pi);
    const double most = kGridStep * std::min(sd, place_sd_ / std::max(arm, place_sd_));
    const int count = static_cast<int>(std::ceil(2 * half / most));
    const double turn = 2 * half / count;
    const std::size_t begin = nodes_.size();
    for (int k = 0; k < count; ++k) {
      const double off = (k + 0.5) * turn - half;
      add_node(point, heading + off, square + squared(off / sd), step, turn);
    }
    if (nodes_.size() == begin) return;
    AtPlace place{begin, nodes_.size(), -std::numeric_limits<double>::infinity()};
    for (std::size_t k = begin; k < nodes_.size(); ++k) {
      nodes_[k].log_weight = nodes_[k].log_density + log_length;
      place.log_density = std::max(place.log_density, nodes_[k].log_density);
    }
    places_.push_back(place);
  }

  void add_node(const CentrePoint& point, double heading, double square, double step, double turn) {
    const Pose turned{0, 0, heading};
    const Vec2 arm = turned.turned(point.centre);
    const Vec2 known(prior_.mean.x, prior_.mean.y);
    const Vec2 off = touch_.at - arm - known;
    square += off.squaredNorm() / squared(place_sd_);
    if (square > squared(kGridEnd)) return;
    const double share = squared(prior_.place_sd / place_sd_);  // of what was felt
    const double variance = share * squared(touch_.place_unit);
    PosteriorNode node;
    node.pose = {known.x() + share * off.x(), known.y() + share * off.y(), heading};
    node.best = node.pose;
    node.square = square;
    const Vec2 by_u = -share * step * turned.turned(point.along);
    const Vec2 by_turn = -share * turn * turned_left(arm);
    const Eigen::Vector3d along(by_u.x(), by_u.y(), 0);
    const Eigen::Vector3d across(by_turn.x(), by_turn.y(), turn);
    node.covariance.topLeftCorner<2, 2>() = variance * Eigen::Matrix2d::Identity();
    node.covariance += (along * along.transpose() + across * across.transpose()) / 12;
    // In the units of the others, without the normal distribution's (2 pi)^(3/2).
    node.log_density = -0.5 * square + std::log(variance * turn / std::sqrt(2 * std::numbers::pi));
    nodes_.push_back(node);
  }

  Measured touch_;
  const CentrePath& path_;
  const PosePrior& prior_;
  double place_sd_;
  std::vector<PosteriorNode> nodes_;
  std::vector<AtPlace> places_;
};

}  // namespace

bool knows_place(const TouchProblem& problem) { return problem.pose && std::isfinite(problem.pose->place_sd); }

std::vector<PosteriorNode> nodes_by_prior(const Asked& asked) { return Grid(asked).nodes(); }

}  // namespace rollfix::touch
