#include "belief/pair_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "belief/posterior.hpp"

namespace rollfix::belief {

namespace {

// Linearised within this share of a standard deviation of where the errors come out: as good as exact.
constexpr double kSameErrors = 0.3;
constexpr double kTwoPi = 2 * std::numbers::pi;

/// The angle nearest to 0 that is the same: std::remainder, but for rounding, and faster.
double nearest_to_zero(double angle) { return angle - kTwoPi * std::floor(angle / kTwoPi + 0.5); }

/// A row as one equation f = 0, linear in the shared errors x and the start w about the point of linearisation.
struct RowEquation {
  double f = 0;
  PairShared by_errors = PairShared::Zero();
  Eigen::Vector2d by_start = Eigen::Vector2d::Zero();
  double variance = 0;  // of the row on its own
  double beyond = 0;    // squared distance beyond an open outline's ends, in standard deviations
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

RowEquation facing_equation(const PairErrors& errors, const StartPlaces& at, const PairNode& node,
                            const PairShared& x) {
  RowEquation row;
  row.by_errors[0] = -errors.normal_turn(0);
  row.by_errors[1] = errors.normal_turn(1);
  row.f = at.angle[0] - at.angle[1] - node.turn + row.by_errors.dot(x);
  row.by_start = {at.by_start[0], -at.by_start[1]};
  row.variance = errors.facing_variance();
  row.f = nearest_to_zero(row.f);
  return row;
}

RowEquation row_equation(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x) {
  const PairErrors& errors = *model.errors;
  RowEquation row;
  row.f = -node.turn;
  row.variance = errors.turn_variance();
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    const double sign = finger == 0 ? 1 : -1;
    const double per_scale = 1 / (1 + x[2 + i]);
    const double length = (node.length[finger] + x[i]) * per_scale;
    const double s = at.place[finger].s + length;
    const Felt felt = model.felt[finger]->at(s);
    row.f += sign * felt.angle;
    row.by_errors[i] = sign * felt.slope * per_scale;
    row.by_errors[2 + i] = -row.by_errors[i] * length;
    row.by_start[i] = sign * felt.slope * at.place[finger].slope;
    row.variance += felt.variance;
    if (!model.places.closed) {
      const double off = std::max({0.0, -s, s - errors.perimeter()});
      row.beyond += off * off / errors.contact_variance();
    }
  }
  if (errors.absolute()) {
    row.f = nearest_to_zero(row.f);
  } else {
    // The change since the first contacts, whose own errors are in it as well.
    row.by_errors[0] -= errors.normal_turn(0);
    row.by_errors[1] += errors.normal_turn(1);
    row.by_errors[4] = 1;
    row.f += -at.angle[0] + at.angle[1] + x[4] - errors.normal_turn(0) * x[0] + errors.normal_turn(1) * x[1];
    row.by_start[0] -= at.by_start[0];
    row.by_start[1] += at.by_start[1];
  }
  row.variance /= node.rows;
  return row;
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

PairScore pass(const PairModel& model, const StartPlaces& at, const std::vector<PairNode>& nodes,
               const PairShared& guess) {
  const PairErrors& errors = *model.errors;
  const bool drifts = errors.drifts();
  const double unit = 1 / errors.turn_variance();
  PairScore score;
  PairShared& x = score.errors;
  PairSharedCovariance& P = score.covariance;
  Eigen::Matrix<double, 5, 2>& dx = score.errors_by_start;
  P = errors.start();
  PairShared most = PairShared::Zero();
  for (const Eigen::Index i : {2, 3}) most[i] = most_scale(P(i, i));
  LogSum volume;
  for (const PairNode& node : nodes) {
    if (drifts) P.diagonal() += errors.gathered(node.gathered, node.travelled);
    const PairShared& about = drifts ? x : guess;
    const RowEquation row =
        node.is_facing ? facing_equation(errors, at, node, about) : row_equation(model, at, node, about);
    const PairShared& h = row.by_errors;
    const PairShared Ph = P * h;
    const double variance = row.variance + std::max(0.0, h.dot(Ph));
    const double inverse = 1 / variance;
    const double innovation = -(row.f + h.dot(x - about));
    const Eigen::Vector2d by_start = -(row.by_start + dx.transpose() * h);
    const double squared = innovation * innovation * inverse;
    double weight = 1;
    if (model.outlier_share > 0) {
      const Mixture mixture = mixture_of(model.outlier_share, model.outlier_share / kTwoPi, inverse, squared);
      weight = mixture.weight;
      score.cost += mixture.cost;
      score.log_volume -= 2 * std::log(mixture.density);
    } else {
      score.cost += squared;
      volume.add(variance * unit);
    }
    score.cost += row.beyond;
    score.direct_cost += row.f * row.f / row.variance + row.beyond;
    const double by = weight * inverse;
    score.slope -= (by * innovation) * by_start;
    score.information += by * by_start * by_start.transpose();
    x += (by * innovation) * Ph;
    dx += by * Ph * by_start.transpose();
    P -= (by * Ph) * Ph.transpose();
    // A start that does not fit asks for lengths that no slip explains: its cost refuses it.
    for (const Eigen::Index i : {2, 3}) {
      if (std::abs(x[i]) > most[i]) {
        x[i] = std::copysign(most[i], x[i]);
        dx.row(i).setZero();
      }
    }
  }
  score.log_volume += volume.value();
  for (Eigen::Index i = 0; i < 5; ++i) {
    if (errors.start()(i, i) > 0) score.direct_cost += guess[i] * guess[i] / errors.start()(i, i);
  }
  return score;
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
