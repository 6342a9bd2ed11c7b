#include "belief/two/pair_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "belief/posterior.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/two_fingers.md, "The errors":
//   s, t            first contacts, by the tilted turnings `PairStart::w` of finger a [0] and finger b [1]
//   La, Lb, C       a row's lengths and the facing that it measures: `node.length`, `node.turn`
//   x               errors that the roll shares (n_a0, n_b0, eps_a, eps_b, first turn): `score_.errors`, P:
//                   `covariance`
//   f, H, df/dw     a row's equations: `PairEquations::f`, `by_errors`, `by_start`
//   R, G            `variance` of the row on its own; `walk_`, of x, what has gathered
// Follows docs/two_fingers.md, "The errors", and eqs. (7) to (9) of the paper (Jia, IROS 2001), with the facing where
// it is known. -2 log L = f^T S^-1 f + log(det S / det S_w) as for one finger: docs/belief.md.
// Idea: a Kalman filter over the rows gives the likelihood of one pair (s, t). It is run again about the errors that
// came out until they settle (Gauss-Newton); errors that walk are smoothed, and the second pass is about those.
namespace rollfix::belief {

namespace {

// Linearised within this share of a standard deviation of where the errors come out: as good as exact.
constexpr double kSameErrors = 0.3;
// Of the shared errors those of the lengths' scales: they do not walk.
constexpr Eigen::Index kScales = 2;
// A step of w by which the pose's change is taken, radians.
constexpr double kPoseStep = 1e-5;
constexpr double kTwoPi = 2 * std::numbers::pi;
// A covariance's diagonal is taken as this share larger before it is inverted.
constexpr double kRegular = 1e-12;

/// Sums logarithms as one of a product, taken now and then.
class LogSum {
 public:
  void add(double factor) {
    product_ *= factor;
    // As long as it is far from overflow and underflow.
    if (product_ > 1e-200 && product_ < 1e200) return;
    sum_ += std::log(product_);
    product_ = 1;
  }
  double value() const { return sum_ + std::log(product_); }

 private:
  double product_ = 1;
  double sum_ = 0;
};

/// The shared errors at a node, and what is open of them.
struct SharedThen {
  PairShared errors;
  PairSharedCovariance covariance;
};

/// By all nodes, from what a filter found by those so far: the smoother of Rauch, Tung and Striebel (1965) of a walk.
void smooth(const PairModel& model, const std::vector<PairNode>& nodes, std::vector<SharedThen>& found) {
  for (std::size_t k = nodes.size(); k-- > 1;) {
    SharedThen& here = found[k - 1];
    const SharedThen& next = found[k];
    PairSharedCovariance predicted = here.covariance;
    predicted.diagonal() += model.errors->gathered(nodes[k].gathered, nodes[k].travelled);
    // What is known exactly stays so, and the matrix regular.
    for (Eigen::Index i = 0; i < 5; ++i) predicted(i, i) += predicted(i, i) > 0 ? kRegular * predicted(i, i) : 1;
    const PairSharedCovariance gain = predicted.llt().solve(here.covariance).transpose();
    here.errors += gain * (next.errors - here.errors);
    here.covariance += gain * (next.covariance - predicted) * gain.transpose();
  }
}

/// A Kalman filter of the shared errors that goes through the rows.
class PairPass {
 public:
  /// Begins with P0. `guess`: x to linearise about; where x walks, `found` at each node, or nullptr: as it goes. What
  /// it finds goes to `kept`, unless nullptr. Innovations are kept where the model asks for them.
  PairPass(const PairModel& model, const StartPlaces& at, const PairShared& guess, const std::vector<SharedThen>* found,
           std::vector<SharedThen>* kept)
      : model_(model), at_(at), guess_(guess), found_(found), kept_(kept), last_(at.w) {
    score_.covariance = model.errors->start();
    for (const Eigen::Index i : {2, 3}) most_[i] = most_scale(score_.covariance(i, i));
    for (std::size_t k = 0; model.kept != nullptr && k < 3; ++k) {
      (*model.kept)[k].clear();
      score_.whiteness[k].record_to(&(*model.kept)[k]);
    }
  }

