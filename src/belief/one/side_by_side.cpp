#include "belief/one/roll_filter.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "belief/posterior.hpp"
#include "work/pulse.hpp"

// Notation, the same as in roll_filter.cpp, four filters one in each number of a `Four`:
//   w, c, m         `w_`, `tilt_`, `Lines::slope`; 1 - c m is `Lines::rest`
//   x, dx/dw, P     `x_`, `dx_`, `p_`, the first `Errors` of the shared errors
//   e               `Lines::miss`, the one equation of a row without centre: s(w + theta + c L) - s(w) - L
//   de/dx           (1 - c m) g - m h, see `take_nodes`: g in `Rolled::by_lengths`, h in `Rolled::by_turns`
//   R, G            `Lines::own`; `walk00_`, `walk01_`, `walk11_` of length and turn
//   S, S_w          their sums for one row: `Lines::all`, `Lines::noise`
// Follows docs/belief.md, "The computation".
// Idea: one filter is a long chain of operations, each of which waits for the one before. Four of them side by side
// keep the processor busy; each has the same result as it would have alone.
namespace rollfix::belief {

namespace {

// What a processor keeps in flight at once.
constexpr std::size_t kLanes = 4;
// Volumes are multiplied up to here before a logarithm is taken.
constexpr double kLargeVolume = 1000;
/// One number of each of the filters.
using Four = Eigen::Array<double, kLanes, 1>;

}  // namespace

/// Filters that take a row each, as one equation; see RollFilter::update. Of the errors that a roll shares they know
/// the first so many.
template <int Errors>
class SideBySide {
 public:
  SideBySide(const NextRun& next, const double& limit, const Outliers& outliers)
      : next_(next), limit_(limit), outliers_(outliers) {}

  void run() {
    // Each turn of the loop takes one node in every lane. A lane whose run is over gets the next one at once.
    for (std::size_t lane = 0; lane < kLanes; ++lane) begin(lane);
    while (busy_ > 0) {
      take_nodes();
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        FilterRun& run = runs_[lane];
        if (run.filter == nullptr) continue;
        ++run.next;
        if (!is_over(run, cost_[at(lane)] + log_volume_[at(lane)] > limit_)) continue;
        save(lane);
        --busy_;
        begin(lane);
      }
    }
  }

 private:
  using PerError = std::array<Four, Errors>;
  /// The same value for all errors and lanes.
  static PerError all(double value) {
    PerError each;
    each.fill(Four::Constant(value));
    return each;
  }
  /// Symmetric: its upper half.
  struct Covariance {
    std::array<PerError, Errors> upper;
    const Four& operator()(std::size_t k, std::size_t j) const { return k < j ? upper[k][j] : upper[j][k]; }
    Four& operator()(std::size_t k, std::size_t j) { return k < j ? upper[k][j] : upper[j][k]; }
    static Covariance none() {
      Covariance covariance;
      covariance.upper.fill(all(0));
      return covariance;
    }
  };

  /// Of the rows that are taken at once.
  struct Rows {
    Four length, turn, sensed, seconds, spread;
    Four own_length, own_both, own_turn;
    Four averaged_length, averaged_turn;  // of what gathers among the joined rows
  };
  /// Variances that gather.
  struct Walked {
    Four length = Four::Zero(), turn = length;
  };
  /// What the rows are linearised about, and over; see RollFilter::linearised_at.
  struct LinearisedAt {
    PerError errors;
    Covariance open;
  };
  /// Lengths and turns as they are without what the roll shares.
  struct Rolled {
    Four per_scale, length, sensed, seconds;
    Four by_turns(const PerError& errors) const {
      if constexpr (Errors > kWithoutBias) return errors[1] + sensed * errors[3] + seconds * errors[4];
      if constexpr (Errors > kWithoutGyroscope) return errors[1] + sensed * errors[3];
      return errors[1];
    }
    Four by_lengths(const PerError& errors) const { return per_scale * (errors[0] + length * errors[2]); }
  };
  /// How uncertain they are for what the roll shares.
  struct Uncertain {
    PerError with_length, with_turn;  // covariances with the shared errors
    Four length, both, turn;
  };
  /// Where the contacts are, the equations' lines there, and their variances.
  struct Lines {
    Four s = Four::Zero(), slope = s, bent = s;
    Four rest = s;  // 1 - c m
    Four miss = s, own = s, all = s;
    Four noise = s;                    // of the row on its own and of what has gathered on the way
    Four of_length = s, of_turn = s;   // of what has gathered, with the equation
    Four beyond = s, beyond_by_w = s;  // an end of the arc, see SpreadPlace
  };

