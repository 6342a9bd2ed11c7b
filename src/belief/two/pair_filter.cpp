#include "belief/two/pair_filter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "belief/posterior.hpp"
#include "rollfix/pulse.hpp"

// Notation, as in docs/two_fingers.md, "The errors":
//   s, t            first contacts, by the tilted turnings `PairStart::w` of finger a [0] and finger b [1]
//   La, Lb, C       a row's lengths and the facing that it measures: `node.length`, `node.turn`
//   x               errors that the roll shares (n_a0, n_b0, eps_a, eps_b, first turn): `score_.errors`, P:
//                   `covariance`
//   f               Theta(s + (La + n_a0) / (1 + eps_a)) - Theta(t + (Lb + n_b0) / (1 + eps_b)) - C: `PairEquations::f`
//   H, df/dw        `by_errors`, `by_start`
//   R, K            `variance` of the row on its own; `walk_`, of x, what has gathered
//   Y               what a felt normal tells of Theta near a corner, with its mean and variance: FeltTurning
// Follows docs/two_fingers.md, "The errors", and eqs. (7) to (9) of the paper (Jia, IROS 2001), with the facing where
// it is known. -2 log L = f^T S^-1 f + log(det S / det S_w) as for one finger: docs/belief.md.
// Idea: a Kalman filter over the rows gives the likelihood of one pair (s, t). It is run again about the errors that
// came out until they settle (Gauss-Newton); errors that walk are linearised as it goes.
namespace rollfix::belief {

namespace {

// Linearised within this share of a standard deviation of where the errors come out: as good as exact.
constexpr double kSameErrors = 0.3;
// Of the shared errors those of the lengths' scales: they do not walk.
constexpr Eigen::Index kScales = 2;
constexpr double kTwoPi = 2 * std::numbers::pi;
// A step of w by which the pose's change is taken, radians.
constexpr double kPoseStep = 1e-5;
// Centres nearer together than this share of the perimeter have no direction from one to the other.
constexpr double kLeastDistance = 1e-6;

// Of a turn's variance at least this share is not in the distance and the direction of the centres.
constexpr double kLeastOwn = 1e-6;

/// The angle nearest to 0 that is the same: std::remainder, but for rounding, and faster.
double nearest_to_zero(double angle) { return angle - kTwoPi * std::floor(angle / kTwoPi + 0.5); }

/// By how many nodes each finger's pivot is shared, see pivots_of.
using Alike = std::array<double, 2>;

/// A row as N equations f = 0, linear in the shared errors x and the start w about the point of linearisation: of the
/// turn, and with the centres of their distance and direction as well.
template <int N>
struct PairEquations {
  Eigen::Matrix<double, N, 1> f = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, 5> by_errors = Eigen::Matrix<double, N, 5>::Zero();
  Eigen::Matrix<double, N, 2> by_start = Eigen::Matrix<double, N, 2>::Zero();
  Eigen::Matrix<double, N, N> variance = Eigen::Matrix<double, N, N>::Zero();  // of the row on its own
  Eigen::Matrix<double, N, N> pivots = Eigen::Matrix<double, N, N>::Zero();    // of that, of fingers at corners
  double beyond = 0;  // squared distance beyond an open outline's ends, in standard deviations
};

/// Where the first contacts are.
struct StartPlaces {
  std::array<TiltedPlace, 2> place;
  std::array<double, 2> angle{};     // of the tangents
  std::array<double, 2> by_start{};  // of them by w
};

StartPlaces places_of(const PairModel& model, const PairStart& start) {
  StartPlaces places;
  for (const std::size_t finger : {0U, 1U}) {
    const double tilt = model.boundary[finger]->tilt();
    places.place[finger] = start.arc[finger]->at(start.w[finger]);
    places.angle[finger] = start.w[finger] - tilt * places.place[finger].s;
    places.by_start[finger] = 1 - tilt * places.place[finger].slope;
  }
  return places;
}

/// One finger's contact in a row, and how that changes with where it is.
struct ContactThen {
  double s = 0;
  double angle = 0;           // of the tangent, as the normal tells it
  double slope = 0;           // of that by the place where it was felt
  double angle_by_start = 0;  // by w
  double s_by_start = 0;
  double s_by_offset = 0;  // by the shared error of the length
  double s_by_scale = 0;
  double pivot = 0;        // variance of how far the finger has pivoted at a corner ...
  double pivot_alike = 0;  // ... and as much as counts, see pivots_of
};

// With the fingers at q = p(s) - R(Theta + pi/2) arm in the part's frame, |q_b - q_a| is the distance of their centres,
// and the direction of q_b - q_a less the middle of both normals is what it is in the world.
void add_centres(const PairModel& model, const std::array<ContactThen, 2>& at, const PairNode& node,
                 PairEquations<3>& rows) {
  const PairErrors& errors = *model.errors;
  const PairCentres& felt = *node.centres;
  std::array<Vec2, 2> q;
  std::array<Vec2, 2> q_by_s;
  std::array<Vec2, 2> q_by_own;  // where the contact was felt elsewhere than it is
  std::array<Vec2, 2> q_by_start;
  std::array<Vec2, 2> across;  // the arm, a quarter turn on
  for (const std::size_t finger : {0U, 1U}) {
    const ContactThen& contact = at[finger];
    const Vec2 tangent(std::cos(contact.angle), std::sin(contact.angle));
    const Vec2 normal(-tangent.y(), tangent.x());
    const auto in_part = [&](const Vec2& arm) { return Vec2(arm.x() * normal - arm.y() * tangent); };
    const Vec2 arm = in_part(felt.arm[finger].at);
    across[finger] = {-arm.y(), arm.x()};
    q[finger] = model.path->at(contact.s) - arm;
    q_by_s[finger] = tangent - contact.slope * across[finger];
    q_by_own[finger] = q_by_s[finger] + in_part(felt.arm[finger].per_length);
    q_by_start[finger] = contact.s_by_start * tangent - contact.angle_by_start * across[finger];
  }
  const Vec2 way = q[1] - q[0];
  const double distance = std::max(way.norm(), kLeastDistance * errors.perimeter());
  const Vec2 along = way / distance;
  const Vec2 turning(-along.y() / distance, along.x() / distance);
  rows.f[1] = way.norm() - felt.distance;
  const double direction = std::atan2(way.y(), way.x()) - kHalfTurn / 2 - 0.5 * (at[0].angle + at[1].angle);
  const double off = direction - felt.direction;
  rows.f[2] = off - kHalfTurn * std::floor(off / kHalfTurn + 0.5);
  const double position = 2 * errors.centre_variance() / std::max(1.0, node.rows);
  rows.variance(1, 1) += position;
  rows.variance(2, 2) += position / (distance * distance) + 0.5 * errors.angle_variance() / std::max(1e-6, node.rows);
  Eigen::Matrix<double, 3, 2> by_own;
  Eigen::Matrix<double, 3, 2> by_pivot;  // of a finger at a corner, whose centre goes around it
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    const double sign = finger == 0 ? -1 : 1;
    const ContactThen& contact = at[finger];
    const double felt_slope = contact.slope + errors.normal_turn(finger);
    by_own.col(i) << -sign * felt_slope, sign * along.dot(q_by_own[finger]),
        sign * turning.dot(q_by_own[finger]) - 0.5 * felt_slope;
    by_pivot.col(i) << -sign, -sign * along.dot(across[finger]), -sign * turning.dot(across[finger]) - 0.5;
    rows.by_start(1, i) = sign * along.dot(q_by_start[finger]);
    rows.by_start(2, i) = sign * turning.dot(q_by_start[finger]) - 0.5 * contact.angle_by_start;
    const Eigen::Vector2d by_s(sign * along.dot(q_by_s[finger]),
                               sign * turning.dot(q_by_s[finger]) - 0.5 * contact.slope);
    rows.by_errors.col(i).tail<2>() = by_s * contact.s_by_offset;
    rows.by_errors.col(2 + i).tail<2>() = by_s * contact.s_by_scale;
    // The first contacts' own error is the one that the roll shares, the other way round.
    if (node.is_facing) rows.by_errors.col(i).tail<2>() -= by_own.col(i).tail<2>() - by_s;
  }
  if (node.is_facing) return;
  // The row's own error of both places is in all three.
  const double own = errors.contact_variance() / std::max(1e-6, node.rows);
  rows.variance.bottomRightCorner<2, 2>() += own * by_own.bottomRows<2>() * by_own.bottomRows<2>().transpose();
  for (const Eigen::Index row : {1, 2}) {
    const double both = own * by_own.row(0).dot(by_own.row(row));
    rows.variance(0, row) = rows.variance(row, 0) = both;
  }
  // What a normal tells of a place is a table's, whose variance the turn has: it is no less than what goes together.
  const double together = own * by_own.row(0).squaredNorm() + at[0].pivot_alike + at[1].pivot_alike;
  rows.variance(0, 0) = std::max(rows.variance(0, 0), (1 + kLeastOwn) * together);
  // So is how far fingers have pivoted, which the turn has already.
  for (const std::size_t finger : {0U, 1U}) {
    const ContactThen& contact = at[finger];
    if (!(contact.pivot > 0)) continue;
    const auto i = static_cast<Eigen::Index>(finger);
    Eigen::Matrix3d pivots = by_pivot.col(i) * by_pivot.col(i).transpose();
    pivots(0, 0) = 0;
    // A wide arc is no straight line: what is second order in the pivot counts as one more error.
    const double bend = contact.pivot * across[finger].squaredNorm();
    pivots(1, 1) += bend;
    pivots(2, 2) += bend / (distance * distance);
    rows.variance += contact.pivot_alike * pivots;
    rows.pivots += contact.pivot_alike * pivots;
  }
}

template <int N>
PairEquations<N> facing_equations(const PairModel& model, const StartPlaces& at, const PairNode& node,
                                  const PairShared& x) {
  const PairErrors& errors = *model.errors;
  PairEquations<N> rows;
  rows.by_errors(0, 0) = -errors.normal_turn(0);
  rows.by_errors(0, 1) = errors.normal_turn(1);
  rows.f[0] = nearest_to_zero(at.angle[0] - at.angle[1] - node.turn + rows.by_errors.row(0).dot(x));
  rows.by_start.row(0) << at.by_start[0], -at.by_start[1];
  rows.variance(0, 0) = errors.facing_variance();
  if constexpr (N == 3) {
    std::array<ContactThen, 2> contacts;
    for (const std::size_t finger : {0U, 1U}) {
      const double slope = model.felt[finger]->at(at.place[finger].s).slope;
      // The first contact was felt where it is but for its own error: the place stays, the normal and the arm tell of
      // it.
      contacts[finger] = {
          at.place[finger].s, at.angle[finger], slope, at.by_start[finger], at.place[finger].slope, 0, 0, 0, 0};
    }
    add_centres(model, contacts, node, rows);
    for (const Eigen::Index k : {1, 2}) rows.f[k] += rows.by_errors.row(k).dot(x);
  }
  return rows;
}

/// Variance of how far a finger has pivoted that may be at a corner. Where one is as near as the finger may have
/// slipped, it may have pivoted already, or not yet.
double pivot_at(const PairModel& model, std::size_t finger, double s) {
  const double felt = model.felt[finger]->at(s).pivot;
  return model.slipping[finger] != nullptr ? std::max(felt, model.slipping[finger]->at(s).pivot) : felt;
}

template <int N>
PairEquations<N> row_equations(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x,
                               const Alike& alike) {
  const PairErrors& errors = *model.errors;
  PairEquations<N> rows;
  std::array<ContactThen, 2> contacts;
  double& f = rows.f[0];
  double variance = errors.turn_variance() + node.alike * errors.part_variance();
  double pivots_alike = 0;
  f = -node.turn;
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    const double sign = finger == 0 ? 1 : -1;
    const double per_scale = 1 / (1 + x[2 + i]);
    const double length = (node.length[finger] + x[i]) * per_scale;
    const double s = at.place[finger].s + length;
    const Felt felt = model.felt[finger]->at(s);
    contacts[finger] = {s,
                        felt.angle,
                        felt.slope,
                        felt.slope * at.place[finger].slope,
                        at.place[finger].slope,
                        per_scale,
                        -per_scale * length,
                        0,
                        0};
    f += sign * felt.angle;  // f_k of docs/two_fingers.md; its differences are eqs. (8), (9)
    rows.by_errors(0, i) = sign * felt.slope * per_scale;
    rows.by_errors(0, 2 + i) = -rows.by_errors(0, i) * length;
    rows.by_start(0, i) = sign * felt.slope * at.place[finger].slope;
    const double pivot = alike[finger] > 1 ? pivot_at(model, finger, s) : felt.pivot;
    contacts[finger].pivot = pivot;
    contacts[finger].pivot_alike = alike[finger] * pivot;
    variance += felt.variance - felt.pivot;
    pivots_alike += alike[finger] * pivot;
    if (!model.places.closed) {
      const double off = std::max({0.0, -s, s - errors.perimeter()});
      rows.beyond += off * off / errors.contact_variance();
    }
  }
  if (errors.absolute()) {
    f = nearest_to_zero(f);
  } else {
    // The change since the first contacts, whose own errors are in it as well.
    rows.by_errors(0, 0) -= errors.normal_turn(0);
    rows.by_errors(0, 1) += errors.normal_turn(1);
    rows.by_errors(0, 4) = 1;
    f += -at.angle[0] + at.angle[1] + x[4] - errors.normal_turn(0) * x[0] + errors.normal_turn(1) * x[1];
    rows.by_start(0, 0) -= at.by_start[0];
    rows.by_start(0, 1) += at.by_start[1];
  }
  rows.variance(0, 0) = variance / node.rows + pivots_alike;
  rows.pivots(0, 0) = pivots_alike;
  if constexpr (N == 3) add_centres(model, contacts, node, rows);
  return rows;
}