  /// Predict: what has gathered since the node before. Then correct, by one equation or three.
  void take(const PairNode& node) {
    if (model_.errors->drifts()) {
      const PairShared gathered = model_.errors->gathered(node.gathered, node.travelled);
      score_.covariance.diagonal() += gathered;
      walk_.diagonal() += gathered;
    }
    if (node.centres && model_.path != nullptr) {
      absorb<3>(node);
    } else {
      absorb<1>(node);
    }
    if (kept_ != nullptr) kept_->push_back({score_.errors, score_.covariance});
    ++node_;
  }

  /// After all nodes; the direct cost gets that of the guess itself, by its prior.
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
  /// Correct: cost, volume, x, P and their derivatives by w; the steps are those of RollFilter::absorb.
  template <int N>
  void absorb(const PairNode& node) {
    const PairShared about = linearised_about();
    const PairSharedCovariance* const open = !model_.errors->drifts() ? nullptr
                                             : found_ != nullptr      ? &(*found_)[node_].covariance
                                                                      : &score_.covariance;
    const PairEquations<N> rows = node.is_facing ? facing_equations<N>(model_, at_, node, about)
                                                 : row_equations<N>(model_, at_, node, about, open, last_);
    last_ = rows.w;
    // P H^T, S^-1 and the innovation at the filter's estimate; its derivative by w with x moving along.
    const Eigen::Matrix<double, 5, N> of_errors = score_.covariance * rows.by_errors.transpose();
    const Eigen::Matrix<double, N, N> own = rows.variance;
    const Eigen::Matrix<double, N, N> inverse = (own + rows.by_errors * of_errors).inverse();
    const Eigen::Matrix<double, N, 1> innovation = -(rows.f + rows.by_errors * (score_.errors - about));
    const Eigen::Matrix<double, N, 2> by_start = -(rows.by_start + rows.by_errors * score_.errors_by_start);
    const double squared = innovation.dot(inverse * innovation);
    // 1 / det S.
    const double density = inverse.determinant();
    // As of one finger only what the rows share has a volume, see RollFilter::absorb.
    const Eigen::Matrix<double, 5, N> of_walk = walk_ * rows.by_errors.transpose();
    const Eigen::Matrix<double, N, N> noise = own + rows.by_errors * of_walk;
    double weight = 1;
    if (model_.outlier_share > 0) {
      // An outlier is even over a perimeter, with centres over one of distance and all directions as well.
      const double range = N == 1 ? model_.perimeter() : square(model_.perimeter()) * kTwoPi;
      const double flat = std::pow(kTwoPi, 0.5 * (N - 1));
      const Mixture mixture =
          mixture_of(model_.outlier_share, model_.outlier_share / range, peak_of(density) / flat, squared);
      weight = mixture.weight;
      score_.cost += mixture.cost;
      // The volume: highest density by noise alone, without outliers, over the mixture's, squared.
      const double usual = peak_of(1 / noise.determinant()) / flat;
      score_.log_volume -= 2 * std::log(mixture.density / usual);
      score_.right_rows += N * weight;
      score_.right_cost += weight * squared;
    } else {
      score_.cost += squared;
      volume_.add(1 / (density * noise.determinant()));
    }
    add_innovation<N>(inverse, std::sqrt(weight) * innovation, score_.whiteness);
    // With x fixed at the guess: what the row costs by its own variance.
    score_.direct_cost += rows.f.dot(own.inverse() * rows.f);
    const Eigen::Matrix<double, 5, N> gain = weight * of_errors * inverse;
    score_.slope -= weight * by_start.transpose() * (inverse * innovation);
    score_.information += weight * by_start.transpose() * inverse * by_start;
    // On an open outline a contact past an end costs as much as it is off.
    score_.cost += rows.past.squaredNorm();
    score_.direct_cost += rows.past.squaredNorm();
    score_.slope -= rows.past.cwiseProduct(rows.past_by_start);
    score_.information.diagonal() += rows.past_by_start.cwiseAbs2();
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
    // The filter with G alone, for det S_w; without drift G is 0.
    walk_ -= weight * of_walk * noise.inverse() * of_walk.transpose();
    gathered_.add(noise.determinant() / own.determinant());
  }