  // Eigen counts with signed numbers.
  static Eigen::Index at(std::size_t lane) { return static_cast<Eigen::Index>(lane); }

  /// Gives a lane its next run that has nodes to take; an empty one where there is none.
  void begin(std::size_t lane) {
    beat();
    FilterRun& run = runs_[lane];
    while (next_(run)) {
      if (is_over(run, run.filter->is_beyond(limit_))) continue;
      ++busy_;
      load(lane);
      return;
    }
    run = {};
  }
  /// All nodes are taken, or the deviance is beyond what can matter and the run need not be whole.
  static bool is_over(const FilterRun& run, bool is_beyond) { return run.next == run.end || (is_beyond && !run.whole); }

  /// Every number of a filter, next to where the lanes have it.
  template <class Copy>
  void exchange(RollFilter& filter, const Copy& copy) {
    for (std::size_t k = 0; k < Errors; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      copy(x_[k], filter.x_[row]);
      copy(dx_[k], filter.dx_[row]);
      for (std::size_t j = k; j < Errors; ++j) copy(p_(k, j), filter.p_(row, static_cast<Eigen::Index>(j)));
    }
    copy(walk00_, filter.walk_(0, 0));
    copy(walk01_, filter.walk_(0, 1));
    copy(walk11_, filter.walk_(1, 1));
    copy(on_the_way_.length, filter.on_the_way_.length);
    copy(on_the_way_.turn, filter.on_the_way_.turn);
    copy(cost_, filter.cost_);
    copy(log_volume_, filter.log_volume_);
    copy(volume_, filter.volume_);
    copy(log_gathered_, filter.log_gathered_);
    copy(gathered_, filter.gathered_);
    copy(slope_, filter.slope_);
    copy(information_, filter.information_);
    copy(steepness_, filter.steepness_);
  }
  /// Copies a filter's numbers into its lane.
  void load(std::size_t lane) {
    RollFilter& filter = *runs_[lane].filter;
    exchange(filter, [&](Four& all, const double& one) { all[at(lane)] = one; });
    tilt_ = filter.tilt_;
    w_[at(lane)] = filter.w_;
    first_s_[at(lane)] = filter.place_.s;
    first_slope_[at(lane)] = filter.place_.slope;
    most_[2][at(lane)] = filter.most_scale_;
    if constexpr (Errors > kWithoutGyroscope) most_[3][at(lane)] = filter.most_gyroscope_scale_;
    if constexpr (Errors > kWithoutBias) most_[4][at(lane)] = filter.most_bias_;
    is_first_[at(lane)] = filter.found_ ? 0 : 1;
    if (filter.found_) load_found(lane, *filter.found_);
  }
  /// What the pass before found, for a filter in a later pass; see RollFilter::Found.
  void load_found(std::size_t lane, const RollFilter::Found& found) {
    for (std::size_t k = 0; k < Errors; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      found_.errors[k][at(lane)] = found.errors[row];
      for (std::size_t j = k; j < Errors; ++j) {
        found_.open(k, j)[at(lane)] = found.covariance(row, static_cast<Eigen::Index>(j));
      }
    }
    whole_way_.length[at(lane)] = found.gathered.length;
    whole_way_.turn[at(lane)] = found.gathered.turn;
  }
  /// The other way round; the lower halves of the symmetric matrices are filled in.
  void save(std::size_t lane) {
    RollFilter& filter = *runs_[lane].filter;
    exchange(filter, [&](const Four& all, double& one) { one = all[at(lane)]; });
    filter.p_.template triangularView<Eigen::StrictlyLower>() = filter.p_.transpose();
    filter.walk_(1, 0) = filter.walk_(0, 1);
  }