/// A finger that may be at one corner in several nodes in a row has pivoted there by one unknown angle, and they are
/// off alike, by their c_k times it. For each of them: what the others' c come to beside its own, S / c_k with S = sum
/// c_k. As (sum c_k e_k)^2 <= S sum c_k e_k^2, rows that are off on their own by c_k S are off by no less than that.
std::vector<Alike> pivots_of(const PairModel& model, const StartPlaces& at, const std::vector<PairNode>& nodes,
                             const PairShared& x) {
  std::vector<Alike> alike(nodes.size(), Alike{1, 1});
  std::vector<double> off(nodes.size());
  for (const std::size_t finger : {0U, 1U}) {
    const FeltTurning& felt = model.slipping[finger] != nullptr ? *model.slipping[finger] : *model.felt[finger];
    if (!felt.has_corners()) continue;
    const auto i = static_cast<Eigen::Index>(finger);
    std::size_t begin = 0;
    double sum = 0;
    std::optional<double> corner;
    const auto end_run = [&](std::size_t end) {
      for (std::size_t k = begin; corner && k < end; ++k) {
        if (off[k] > 0) alike[k][finger] = sum / off[k];
      }
      begin = end;
      sum = 0;
    };
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double length = (nodes[k].length[finger] + x[i]) / (1 + x[2 + i]);
      const double s = at.place[finger].s + length;
      const std::optional<double> here = felt.corner_at(s);
      const bool goes_on = here && corner && std::abs(*here - *corner) < 0.5 * model.errors->contact_sd();
      if (!goes_on) end_run(k);
      corner = here;
      if (here) sum += off[k] = std::sqrt(pivot_at(model, finger, s));
    }
    end_run(nodes.size());
  }
  return alike;
}

