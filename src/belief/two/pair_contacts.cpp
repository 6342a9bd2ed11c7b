#include "belief/two/pair_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "belief/posterior.hpp"

// Notation, as in docs/two_fingers.md, "The errors":
//   w_a, w_b        tilted turnings w = Theta + c s of both contacts; [0] is finger a, [1] finger b
//   S_a, S_b        where the contacts were felt, less the shared errors: `felt_at`
//   D               w_b - w_a, as the row's turn and S_a, S_b tell it: `apart`
//   m               ds/dw = 1 / (kappa + c); 0 in a corner
//   e_a, e_b        s(w_a) - S_a and s(w_a + D) - S_b: how far contacts are from where they were felt
//   V_a, V_b        their variances: (1 - (c - k) m)^2 of the row's own error, (1 - c m)^2 of what is open
//   k               1 / r where the place turns the measured normal, else 0: `normal_turn`
// Idea: how far the part has turned by a row is not known, so that w_a is the row's own unknown. Both e grow with it:
// it is between their roots. On a flat side c m = 1: what is open of S moves w as much, and e not at all.
namespace rollfix::belief {

namespace {

constexpr int kMostSteps = 8;

/// Both e at a w_a, and what they are known to.
struct Misses {
  std::array<double, 2> length{};     // e
  std::array<double, 2> slope{};      // m
  std::array<double, 2> precision{};  // 1 / V

  double cost() const { return square(length[0]) * precision[0] + square(length[1]) * precision[1]; }
  /// Half its derivative by w_a.
  double pull() const { return slope[0] * length[0] * precision[0] + slope[1] * length[1] * precision[1]; }
  /// The information on w_a that a finger's e is.
  double told(std::size_t finger) const { return square(slope[finger]) * precision[finger]; }
};

class RowContacts {
 public:
  RowContacts(const PairModel& model, const StartPlaces& at, const RowPlaces& row)
      : model_(model), at_(at), row_(row) {}

  /// Gauss and Newton's steps from the better root, as long as they make it better.
  Contacts best() const {
    const double root_a = row_.root[0];
    const double root_b = row_.root[1] - row_.apart;
    const auto [least, most] = std::minmax(root_a, root_b);
    double w = root_a;
    Misses here = misses_at(w);
    if (most - least > kSameContact) {
      const Misses other = misses_at(root_b);
      if (other.cost() < here.cost()) {
        w = root_b;
        here = other;
      }
    }
    for (int k = 0; k < kMostSteps; ++k) {
      const double told = here.told(0) + here.told(1);
      // Both at corners.
      if (!(told > 0)) break;
      const double next = std::clamp(w - here.pull() / told, least, most);
      const Misses then = misses_at(next);
      const bool is_there = std::abs(next - w) <= kSameContact;
      if (then.cost() > here.cost() && !is_there) break;
      w = next;
      here = then;
      if (is_there) break;
    }
    return {{w, w + row_.apart}, spread_about(w, here)};
  }

 private:
  Misses misses_at(double w) const {
    Misses misses;
    for (const std::size_t finger : {0U, 1U}) {
      const TiltedPlace place = at_.arc[finger]->at(finger == 0 ? w : w + row_.apart);
      misses.length[finger] = place.s - row_.felt_at[finger];
      misses.slope[finger] = place.slope;
    }
    weigh(misses);
    return misses;
  }

  void weigh(Misses& misses) const {
    for (const std::size_t finger : {0U, 1U}) {
      const double tilt = model_.boundary[finger]->tilt();
      const double m = misses.slope[finger];
      const double by_own = 1 - (tilt - model_.errors->normal_turn(finger)) * m;
      // D is off for both alike: half of it is each one's.
      misses.precision[finger] =
          1 / (square(by_own) * row_.own + square(1 - tilt * m) * row_.open[finger] + 0.5 * square(m) * turn());
    }
  }