  /// The lanes' next nodes, after what gathers up to their mean was added to P and G.
  Rows next_rows();
  /// RollFilter::linearised_at for all lanes at once: branches become factors 0 and 1.
  LinearisedAt linearised_at(const Rows& rows) const;
  /// Offset and scale of lengths; else of turns.
  static constexpr bool is_of_length(std::size_t error) { return error == 0 || error == 2; }
  /// L and theta of the rows, less these errors.
  static Rolled rolled(const Rows& rows, const PerError& errors);
  /// Covariance of L and theta from this covariance of the shared errors.
  static Uncertain uncertain(const Rolled& rolled, const Covariance& p);
  /// By what the pass before left open; in a first pass by what the rows so far do.
  Uncertain open_of(const Rolled& rolled, const LinearisedAt& about, const Uncertain& so_far) const;
  /// Adds variances to the offsets in P, and to G.
  void gather(const Four& length, const Four& turn);
  /// s(w) as a line about w in one lane. A lane without a run gets none.
  void look(std::size_t lane, double w, double variance, double spread, Lines& lines) const;
  /// One node in every lane.
  void take_nodes();
  /// Adds each lane's row to cost and volume. Returns 1 / S of the row, times its weight where outliers are possible.
  Four trust(const Lines& lines);
  /// Kalman's correction of x, P, G and of what is summed for the likelihood.
  void correct(const Lines& lines, const Rolled& rolled, const Uncertain& uncertain);

  const NextRun& next_;
  const double& limit_;  // of the deviance; it may fall while the lanes run
  const Outliers& outliers_;
  std::array<FilterRun, kLanes> runs_;
  std::size_t busy_ = 0;  // lanes with a run
  double tilt_ = 0;
  // Lanes without a run go on with these: they only have to stay finite.
  PerError x_ = all(0), dx_ = x_, most_ = all(1);  // most_: bounds on |x| of scales and bias
  Covariance p_ = Covariance::none();
  Four walk00_ = Four::Zero(), walk01_ = walk00_, walk11_ = walk00_;
  Walked later_;                                    // what gathers after the rows' mean
  Walked on_the_way_;                               // so far
  Walked whole_way_;                                // in the pass before
  LinearisedAt found_{all(0), Covariance::none()};  // by the pass before
  Four cost_ = walk00_, log_volume_ = walk00_, volume_ = Four::Ones(), log_gathered_ = walk00_,
       gathered_ = Four::Ones(), slope_ = walk00_, information_ = walk00_, steepness_ = walk00_;
  Four w_ = walk00_, first_s_ = walk00_, first_slope_ = walk00_, is_first_ = Four::Ones();
};

template <int Errors>
typename SideBySide<Errors>::Rows SideBySide<Errors>::next_rows() {
  // A lane without a run takes this: variances above 0 keep all its numbers finite.
  static const Node kNone{0, 0, 0, 0, 0, {1, 0, 1}, {}, 1, 1};
  std::array<const Node*, kLanes> nodes;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    nodes[lane] = runs_[lane].filter != nullptr ? runs_[lane].next : &kNone;
  }
  const auto each = [&](const auto& number) {
    return Four(number(*nodes[0]), number(*nodes[1]), number(*nodes[2]), number(*nodes[3]));
  };
  const Four length = each([](const Node& node) { return node.gathered.length; });
  const Four turn = each([](const Node& node) { return node.gathered.turn; });
  const Four in_mean = each([](const Node& node) { return node.share_in_mean(); });
  const Four averaged = each([](const Node& node) { return node.share_averaged(); });
  // See Node::share_in_mean: the rest gathers after the correction.
  gather(in_mean * length, in_mean * turn);
  later_ = {(1 - in_mean) * length, (1 - in_mean) * turn};
  return {each([](const Node& node) { return node.length; }),
          each([](const Node& node) { return node.turn; }),
          each([](const Node& node) { return node.sensed; }),
          each([](const Node& node) { return node.seconds; }),
          each([](const Node& node) { return node.spread; }),
          each([](const Node& node) { return node.own.length; }),
          each([](const Node& node) { return node.own.both; }),
          each([](const Node& node) { return node.own.turn; }),
          averaged * length,
          averaged * turn};
}

