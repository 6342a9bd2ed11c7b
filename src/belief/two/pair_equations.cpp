#include <algorithm>
#include <cmath>

#include "belief/posterior.hpp"
#include "belief/two/pair_filter.hpp"

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
    if (most - least > kSameLine) {
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
      const bool is_there = std::abs(next - w) <= kSameLine;
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

// ---- the equations
// Notation, as in docs/two_fingers.md, "The errors"; w, S, D, m and e as above:
//   x               errors that the roll shares (n_a0, n_b0, eps_a, eps_b, first turn)
//   f, H, df/dw     a row's equations, `by_errors`, `by_start`
//   without         the combination of e_a and e_b that does not depend on w_a: (m_b, -m_a), normalized
//   step            how w_a changes with e_a and e_b, of least squares
//   q               the centres of the fingers in the part's frame
// Follows docs/two_fingers.md, "The errors", and of centres docs/belief.md, "Centres as evidence".
// Idea: two equations in the row's own unknown w_a leave one without it. A finger at a corner, m = 0, tells nothing of
// the turn, but where it is. The centres tell of w_a as well: two equations more.

namespace {

// Steps to where the centres say that the contacts are, and the longest one; radians. Below kSameLine it is there.
constexpr int kMostCentreSteps = 8;
constexpr double kLongestStep = 0.3;
// Centres nearer together than this share of the perimeter have no direction from one to the other.
constexpr double kLeastDistance = 1e-6;

/// e_a and e_b on the lines through where the contacts fit best.
struct ContactRows {
  Eigen::Vector2d e;
  Eigen::Vector2d m;
  ByAll<2> by;
  Eigen::Vector2d bends;  // variance of what the lines miss
  std::array<SpreadPlace, 2> place;
};

/// Rows of a node lie about its mean as they do along an even roll from the node before, `before`.
ContactRows contact_rows(const StartPlaces& at, const RowPlaces& row, const Contacts& contacts, bool is_mean,
                         const std::array<double, 2>& before) {
  ContactRows rows;
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    const double w = contacts.w[finger];
    const double spread = is_mean ? square(w - before[finger]) / 12 : 0;
    const SpreadPlace place = at.arc[finger]->about(w, contacts.variance[finger] + spread, 0);
    rows.e[i] = place.s - row.felt_at[finger];
    rows.m[i] = place.slope;
    rows.bends[i] = place.variance;
    rows.place[finger] = place;
  }
  rows.by = -row.felt_by;
  rows.by.row(1) += rows.m[1] * row.apart_by;
  return rows;
}

/// The distance and the direction of the centres, and how they change.
struct CentreRows {
  Eigen::Vector2d f;
  Eigen::Matrix2d by_w;     // of both contacts
  Eigen::Matrix2d by_felt;  // by the places' own errors, w kept: by the arms and the normals
  Eigen::Vector2d variance;
};

/// With the fingers at q = p(s) - R(Theta + pi/2) arm in the part's frame, |q_b - q_a| is the distance of their
/// centres, and the direction of q_b - q_a less the middle of both normals is what it is in the world.
template <class Place>
CentreRows centre_rows(const PairModel& model, const std::array<double, 2>& w, const std::array<Place, 2>& place,
                       const PairNode& node) {
  const PairErrors& errors = *model.errors;
  const PairCentres& felt = *node.centres;
  std::array<Vec2, 2> q;
  std::array<Vec2, 2> q_by_w;
  std::array<Vec2, 2> q_by_felt;  // where the arm was felt elsewhere
  std::array<double, 2> angle{};
  std::array<double, 2> angle_by_w{};
  for (const std::size_t finger : {0U, 1U}) {
    const double tilt = model.boundary[finger]->tilt();
    angle[finger] = w[finger] - tilt * place[finger].s;
    angle_by_w[finger] = 1 - tilt * place[finger].slope;
    const Vec2 tangent(std::cos(angle[finger]), std::sin(angle[finger]));
    // The inward normal. An arm has its first coordinate along it, its second against the tangent.
    const Vec2 normal(-tangent.y(), tangent.x());
    const auto in_part = [&](const Vec2& arm) { return Vec2(arm.x() * normal - arm.y() * tangent); };
    const Vec2 arm = in_part(felt.arm[finger].at);
    q[finger] = model.path->at(place[finger].s) - arm;
    q_by_w[finger] = place[finger].slope * tangent - angle_by_w[finger] * Vec2(-arm.y(), arm.x());
    q_by_felt[finger] = in_part(felt.arm[finger].per_length);
  }
  // From a to b. Centres that nearly coincide have no direction: `distance` is bounded from below.
  const Vec2 way = q[1] - q[0];
  const double distance = std::max(way.norm(), kLeastDistance * errors.perimeter());
  const Vec2 along = way / distance;
  const Vec2 turning(-along.y() / distance, along.x() / distance);
  CentreRows rows;
  // The distance; and the direction less the middle of both normals, each Theta + pi/2, up to half turns.
  rows.f[0] = way.norm() - felt.distance;
  const double direction = std::atan2(way.y(), way.x()) - kHalfTurn / 2 - 0.5 * (angle[0] + angle[1]);
  const double off = direction - felt.direction;
  rows.f[1] = off - kHalfTurn * std::floor(off / kHalfTurn + 0.5);
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    const double sign = finger == 0 ? -1 : 1;
    rows.by_w.col(i) << sign * along.dot(q_by_w[finger]), sign * turning.dot(q_by_w[finger]) - 0.5 * angle_by_w[finger];
    rows.by_felt.col(i) << sign * along.dot(q_by_felt[finger]),
        sign * turning.dot(q_by_felt[finger]) - 0.5 * errors.normal_turn(finger);
  }
  // Errors of both centres along the chord, and across it over its length; of the normals' mean half of one's.
  const double count = std::max(1e-6, node.rows);
  const double position = 2 * errors.centre_variance() / count;
  rows.variance << position, position / (distance * distance) + 0.5 * errors.angle_variance() / count;
  return rows;
}