/// Sums logarithms as one of a product, taken now and then.
class LogSum {
 public:
  void add(double factor) {
    product_ *= factor;
    if (product_ > 1e-200 && product_ < 1e200) return;
    sum_ += std::log(product_);
    product_ = 1;
  }
  double value() const { return sum_ + std::log(product_); }

 private:
  double product_ = 1;
  double sum_ = 0;
};

/// A Kalman filter of the shared errors that goes through the rows.
class PairPass {
 public:
  PairPass(const PairModel& model, const StartPlaces& at, const PairShared& guess)
      : model_(model), at_(at), guess_(guess) {
    score_.covariance = model.errors->start();
    for (const Eigen::Index i : {2, 3}) most_[i] = most_scale(score_.covariance(i, i));
    for (std::size_t k = 0; model.kept != nullptr && k < 3; ++k) {
      (*model.kept)[k].clear();
      score_.whiteness[k].record_to(&(*model.kept)[k]);
    }
  }

  void take(const PairNode& node, const Alike& alike) {
    if (model_.errors->drifts()) {
      const PairShared gathered = model_.errors->gathered(node.gathered, node.travelled);
      score_.covariance.diagonal() += gathered;
      walk_.diagonal() += gathered;
    }
    if (node.centres && model_.path != nullptr) {
      absorb<3>(node, alike);
    } else {
      absorb<1>(node, alike);
    }
  }