template <int Errors>
void SideBySide<Errors>::gather(const Four& length, const Four& turn) {
  p_(0, 0) += length;
  p_(1, 1) += turn;
  walk00_ += length;
  walk11_ += turn;
  on_the_way_.length += length;
  on_the_way_.turn += turn;
}

template <int Errors>
void SideBySide<Errors>::look(std::size_t lane, double w, double variance, double spread, Lines& lines) const {
  if (runs_[lane].filter == nullptr) return;
  const SpreadPlace end = runs_[lane].filter->arc()->about(w, variance, spread);
  lines.s[at(lane)] = end.s;
  lines.slope[at(lane)] = end.slope;
  lines.bent[at(lane)] = end.variance;
  lines.beyond[at(lane)] = end.beyond;
  lines.beyond_by_w[at(lane)] = end.beyond_by_w;
}

template <int Errors>
typename SideBySide<Errors>::LinearisedAt SideBySide<Errors>::linearised_at(const Rows& rows) const {
  LinearisedAt about = found_;
  Covariance& open = about.open;
  // From this row to the end of the roll the offsets walk on: what was found at the end is that uncertain here.
  open(0, 0) += (whole_way_.length - on_the_way_.length).max(0.0);
  open(1, 1) += (whole_way_.turn - on_the_way_.turn).max(0.0);
  const auto of_length = [&](const Covariance& p) {
    return p(0, 0) + rows.length * (2 * p(0, 2) + rows.length * p(2, 2));
  };
  // 1 where the pass before leaves no more of this length open than the rows so far do, else 0.
  const Four from_end = (of_length(open) <= of_length(p_)).template cast<double>();
  for (std::size_t k = 0; k < Errors; ++k) {
    for (std::size_t j = k; j < Errors; ++j) {
      // Errors of length as the better of both has them; no covariance between errors from different passes.
      if (is_of_length(k) && is_of_length(j)) open(k, j) = p_(k, j) + from_end * (open(k, j) - p_(k, j));
      if (is_of_length(k) != is_of_length(j)) open(k, j) *= from_end;
    }
  }
  const Four is_later = 1 - is_first_;
  for (std::size_t k = 0; k < Errors; ++k) {
    // x where this is a first pass, or a length that the rows so far know better; else what was found.
    about.errors[k] = x_[k] + (is_of_length(k) ? Four(is_later * from_end) : is_later) * (about.errors[k] - x_[k]);
  }
  return about;
}

template <int Errors>
typename SideBySide<Errors>::Rolled SideBySide<Errors>::rolled(const Rows& rows, const PerError& errors) {
  const Four per_scale = 1 / (1 + errors[2]);
  return {per_scale, (rows.length - errors[0]) * per_scale, rows.sensed, rows.seconds};
}

template <int Errors>
typename SideBySide<Errors>::Uncertain SideBySide<Errors>::uncertain(const Rolled& rolled, const Covariance& p) {
  Uncertain uncertain;
  for (std::size_t k = 0; k < Errors; ++k) {
    uncertain.with_length[k] = rolled.per_scale * (p(0, k) + rolled.length * p(2, k));
    uncertain.with_turn[k] = p(1, k);
    if constexpr (Errors > kWithoutGyroscope) uncertain.with_turn[k] += rolled.sensed * p(3, k);
    if constexpr (Errors > kWithoutBias) uncertain.with_turn[k] += rolled.seconds * p(4, k);
  }
  uncertain.length = rolled.by_lengths(uncertain.with_length);
  uncertain.both = rolled.by_turns(uncertain.with_length);
  uncertain.turn = rolled.by_turns(uncertain.with_turn);
  return uncertain;
}

template <int Errors>
typename SideBySide<Errors>::Uncertain SideBySide<Errors>::open_of(const Rolled& rolled, const LinearisedAt& about,
                                                                   const Uncertain& so_far) const {
  // Lanes in their first pass: what the rows so far leave.
  Uncertain open = uncertain(rolled, about.open);
  open.length += is_first_ * (so_far.length - open.length);
  open.both += is_first_ * (so_far.both - open.both);
  open.turn += is_first_ * (so_far.turn - open.turn);
  return open;
}

