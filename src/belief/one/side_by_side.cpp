#include "belief/one/side_by_side.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "belief/posterior.hpp"

namespace rollfix::belief {

namespace {

// What a processor keeps in flight at once.
constexpr std::size_t kLanes = 4;
// Volumes are multiplied up to here before a logarithm is taken.
constexpr double kLargeVolume = 1000;
/// One number of each of the filters.
using Four = Eigen::Array<double, kLanes, 1>;

}  // namespace

/// Filters that take a row each, as one equation; see RollFilter::update.
class SideBySide {
 public:
  SideBySide(const NextErrand& next, const double& limit, const Outliers& outliers)
      : next_(next), limit_(limit), outliers_(outliers) {}

  void run() {
    for (std::size_t lane = 0; lane < kLanes; ++lane) begin(lane);
    while (busy_ > 0) {
      take_nodes();
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        Errand& errand = errands_[lane];
        if (errand.filter == nullptr) continue;
        ++errand.next;
        if (!is_over(errand, cost_[at(lane)] + log_volume_[at(lane)] > limit_)) continue;
        save(lane);
        --busy_;
        begin(lane);
      }
    }
  }

 private:
  /// Of the rows that are taken at once.
  struct Rows {
    Four length, turn, spread;
    Four own_length, own_both, own_turn;
    Four averaged_length, averaged_turn;  // of what gathers among the joined rows
  };
  /// What gathers after the rows' mean.
  struct Later {
    Four length = Four::Zero(), turn = length;
  };
  /// Where the contacts are, the equations' lines there, and their variances.
  struct Lines {
    Four s = Four::Zero(), slope = s, bent = s;
    Four rest = s;  // 1 - c m
    Four miss = s, own = s, all = s;
    Four noise = s;                   // of the row on its own and of what has gathered on the way
    Four of_length = s, of_turn = s;  // of what has gathered, with the equation
  };

  static Eigen::Index at(std::size_t lane) { return static_cast<Eigen::Index>(lane); }

  void begin(std::size_t lane) {
    Errand& errand = errands_[lane];
    while (next_(errand)) {
      if (is_over(errand, errand.filter->is_beyond(limit_))) continue;
      ++busy_;
      load(lane);
      return;
    }
    errand = {};
  }
  static bool is_over(const Errand& errand, bool is_beyond) {
    return errand.next == errand.end || (is_beyond && !errand.whole);
  }

  /// Every number of a filter, next to where the lanes have it.
  template <class Copy>
  void exchange(RollFilter& filter, const Copy& copy) {
    for (std::size_t k = 0; k < kRolling; ++k) {
      copy(x_[k], filter.x_[static_cast<int>(k)]);
      copy(dx_[k], filter.dx_[static_cast<int>(k)]);
    }
    copy(p00_, filter.p_(0, 0));
    copy(p01_, filter.p_(0, 1));
    copy(p02_, filter.p_(0, 2));
    copy(p11_, filter.p_(1, 1));
    copy(p12_, filter.p_(1, 2));
    copy(p22_, filter.p_(2, 2));
    copy(walk00_, filter.walk_(0, 0));
    copy(walk01_, filter.walk_(0, 1));
    copy(walk11_, filter.walk_(1, 1));
    copy(cost_, filter.cost_);
    copy(log_volume_, filter.log_volume_);
    copy(volume_, filter.volume_);
    copy(log_gathered_, filter.log_gathered_);
    copy(gathered_, filter.gathered_);
    copy(slope_, filter.slope_);
    copy(information_, filter.information_);
  }
  void load(std::size_t lane) {
    RollFilter& filter = *errands_[lane].filter;
    exchange(filter, [&](Four& all, const double& one) { all[at(lane)] = one; });
    tilt_ = filter.tilt_;
    w_[at(lane)] = filter.w_;
    first_s_[at(lane)] = filter.place_.s;
    first_slope_[at(lane)] = filter.place_.slope;
    most_scale_[at(lane)] = filter.most_scale_;
    guess_[at(lane)] = filter.guess_.value_or(0);
    follows_[at(lane)] = filter.guess_ ? 0 : 1;
  }
  void save(std::size_t lane) {
    RollFilter& filter = *errands_[lane].filter;
    exchange(filter, [&](const Four& all, double& one) { one = all[at(lane)]; });
    filter.p_(1, 0) = filter.p_(0, 1);
    filter.p_(2, 0) = filter.p_(0, 2);
    filter.p_(2, 1) = filter.p_(1, 2);
    filter.walk_(1, 0) = filter.walk_(0, 1);
  }

  Rows next_rows();
  void gather(const Four& length, const Four& turn);
  void look(std::size_t lane, double w, double variance, double spread, Lines& lines) const;
  void take_nodes();
  Four trust(const Lines& lines);
  void correct(const Lines& lines, const Four& per_scale, const Four& length,
               const std::array<Four, kRolling>& with_length);