  PairScore score() {
    score_.log_volume += volume_.value();
    score_.log_gathered = gathered_.value();
    const PairSharedCovariance& start = model_.errors->start();
    for (Eigen::Index i = 0; i < 5; ++i) {
      if (start(i, i) > 0) score_.direct_cost += guess_[i] * guess_[i] / start(i, i);
    }
    return score_;
  }

 private:
  template <int N>
  void absorb(const PairNode& node, const Alike& alike) {
    const PairShared about = linearised_about();
    const PairEquations<N> rows = node.is_facing ? facing_equations<N>(model_, at_, node, about)
                                                 : row_equations<N>(model_, at_, node, about, alike);
    const Eigen::Matrix<double, 5, N> of_errors = score_.covariance * rows.by_errors.transpose();
    const Eigen::Matrix<double, N, N> own = rows.variance;
    const Eigen::Matrix<double, N, N> inverse = (own + rows.by_errors * of_errors).inverse();
    const Eigen::Matrix<double, N, 1> innovation = -(rows.f + rows.by_errors * (score_.errors - about));
    const Eigen::Matrix<double, N, 2> by_start = -(rows.by_start + rows.by_errors * score_.errors_by_start);
    const double squared = innovation.dot(inverse * innovation);
    const double density = inverse.determinant();
    // As of one finger only what the rows share has a volume, see RollFilter::absorb.
    const Eigen::Matrix<double, 5, N> of_walk = walk_ * rows.by_errors.transpose();
    const Eigen::Matrix<double, N, N> noise = own + rows.by_errors * of_walk;
    // Rows of a pivot tell next to nothing, neither by the turn nor by the centres. They cost what others do in the
    // mean: else starts would be likelier the more rows they leave to pivots.
    const double untold = std::min(1.0, node.rows) * (own.inverse() * rows.pivots).trace();
    double weight = 1;
    if (model_.outlier_share > 0) {
      const double range = N == 1 ? kTwoPi : kTwoPi * kTwoPi * model_.perimeter();
      const double flat = std::pow(kTwoPi, 0.5 * (N - 1));
      const Mixture mixture =
          mixture_of(model_.outlier_share, model_.outlier_share / range, peak_of(density) / flat, squared);
      weight = mixture.weight;
      score_.cost += mixture.cost;
      const double usual = peak_of(1 / noise.determinant()) / flat;
      score_.log_volume -= 2 * std::log(mixture.density / usual);
      score_.right_rows += N * weight;
      score_.right_cost += weight * (squared + untold);
    } else {
      score_.cost += squared;
      volume_.add(1 / (density * noise.determinant()));
    }
    score_.cost += weight * untold;
    score_.direct_cost += weight * untold;
    add_innovation<N>(inverse, std::sqrt(weight) * innovation, score_.whiteness);
    score_.cost += rows.beyond;
    score_.direct_cost += rows.f.dot(own.inverse() * rows.f) + rows.beyond;
    const Eigen::Matrix<double, 5, N> gain = weight * of_errors * inverse;
    score_.slope -= weight * by_start.transpose() * (inverse * innovation);
    score_.information += weight * by_start.transpose() * inverse * by_start;
    score_.errors += gain * innovation;
    score_.errors_by_start += gain * by_start;
    score_.covariance -= gain * of_errors.transpose();
    // A start that does not fit asks for lengths that no slip explains: its cost refuses it.
    for (const Eigen::Index i : {2, 3}) {
      if (std::abs(score_.errors[i]) > most_[i]) {
        score_.errors[i] = std::copysign(most_[i], score_.errors[i]);
        score_.errors_by_start.row(i).setZero();
      }
    }
    if (!model_.errors->drifts()) return;
    walk_ -= weight * of_walk * noise.inverse() * of_walk.transpose();
    gathered_.add(noise.determinant() / own.determinant());
  }