// The true L and theta lead from one place to another: e = s(w + theta + c L) - s(w) - L = 0, with ds/dw = m. By the
// shared errors that is (1 - c m) g less m h, g = (1, 0, L, 0, 0) / (1 + scale) and h = (0, 1, 0, what was sensed, the
// time): what g and h make of their covariance does for any m.
template <int Errors>
void SideBySide<Errors>::take_nodes() {
  const Rows rows = next_rows();
  const bool is_first = (is_first_ > 0).all();
  const LinearisedAt about = is_first ? LinearisedAt{x_, p_} : linearised_at(rows);
  const Rolled roll = rolled(rows, about.errors);
  const Four& length = roll.length;
  // w at the contact by the measured roll: w + theta + c L.
  const Four measured = w_ + (rows.turn - roll.by_turns(about.errors)) + tilt_ * length;
  const Uncertain so_far = uncertain(roll, p_);
  const Uncertain open = is_first ? so_far : open_of(roll, about, so_far);
  // Of the contact's place in w with the length and with the turn.
  const Four by_length = tilt_ * (open.length + rows.own_length) + open.both + rows.own_both;
  const Four by_turn = tilt_ * (open.both + rows.own_both) + open.turn + rows.own_turn;
  const Four variance = (tilt_ * by_length + by_turn).max(0.0);
  // From what the rows are linearised about to the likeliest.
  PerError off;
  for (std::size_t k = 0; k < Errors; ++k) off[k] = x_[k] - about.errors[k];
  const Four length_off = roll.by_lengths(off);
  const Four turn_off = roll.by_turns(off);

  Lines lines;
  // Fills in `lines` for contacts that are `beyond` from where their lines were drawn, in w.
  const auto draw = [&](const Four& beyond) {
    const Four& m = lines.slope;
    lines.rest = 1 - tilt_ * m;
    // de/d(offset of length) = (1 - c m) / (1 + scale), de/d(offset of turn) = -m.
    const Four by_offset = lines.rest * roll.per_scale;
    lines.own =
        lines.rest * (lines.rest * rows.own_length - 2 * m * rows.own_both) + m * m * rows.own_turn + lines.bent;
    // What averages out among a node's rows is in P already.
    const Four alone = lines.own - by_offset * by_offset * rows.averaged_length - m * m * rows.averaged_turn;
    lines.of_length = by_offset * walk00_ - m * walk01_;
    lines.of_turn = by_offset * walk01_ - m * walk11_;
    // S_w of this row: its own errors and G.
    lines.noise = alone + by_offset * lines.of_length - m * lines.of_turn;
    // S of this row: with P of all shared errors.
    lines.all = alone + lines.rest * (lines.rest * so_far.length - 2 * m * so_far.both) + m * m * so_far.turn;
    // e at the filter's own estimate: the line is drawn about `about`, and taken from there to x.
    lines.miss = lines.s + m * (beyond - turn_off) - first_s_ - length + lines.rest * length_off;
  };
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    look(lane, measured[at(lane)], variance[at(lane)], rows.spread[at(lane)], lines);
  }
  draw(Four::Zero());
  // Where the contact is likely to be, given the equation as well. A slope taken where the turn was measured would go
  // with that turn's own error, and what many rows say would be taken for more than it is.
  // Covariance of the contact's w with e; `shift` is how far off w is likely to be, given e.
  const Four with_place = lines.slope * by_turn - lines.rest * by_length;
  Four gain = with_place / lines.all;
  Four shift = gain * lines.miss;
  if (!is_first) {
    const Four& m = lines.slope;
    // In a later pass by what is open about the point of linearisation, and by e there.
    gain = with_place / (lines.own + lines.rest * (lines.rest * open.length - 2 * m * open.both) + m * m * open.turn);
    shift = gain * (lines.miss + m * turn_off - lines.rest * length_off);
  }
  if ((shift.abs() > kSameLine).any()) {
    // The variance of w that e leaves. Lines are drawn again only in lanes that are far off.
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
  correct(lines, roll, so_far);
}