  const NextErrand& next_;
  const double& limit_;
  const Outliers& outliers_;
  std::array<Errand, kLanes> errands_;
  std::size_t busy_ = 0;
  double tilt_ = 0;
  // Lanes without an errand go on with these: they only have to stay finite.
  std::array<Four, kRolling> x_{Four::Zero(), Four::Zero(), Four::Zero()};
  std::array<Four, kRolling> dx_ = x_;
  Four p00_ = Four::Zero(), p01_ = p00_, p02_ = p00_, p11_ = p00_, p12_ = p00_, p22_ = p00_;
  Four walk00_ = p00_, walk01_ = p00_, walk11_ = p00_;
  Later later_;
  Four cost_ = p00_, log_volume_ = p00_, volume_ = Four::Ones(), log_gathered_ = p00_, gathered_ = Four::Ones(),
       slope_ = p00_, information_ = p00_;
  Four w_ = p00_, first_s_ = p00_, first_slope_ = p00_, most_scale_ = Four::Ones(), guess_ = p00_, follows_ = p00_;
};

SideBySide::Rows SideBySide::next_rows() {
  static const Node kNone{0, 0, 0, {1, 0, 1}, {}, 1, 1};
  std::array<const Node*, kLanes> nodes;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    nodes[lane] = errands_[lane].filter != nullptr ? errands_[lane].next : &kNone;
  }
  const auto each = [&](const auto& number) {
    return Four(number(*nodes[0]), number(*nodes[1]), number(*nodes[2]), number(*nodes[3]));
  };
  const Four length = each([](const Node& node) { return node.gathered.length; });
  const Four turn = each([](const Node& node) { return node.gathered.turn; });
  const Four in_mean = each([](const Node& node) { return node.share_in_mean(); });
  const Four averaged = each([](const Node& node) { return node.share_averaged(); });
  gather(in_mean * length, in_mean * turn);
  later_ = {(1 - in_mean) * length, (1 - in_mean) * turn};
  return {each([](const Node& node) { return node.length; }),
          each([](const Node& node) { return node.turn; }),
          each([](const Node& node) { return node.spread; }),
          each([](const Node& node) { return node.own.length; }),
          each([](const Node& node) { return node.own.both; }),
          each([](const Node& node) { return node.own.turn; }),
          averaged * length,
          averaged * turn};
}

void SideBySide::gather(const Four& length, const Four& turn) {
  p00_ += length;
  p11_ += turn;
  walk00_ += length;
  walk11_ += turn;
}

void SideBySide::look(std::size_t lane, double w, double variance, double spread, Lines& lines) const {
  if (errands_[lane].filter == nullptr) return;
  const SpreadPlace end = errands_[lane].filter->arc()->about(w, variance, spread);
  lines.s[at(lane)] = end.s;
  lines.slope[at(lane)] = end.slope;
  lines.bent[at(lane)] = end.variance;
}

// The true L and theta lead from one place to another: e = s(w + theta + c L) - s(w) - L = 0, with ds/dw = m. By the
// shared errors that is (1 - c m) g less m times the turn's, g = (1, 0, L) / (1 + scale): what g makes of their
// covariance does for any m.
void SideBySide::take_nodes() {
  const Rows rows = next_rows();
  const Four per_scale = 1 / (1 + x_[2]);
  const Four length = (rows.length - x_[0]) * per_scale;
  const Four turn_off = (1 - follows_) * (x_[1] - guess_);  // of the turn that is taken, from the likeliest
  const Four measured = w_ + (rows.turn - (x_[1] - turn_off)) + tilt_ * length;
  const std::array<Four, kRolling> with_length = {
      per_scale * (p00_ + length * p02_), per_scale * (p01_ + length * p12_), per_scale * (p02_ + length * p22_)};
  const Four length_variance = per_scale * (with_length[0] + length * with_length[2]);
  // Of the contact's place in w with the length and with the turn.
  const Four by_length = tilt_ * (length_variance + rows.own_length) + with_length[1] + rows.own_both;
  const Four by_turn = tilt_ * (with_length[1] + rows.own_both) + p11_ + rows.own_turn;
  const Four variance = (tilt_ * by_length + by_turn).max(0.0);

  Lines lines;
  const auto draw = [&](const Four& beyond) {
    const Four& m = lines.slope;
    lines.rest = 1 - tilt_ * m;
    const Four by_offset = lines.rest * per_scale;
    lines.own =
        lines.rest * (lines.rest * rows.own_length - 2 * m * rows.own_both) + m * m * rows.own_turn + lines.bent;
    const Four alone = lines.own - by_offset * by_offset * rows.averaged_length - m * m * rows.averaged_turn;
    lines.of_length = by_offset * walk00_ - m * walk01_;
    lines.of_turn = by_offset * walk01_ - m * walk11_;
    lines.noise = alone + by_offset * lines.of_length - m * lines.of_turn;
    lines.all = alone + lines.rest * (lines.rest * length_variance - 2 * m * with_length[1]) + m * m * p11_;
    lines.miss = lines.s + m * (beyond - turn_off) - first_s_ - length;
  };
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    look(lane, measured[at(lane)], variance[at(lane)], rows.spread[at(lane)], lines);
  }
  draw(Four::Zero());
  // Where the contact is likely to be, given the equation as well. A slope taken where the turn was measured would go
  // with that turn's own error, and what many rows say would be taken for more than it is.
  const Four with_place = lines.slope * by_turn - lines.rest * by_length;
  const Four gain = with_place / lines.all;
  Four shift = gain * lines.miss;
  if ((shift.abs() > kSameLine).any()) {
    const Four left = (variance - gain * with_place).max(0.0);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (std::abs(shift[at(lane)]) > kSameLine) {
        look(lane, measured[at(lane)] - shift[at(lane)], left[at(lane)], rows.spread[at(lane)], lines);
      } else {
        shift[at(lane)] = 0;
      }
    }
    draw(shift);
  }
  correct(lines, per_scale, length, with_length);
}