  /// The variance of each w given both e. Where slip leaves S open, the slopes are those over what it leaves.
  std::array<double, 2> spread_about(double w, Misses here) const {
    if (row_.open[0] <= 0 && row_.open[1] <= 0) return variances(here, false);
    const std::array<double, 2> wide = variances(here, false);
    here.slope = {at_.arc[0]->about(w, wide[0], 0).slope, at_.arc[1]->about(w + row_.apart, wide[1], 0).slope};
    weigh(here);
    return variances(here, true);
  }

  /// `tells_place`: e tells of S as well.
  std::array<double, 2> variances(const Misses& here, bool tells_place) const {
    std::array<double, 2> variance{};
    for (const std::size_t finger : {0U, 1U}) {
      // What the other contact tells comes through D.
      const double of_other = 1 / (1 / here.told(1 - finger) + turn());
      const double tilt = model_.boundary[finger]->tilt();
      const double open = row_.open[finger];
      const double told = tells_place ? open * square(1 - tilt * here.slope[finger]) / row_.own : 0;
      variance[finger] = 1 / (here.told(finger) + of_other + 1 / square(kPivot)) + square(tilt) * open / (1 + told);
    }
    return variance;
  }

  double turn() const { return row_.turn + row_.open_turn; }

  const PairModel& model_;
  const StartPlaces& at_;
  const RowPlaces& row_;
};

}  // namespace

/// S = s_0 + (L + n_0) / (1 + eps). D is c_b S_b - c_a S_a - C with the facing, up to whole turns, which the places
/// tell. Without it D is the change since the first contacts, eqs. (8) and (9), whose own errors are in it as well.
RowPlaces places_in(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x,
                    const PairSharedCovariance* open) {
  const PairErrors& errors = *model.errors;
  const double rows = std::max(1e-6, node.rows);
  RowPlaces row;
  row.own = errors.contact_variance() / rows;
  row.turn = (errors.turn_variance() + node.alike * errors.part_variance()) / rows;
  row.apart = -node.turn;
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    const double sign = finger == 0 ? -1 : 1;
    const double tilt = model.boundary[finger]->tilt();
    const double normal_turn = errors.normal_turn(finger);
    const double per_scale = 1 / (1 + x[2 + i]);
    const double length = (node.length[finger] + x[i]) * per_scale;
    row.felt_at[finger] = at.place[finger].s + length;
    row.root[finger] = at.arc[finger]->w_at(row.felt_at[finger]);
    row.felt_by(i, i) = per_scale;
    row.felt_by(i, 2 + i) = -per_scale * length;
    row.felt_by(i, kByErrors + i) = at.place[finger].slope;
    row.felt_by(i, kByErrors + kByStart + i) = 1;
    row.apart_by += sign * tilt * row.felt_by.row(i);
    // With the place that is felt elsewhere the measured normal turns.
    row.apart_by[kByErrors + kByStart + i] -= sign * normal_turn;
    if (errors.absolute()) {
      row.apart += sign * tilt * row.felt_at[finger];
    } else {
      row.apart += sign * (at.w[finger] + tilt * length + normal_turn * x[i]);
      row.apart_by[i] += sign * normal_turn;
      row.apart_by[kByErrors + i] = sign;
    }
    if (open == nullptr) continue;
    // Of S, by offset and scale: (1, -L) P (1, -L)^T, over (1 + eps)^2.
    const double of_length = (*open)(i, i) - 2 * length * (*open)(i, 2 + i) + square(length) * (*open)(2 + i, 2 + i);
    row.open[finger] = std::max(0.0, square(per_scale) * of_length);
  }
  row.apart_by[kByAll - 1] = -1;
  if (errors.absolute()) {
    const double off = row.root[1] - row.root[0] - row.apart;
    row.apart += off - nearest_to_zero(off);
  } else {
    row.apart += x[4];
    row.apart_by[4] = 1;
    if (open != nullptr) row.open_turn = (*open)(4, 4);
  }
  return row;
}

Contacts contacts_of(const PairModel& model, const StartPlaces& at, const RowPlaces& row) {
  return RowContacts(model, at, row).best();
}

}  // namespace rollfix::belief