  /// The guess; but what walks is where it has got to.
  PairShared linearised_about() const {
    if (!model_.errors->drifts()) return guess_;
    PairShared about = score_.errors;
    about.segment<2>(kScales) = guess_.segment<2>(kScales);
    return about;
  }

  const PairModel& model_;
  const StartPlaces& at_;
  const PairShared& guess_;
  PairScore score_;
  PairSharedCovariance walk_ = PairSharedCovariance::Zero();  // of the errors, from what has gathered alone
  PairShared most_ = PairShared::Zero();
  LogSum volume_;
  LogSum gathered_;
};

PairScore pass(const PairModel& model, const StartPlaces& at, const std::vector<PairNode>& nodes,
               const PairShared& guess) {
  beat();
  PairPass through(model, at, guess);
  const std::vector<Alike> alike = pivots_of(model, at, nodes, guess);
  for (std::size_t k = 0; k < nodes.size(); ++k) through.take(nodes[k], alike[k]);
  return through.score();
}

/// How far the part's pose is from the prior's, in its deviations, for these first contacts.
Eigen::Vector3d off_prior(const PairModel& model, const StartPlaces& at) {
  const PosePrior& prior = *model.pose;
  const double by_a = model.first[0].facing - kHalfTurn / 2 - at.angle[0];
  const double by_b = model.first[1].facing - kHalfTurn / 2 - at.angle[1];
  Pose pose;
  pose.heading = by_a + 0.5 * nearest_to_zero(by_b - by_a);
  const double heading_sd = std::hypot(prior.heading_sd, std::sqrt(0.5 * model.errors->angle_variance()));
  Eigen::Vector3d off(0, 0, nearest_to_zero(pose.heading - prior.mean.heading) / heading_sd);
  if (!std::isfinite(prior.place_sd)) return off;
  const double place_sd = std::hypot(prior.place_sd, std::sqrt(model.errors->contact_variance()));
  Vec2 origin(-prior.mean.x, -prior.mean.y);
  for (const std::size_t finger : {0U, 1U}) {
    origin += 0.5 * (model.first[finger].where - pose.turned(model.part->point(at.place[finger].s)));
  }
  off.head<2>() = origin / place_sd;
  return off;
}