  /// The guess; but what walks is what was found of this node, or where it has got to.
  PairShared linearised_about() const {
    if (found_ != nullptr) return (*found_)[node_].errors;
    if (!model_.errors->drifts()) return guess_;
    PairShared about = score_.errors;
    // A pass that is to be smoothed takes the scales as they were guessed, by all rows.
    if (kept_ != nullptr) about.segment<2>(kScales) = guess_.segment<2>(kScales);
    return about;
  }

  const PairModel& model_;
  const StartPlaces& at_;
  const PairShared& guess_;
  const std::vector<SharedThen>* found_;
  std::vector<SharedThen>* kept_;
  std::size_t node_ = 0;  // of the nodes, the next
  PairScore score_;
  PairSharedCovariance walk_ = PairSharedCovariance::Zero();  // of the errors, from what has gathered alone
  PairShared most_ = PairShared::Zero();
  std::array<double, 2> last_;  // w of the contacts in the row before
  LogSum volume_;
  LogSum gathered_;
};

/// Are there any on which a finger rolls?
bool has_kinks(const StartPlaces& at) { return !at.arc[0]->kinks().empty() || !at.arc[1]->kinks().empty(); }

/// One pass through all nodes, about `guess`. Errors that walk take two: about what the first one finds as it goes, and
/// about what it has found of each node by all of them (an iterated extended Kalman smoother).
PairScore pass(const PairModel& model, const StartPlaces& at, const std::vector<PairNode>& nodes,
               const PairShared& guess) {
  beat();
  std::vector<SharedThen> found;
  if (model.errors->drifts() && has_kinks(at)) {
    found.reserve(nodes.size());
    PairPass first(model, at, guess, nullptr, &found);
    for (const PairNode& node : nodes) first.take(node);
    smooth(model, nodes, found);
  }
  PairPass last(model, at, guess, found.empty() ? nullptr : &found, nullptr);
  for (const PairNode& node : nodes) last.take(node);
  return last.score();
}

/// How far the part's pose is from the prior's, in its deviations, for these first contacts.
Eigen::Vector3d off_prior(const PairModel& model, const StartPlaces& at) {
  const PosePrior& prior = *model.pose;
  // The heading by each finger's normal, and the mean of both.
  const double by_a = model.first[0].normal - kHalfTurn / 2 - at.angle[0];
  const double by_b = model.first[1].normal - kHalfTurn / 2 - at.angle[1];
  Pose pose;
  pose.heading = by_a + 0.5 * nearest_to_zero(by_b - by_a);
  // The first contacts' own errors add to the prior's.
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

/// The pose prior as one sample more; its derivatives by w from a small step of each.
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

/// Each shared error came out within kSameErrors of its standard deviation of where it was taken.
bool is_about_same(const PairScore& score, const PairShared& guess, const PairErrors& errors) {
  for (Eigen::Index i = 0; i < 5; ++i) {
    const double off = score.errors[i] - guess[i];
    if (errors.start()(i, i) > 0 && off * off > kSameErrors * kSameErrors * score.covariance(i, i)) return false;
  }
  return true;
}

}  // namespace

/// One to `most_passes` passes, then the priors. In the first branch offsets are linearised as the filter goes, so that
/// only the scales have to settle.
PairScore score_of(const PairModel& model, const PairStart& start, const std::vector<PairNode>& nodes,
                   const PairShared& guess, int most_passes) {
  const StartPlaces at = places_of(model, start);
  const PairErrors& errors = *model.errors;
  PairScore score = pass(model, at, nodes, guess);
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