/// How much each row counts, over its variance.
Four SideBySide::trust(const Lines& lines) {
  const Four inverse = 1 / lines.all;
  const Four squared = lines.miss * lines.miss * inverse;
  Four trust = inverse;
  if (outliers_.share > 0) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (errands_[lane].filter == nullptr) continue;
      const RowShare share = share_of(1, squared[at(lane)], lines.noise[at(lane)], lines.all[at(lane)], outliers_);
      RollFilter& filter = *errands_[lane].filter;
      filter.right_rows_ += share.weight;
      filter.right_cost_ += share.weight * squared[at(lane)];
      cost_[at(lane)] += share.cost;
      volume_[at(lane)] *= share.volume;
      trust[at(lane)] *= share.weight;
    }
  } else {
    cost_ += squared;
    volume_ *= lines.all / lines.noise;
  }
  gathered_ *= lines.noise / lines.own;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (volume_[at(lane)] > kLargeVolume) {
      log_volume_[at(lane)] += std::log(volume_[at(lane)]);
      volume_[at(lane)] = 1;
    }
    if (gathered_[at(lane)] > kLargeVolume) {
      log_gathered_[at(lane)] += std::log(gathered_[at(lane)]);
      gathered_[at(lane)] = 1;
    }
  }
  return trust;
}

void SideBySide::correct(const Lines& lines, const Four& per_scale, const Four& length,
                         const std::array<Four, kRolling>& with_length) {
  const Four trusted = trust(lines);
  const Four innovation = -trusted.sqrt() * lines.miss;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (errands_[lane].filter != nullptr) errands_[lane].filter->whiteness_[0].add(innovation[at(lane)]);
  }
  const Four by_w =
      first_slope_ - lines.slope - lines.rest * per_scale * (dx_[0] + length * dx_[2]) + lines.slope * dx_[1];
  slope_ -= trusted * lines.miss * by_w;
  information_ += trusted * by_w * by_w;
  const std::array<Four, kRolling> of_errors = {lines.rest * with_length[0] - lines.slope * p01_,
                                                lines.rest * with_length[1] - lines.slope * p11_,
                                                lines.rest * with_length[2] - lines.slope * p12_};
  for (std::size_t k = 0; k < kRolling; ++k) {
    const Four gain = trusted * of_errors[k];
    x_[k] -= lines.miss * gain;
    dx_[k] += by_w * gain;
  }
  p00_ -= trusted * of_errors[0] * of_errors[0];
  p01_ -= trusted * of_errors[0] * of_errors[1];
  p02_ -= trusted * of_errors[0] * of_errors[2];
  p11_ -= trusted * of_errors[1] * of_errors[1];
  p12_ -= trusted * of_errors[1] * of_errors[2];
  p22_ -= trusted * of_errors[2] * of_errors[2];
  const Four seen = trusted * lines.all / lines.noise;
  walk00_ -= seen * lines.of_length * lines.of_length;
  walk01_ -= seen * lines.of_length * lines.of_turn;
  walk11_ -= seen * lines.of_turn * lines.of_turn;
  gather(later_.length, later_.turn);
  // A place that does not fit asks for lengths that no slip explains: it is refused by its cost, not followed.
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!(std::abs(x_[2][at(lane)]) > most_scale_[at(lane)])) continue;
    x_[2][at(lane)] = std::copysign(most_scale_[at(lane)], x_[2][at(lane)]);
    dx_[2][at(lane)] = 0;
  }
}

void run_errands(const NextErrand& next, bool with_centres, const double& limit, const Outliers& outliers) {
  if (!with_centres) return SideBySide(next, limit, outliers).run();
  for (Errand errand; next(errand);) {
    const auto goes_on = [&] { return errand.whole || !errand.filter->is_beyond(limit); };
    for (; errand.next != errand.end && goes_on(); ++errand.next) errand.filter->update(*errand.next, outliers);
  }
}

}  // namespace rollfix::belief