/// By how much w_a changes with e_a and e_b, as far as their own errors weigh them.
Eigen::RowVector2d weights_of(const RowPlaces& row, const ContactRows& of) {
  return {of.m[0] / (row.own + of.bends[0]), of.m[1] / (row.own + square(of.m[1]) * row.turn + of.bends[1])};
}

/// The same contacts by what the centres tell as well: where both are at corners, nothing else tells w_a.
Contacts with_centres(const PairModel& model, const StartPlaces& at, const RowPlaces& row, const PairNode& node,
                      Contacts contacts) {
  for (int k = 0; k < kMostCentreSteps; ++k) {
    const ContactRows of = contact_rows(at, row, contacts, false, contacts.w);
    const CentreRows centres = centre_rows(model, contacts.w, of.place, node);
    const Eigen::Vector2d by_w = centres.by_w.rowwise().sum();
    Eigen::Matrix2d own = row.own * centres.by_felt * centres.by_felt.transpose();
    own.diagonal() += centres.variance;
    const Eigen::RowVector2d told = by_w.transpose() * own.inverse();
    const Eigen::RowVector2d weights = weights_of(row, of);
    const double information = told.dot(by_w) + weights.dot(of.m) + 1 / square(kPivot);
    const double step = -(told.dot(centres.f) + weights.dot(of.e)) / information;
    if (std::abs(step) <= kSameLine) {
      for (double& variance : contacts.variance) variance = 1 / (1 / variance + told.dot(by_w));
      break;
    }
    for (double& w : contacts.w) w += std::clamp(step, -kLongestStep, kLongestStep);
  }
  return contacts;
}

}  // namespace

/// Theta = w - c s and dTheta/dw = 1 - c m at both first contacts; in a corner 1.
StartPlaces places_of(const PairModel& model, const PairStart& start) {
  StartPlaces places;
  places.arc = start.arc;
  places.w = start.w;
  for (const std::size_t finger : {0U, 1U}) {
    const double tilt = model.boundary[finger]->tilt();
    places.place[finger] = start.arc[finger]->at(start.w[finger]);
    places.angle[finger] = start.w[finger] - tilt * places.place[finger].s;
    places.by_start[finger] = 1 - tilt * places.place[finger].slope;
  }
  return places;
}