/// How much each row counts, over its variance.
template <int Errors>
Four SideBySide<Errors>::trust(const Lines& lines) {
  const Four inverse = 1 / lines.all;
  const Four squared = lines.miss * lines.miss * inverse + lines.beyond * lines.beyond;
  Four trust = inverse;
  if (outliers_.share > 0) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (runs_[lane].filter == nullptr) continue;
      const RowShare share = share_of(1, squared[at(lane)], lines.noise[at(lane)], lines.all[at(lane)], outliers_);
      RollFilter& filter = *runs_[lane].filter;
      filter.right_rows_ += share.weight;
      filter.right_cost_ += share.weight * squared[at(lane)];
      cost_[at(lane)] += share.cost;
      volume_[at(lane)] *= share.volume;
      trust[at(lane)] *= share.weight;
    }
  } else {
    cost_ += squared;
    // det S / det S_w, row by row; the product's logarithm is taken now and then.
    volume_ *= lines.all / lines.noise;
  }
  gathered_ *= lines.noise / lines.own;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    // Factors are 1 or more: only overflow is to be kept away.
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

template <int Errors>
void SideBySide<Errors>::correct(const Lines& lines, const Rolled& rolled, const Uncertain& uncertain) {
  const Four trusted = trust(lines);
  // In standard deviations.
  const Four innovation = -trusted.sqrt() * lines.miss;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (runs_[lane].filter != nullptr) runs_[lane].filter->whiteness_[0].add(innovation[at(lane)]);
  }
  // de/dw with the estimate moving along, sign reversed: m0 - m - (1 - c m) g dx/dw + m h dx/dw.
  const Four by_w =
      first_slope_ - lines.slope - lines.rest * rolled.by_lengths(dx_) + lines.slope * rolled.by_turns(dx_);
  const Four weight = trusted * lines.all;  // below 1 if it may be an outlier
  slope_ += weight * lines.beyond * lines.beyond_by_w - trusted * lines.miss * by_w;
  const Four at_most = outliers_.share > 0 ? Four(1 / lines.all) : trusted;
  information_ += trusted * by_w * by_w + weight * lines.beyond_by_w * lines.beyond_by_w;
  steepness_ += at_most * by_w * by_w + lines.beyond_by_w * lines.beyond_by_w;
  PerError of_errors;
  for (std::size_t k = 0; k < Errors; ++k) {
    // P H^T with H = (1 - c m) g - m h.
    of_errors[k] = lines.rest * uncertain.with_length[k] - lines.slope * uncertain.with_turn[k];
    const Four gain = trusted * of_errors[k];
    x_[k] -= lines.miss * gain;
    dx_[k] += by_w * gain;
  }
  for (std::size_t k = 0; k < Errors; ++k) {
    for (std::size_t j = k; j < Errors; ++j) p_(k, j) -= trusted * of_errors[k] * of_errors[j];
  }
  // The gain of the filter with G alone divides by S_w.
  const Four seen = weight / lines.noise;
  walk00_ -= seen * lines.of_length * lines.of_length;
  walk01_ -= seen * lines.of_length * lines.of_turn;
  walk11_ -= seen * lines.of_turn * lines.of_turn;
  gather(later_.length, later_.turn);
  // A place that does not fit asks for lengths that no slip explains: it is refused by its cost, not followed.
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::size_t k = 2; k < Errors; ++k) {
      if (!(std::abs(x_[k][at(lane)]) > most_[k][at(lane)])) continue;
      x_[k][at(lane)] = std::copysign(most_[k][at(lane)], x_[k][at(lane)]);
      dx_[k][at(lane)] = 0;
    }
  }
}

/// Rows with centres have three equations and are taken one filter at a time. Others run side by side, with no more
/// shared errors than the log has.
void run_filters(const NextRun& next, const RowEquations& equations, const double& limit, const Outliers& outliers) {
  if (!equations.centres && equations.bias) return SideBySide<kRolling>(next, limit, outliers).run();
  if (!equations.centres && equations.gyroscope_scale) return SideBySide<kWithoutBias>(next, limit, outliers).run();
  if (!equations.centres) return SideBySide<kWithoutGyroscope>(next, limit, outliers).run();
  for (FilterRun run; next(run);) {
    const auto goes_on = [&] { return run.whole || !run.filter->is_beyond(limit); };
    for (; run.next != run.end && goes_on(); ++run.next) run.filter->update(*run.next, outliers);
  }
}

}  // namespace rollfix::belief
