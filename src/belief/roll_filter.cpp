#include "belief/grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "belief/posterior.hpp"

namespace rollfix::belief {

RollFilter::RollFilter(const TiltedArc& arc, double tilt, double w, const SharedCovariance& start)
    : arc_(&arc), tilt_(tilt), w_(w), place_(arc.at(w)), most_scale_(most_scale(start(2, 2))), p_(start) {}

// The true L and theta lead from this place to another: e = s(w + theta + c L) - s(w) - L = 0, with ds/dw = m.
// With de/dtheta = m and de/dL = c m - 1, e tells of the errors of L and theta what can be told.
void RollFilter::update(const Node& node, const Outliers& outliers) {
  p_(0, 0) += node.gathered.length;
  p_(0, 1) += node.gathered.both;
  p_(1, 0) += node.gathered.both;
  p_(1, 1) += node.gathered.turn;

  const Corrected roll = corrected(node.length, node.turn);
  const double per_scale = 1 / (1 + x_[2]);
  const double w_variance = variance_of_roll(roll.length, node.own);
  const SpreadPlace end = arc_->about(w_ + roll.turn + tilt_ * roll.length, w_variance, node.spread);
  const double by_turn = end.slope;
  const double by_length = tilt_ * end.slope - 1;
  const double miss = end.s - place_.s - roll.length;
  const Shared h(-by_length * per_scale, -by_turn, -by_length * roll.length * per_scale);

  const Shared ph = p_ * h;
  const double variance = std::max(0.0, h.dot(ph)) + end.variance + by_length * by_length * node.own.length +
                          2 * by_length * by_turn * node.own.both + by_turn * by_turn * node.own.turn;
  const double least = node.least_variance(tilt_);
  const double inverse = 1 / variance;
  const double innovation = -miss;
  const double by_w = -(end.slope - place_.slope) - h.dot(dx_);

  double weight = 1;
  const double squared = innovation * innovation * inverse;
  if (outliers.share > 0) {
    const double stray = outliers.share / outliers.range;
    const Mixture mixture = mixture_of(outliers.share, stray, inverse, squared);
    weight = mixture.weight;
    const double most = (1 - outliers.share) * std::sqrt(1 / (2 * std::numbers::pi * least)) + stray;
    cost_ += mixture.cost;
    log_volume_ += 2 * std::log(most / mixture.density);
  } else {
    cost_ += squared;
    log_volume_ += std::log(variance / least);
  }
  slope_ += weight * innovation * by_w * inverse;
  information_ += weight * by_w * by_w * inverse;
  x_ += ph * (weight * innovation * inverse);
  dx_ += ph * (weight * by_w * inverse);
  p_ -= (weight * inverse) * (ph * ph.transpose());
  // A place that does not fit asks for lengths that no slip explains: it is refused by its cost, not followed.
  if (std::abs(x_[2]) > most_scale_) {
    x_[2] = std::copysign(most_scale_, x_[2]);
    dx_[2] = 0;
  }
}

TiltedPlace RollFilter::after(const Reading& measured) const {
  const Corrected roll = corrected(measured.length[0], measured.turn);
  return arc_->at(w_ + roll.turn + tilt_ * roll.length);
}

double RollFilter::variance_of_roll(double length, const RowCovariance& own) const {
  const double per_scale = 1 / (1 + x_[2]);
  const Shared h(-tilt_ * per_scale, -1, -tilt_ * length * per_scale);
  const double variance = h.dot(p_ * h) + tilt_ * tilt_ * own.length + 2 * tilt_ * own.both + own.turn;
  return std::max(0.0, variance);
}

double RollFilter::variance_after(const Reading& measured, const RowCovariance& own) const {
  const double m = after(measured).slope;
  return m * m * variance_of_roll(corrected(measured.length[0], measured.turn).length, own);
}

}  // namespace rollfix::belief