/// f = Theta(s) - Theta(t) - C. The first contacts are s and t themselves: n_a0 and n_b0 enter by the felt normals
/// and, with centres, by the arms.
template <int N>
PairEquations<N> facing_equations(const PairModel& model, const StartPlaces& at, const PairNode& node,
                                  const PairShared& x) {
  const PairErrors& errors = *model.errors;
  PairEquations<N> rows;
  rows.w = at.w;
  rows.by_errors(0, 0) = -errors.normal_turn(0);
  rows.by_errors(0, 1) = errors.normal_turn(1);
  rows.f[0] = nearest_to_zero(at.angle[0] - at.angle[1] - node.turn + rows.by_errors.row(0).dot(x));
  rows.by_start.row(0) << at.by_start[0], -at.by_start[1];
  rows.variance(0, 0) = errors.facing_variance();
  if constexpr (N == 3) {
    const CentreRows centres = centre_rows(model, at.w, at.place, node);
    // The first contacts' own error is the one that the roll shares, the other way round.
    rows.by_errors.template bottomLeftCorner<2, 2>() = -centres.by_felt;
    rows.f.template tail<2>() = centres.f + rows.by_errors.template bottomRows<2>() * x;
    rows.by_start.template bottomRows<2>() = centres.by_w;
    rows.variance.template bottomRightCorner<2, 2>() = centres.variance.asDiagonal();
  }
  return rows;
}

/// e_a and e_b of docs/two_fingers.md as one equation without w_a; with the centres two more.
template <int N>
PairEquations<N> row_equations(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x,
                               const PairSharedCovariance* open, const std::array<double, 2>& before) {
  const RowPlaces row = places_in(model, at, node, x, open);
  Contacts contacts = contacts_of(model, at, row);
  if constexpr (N == 3) contacts = with_centres(model, at, row, node, contacts);
  const bool is_mean = node.gathered > 1 && !model.errors->gathers_rows();
  const ContactRows of = contact_rows(at, row, contacts, is_mean, before);
  // Where both are at corners, m = 0, any combination is without w_a.
  const Eigen::Vector2d m = of.m.isZero(0) ? Eigen::Vector2d::Ones() : of.m;
  const Eigen::RowVector2d without = Eigen::RowVector2d(m[1], -m[0]).normalized();
  const Eigen::Vector3d own(row.own, row.own, row.turn);

  PairEquations<N> rows;
  rows.w = contacts.w;
  for (const std::size_t finger : {0U, 1U}) {
    rows.past[static_cast<Eigen::Index>(finger)] = of.place[finger].beyond;
    rows.past_by_start[static_cast<Eigen::Index>(finger)] = of.place[finger].beyond_by_w;
  }
  rows.f[0] = without.dot(of.e);
  ByAll<N> by;
  by.row(0) = without * of.by;
  Eigen::Matrix<double, N, 2> by_bends;
  by_bends.row(0) = without;
  if constexpr (N == 3) {
    const CentreRows centres = centre_rows(model, contacts.w, of.place, node);
    const Eigen::Vector2d by_w = centres.by_w.rowwise().sum();
    // The step of w_a that e asks for; of its variance kPivot^2 it leaves `left`.
    const Eigen::RowVector2d weighted = weights_of(row, of);
    const Eigen::RowVector2d step = -weighted / (weighted * of.m + 1 / square(kPivot));
    const double left = square(kPivot * (1 + step.dot(of.m)));
    rows.f.template tail<2>() = centres.f + by_w * step.dot(of.e);
    by.template bottomRows<2>() = centres.by_w.col(1) * row.apart_by + by_w * (step * of.by);
    by.template block<2, 2>(1, kByErrors + kByStart) += centres.by_felt;
    by_bends.template bottomRows<2>() = by_w * step;
    rows.variance.template bottomRightCorner<2, 2>() = left * by_w * by_w.transpose();
    rows.variance.template bottomRightCorner<2, 2>().diagonal() += centres.variance;
  }
  rows.by_errors = by.template leftCols<kByErrors>();
  rows.by_start = by.template middleCols<kByStart>(kByErrors);
  const Eigen::Matrix<double, N, kByOwn> by_own = by.template rightCols<kByOwn>();
  rows.variance +=
      by_own * own.asDiagonal() * by_own.transpose() + by_bends * of.bends.asDiagonal() * by_bends.transpose();
  return rows;
}

template PairEquations<1> facing_equations(const PairModel&, const StartPlaces&, const PairNode&, const PairShared&);
template PairEquations<3> facing_equations(const PairModel&, const StartPlaces&, const PairNode&, const PairShared&);
template PairEquations<1> row_equations(const PairModel&, const StartPlaces&, const PairNode&, const PairShared&,
                                        const PairSharedCovariance*, const std::array<double, 2>&);
template PairEquations<3> row_equations(const PairModel&, const StartPlaces&, const PairNode&, const PairShared&,
                                        const PairSharedCovariance*, const std::array<double, 2>&);

}  // namespace rollfix::belief