void add_pose_prior(const PairModel& model, const PairStart& start, const StartPlaces& at, PairScore& score) {
  const Eigen::Vector3d off = off_prior(model, at);
  Eigen::Matrix<double, 3, 2> by_start;
  for (const Eigen::Index finger : {0, 1}) {
    PairStart moved = start;
    moved.w[static_cast<std::size_t>(finger)] += kPoseStep;
    by_start.col(finger) = (off_prior(model, places_of(model, moved)) - off) / kPoseStep;
  }
  score.cost += off.squaredNorm();
  score.direct_cost += off.squaredNorm();
  score.slope -= by_start.transpose() * off;
  score.information += by_start.transpose() * by_start;
}

/// Of what does not walk.
bool has_same_scales(const PairScore& score, const PairShared& guess) {
  for (const Eigen::Index i : {kScales, kScales + 1}) {
    const double off = score.errors[i] - guess[i];
    if (off * off > kSameErrors * kSameErrors * score.covariance(i, i)) return false;
  }
  return true;
}

bool is_about_same(const PairScore& score, const PairShared& guess, const PairErrors& errors) {
  for (Eigen::Index i = 0; i < 5; ++i) {
    const double off = score.errors[i] - guess[i];
    if (errors.start()(i, i) > 0 && off * off > kSameErrors * kSameErrors * score.covariance(i, i)) return false;
  }
  return true;
}

}  // namespace

PairScore score_of(const PairModel& model, const PairStart& start, const std::vector<PairNode>& nodes,
                   const PairShared& guess, int most_passes) {
  const StartPlaces at = places_of(model, start);
  const PairErrors& errors = *model.errors;
  PairScore score = pass(model, at, nodes, guess);
  if (errors.drifts()) {
    PairShared about = guess;
    for (int k = 1; k < most_passes && !has_same_scales(score, about); ++k) {
      about = score.errors;
      score = pass(model, at, nodes, about);
    }
  }
  if (!errors.drifts() && most_passes > 1 && !is_about_same(score, guess, errors)) {
    // Errors that do not settle, as about corners: a straight line that fits well is not to be believed. They are worth
    // what they cost as they are, the best of those that were tried.
    const auto as_it_is = [&](PairScore tried, const PairShared& about) {
      if (model.outlier_share > 0) return tried;
      tried.cost = std::max(tried.cost, tried.direct_cost);
      tried.errors = about;
      return tried;
    };
    PairShared about = guess;
    PairScore best = as_it_is(score, about);
    bool is_settled = false;
    for (int k = 1; k < most_passes && !is_settled; ++k) {
      // Half the way from the third time on: the steps overshoot.
      about = k == 1 ? score.errors : PairShared(0.5 * (about + score.errors));
      score = pass(model, at, nodes, about);
      is_settled = is_about_same(score, about, errors);
      const PairScore tried = as_it_is(score, about);
      if (tried.log_likelihood() > best.log_likelihood()) best = tried;
    }
    if (!is_settled) score = best;
  }
  if (model.pose) add_pose_prior(model, start, at, score);
  if (model.prior) {
    // The prior is one sample more.
    const double precision = 1 / (model.prior->sd * model.prior->sd);
    const double off = model.places.offset(model.prior->s, at.place[0].s);
    score.cost += off * off * precision;
    score.slope[0] -= off * at.place[0].slope * precision;
    score.information(0, 0) += at.place[0].slope * at.place[0].slope * precision;
  }
  return score;
}

}  // namespace rollfix::belief
