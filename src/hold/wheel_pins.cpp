#include "wheel_pins.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "hold_fit.hpp"
#include "outline/turn.hpp"
#include "rollfix/touch.hpp"

// Notation, as in docs/rig.md:
//   c(u)            the pin while the wheel touches at u: p + r n, touch::CentrePath
//   n, T            normal and tangent at the c that is nearest to a point x of the part's frame: `away`, `along`
//   q, p            a finger's contact in the world and on the part; p is within rho of the arc's middle: HeldFrom
//   C               the pin in the world; x = p + R(-phi)(C - q): `point`, where it is on the part; x - c: `off`
//   phi             the part's heading, within an arc: `middle`, `half`
//   Psi = Theta + t / r   what the wheel has turned against the part where it touches at t; be: its orientation
// A wheel that touches, and enters the part nowhere, has its pin on the boundary's offset as far as the disk reaches,
// with an arc about each convex corner. A pin that is measured is that far from it.
// Closure: x lies on the path of pins, within rho, what C and q may be off by, and |C - q| times the arc's half chord.
// Idea: if a point moves by m, its distance from the path changes by no more than m. At a corner, or while an arc of
// first contacts is long, phi is not known well. Its arc is halved until phi moves x by no more than x may be off.
namespace rollfix::hold {
namespace {

// A nearest place is settled to this share of the part's diagonal; its distance, to second order in that, is better.
constexpr double kPinUnit = 1e-4;
// Where an offset's part along the path is more than this share of the distance, the nearest place is an end of the
// path.
constexpr double kNoFoot = 1e-4;
// Within this share of the diagonal from the path, an offset along it is rounding.
constexpr double kOnPath = 1e-8;
constexpr std::size_t kMostStretches = 256;
// A descent from another row's place is that row's part of the path if it is no further than this share of the radius.
constexpr double kSameFoot = 0.2;

// Looks of one question. Beyond, what is left of the headings is not halved any more, and counts as possible sooner.
constexpr std::size_t kMostLooks = 4096;

}  // namespace

/// Theta + s / r grows by 2 pi k + P / r around a closed part.
WheelPath::WheelPath(const Part& part, double radius) : path_(part, radius) {
  if (is_empty()) return;
  tree_.emplace(path_);
  unit_ = kPinUnit * path_.diagonal();
  if (part.closed()) spin_period_ = std::abs(part.turning().period_turn() + part.perimeter() / radius);
}

touch::InPart WheelPath::seen(const Vec2& point) const {
  touch::InPart seen;
  seen.at = point;
  seen.place_unit = unit_;
  return seen;
}

/// The foot of the perpendicular from the point, or an end of the path. To first order in what the search left beside
/// the foot.
NearPin WheelPath::described(const Vec2& point, const touch::PathPlace& place) const {
  const touch::CentrePoint at = path_.at(place);
  const bool is_corner = path_.stretches()[place.stretch].corner;
  const Vec2 tangent(std::cos(at.angle), std::sin(at.angle)), normal(tangent.y(), -tangent.x());
  Vec2 off = point - at.centre;
  NearPin near;
  near.s = at.s;
  near.angle = at.angle;
  near.away = normal;
  near.distance = off.dot(normal);
  // 0 at a foot but for what the search left.
  const double beside = off.dot(tangent);
  const double pace = std::max(at.along.norm(), 1e-12);  // of the pin, per u
  // A point off the path whose offset has a part along it: the path ends there, where the wheel hits the part.
  const bool is_end = std::abs(beside) > kNoFoot * std::abs(near.distance) + kOnPath * path_.diagonal();
  if (is_end) {
    // The distance to the end itself, with the sign of the side; below 0 it grows against the offset.
    near.distance = std::copysign(off.norm(), near.distance);
    near.away = off / near.distance;
    return near;
  }
  near.along = tangent;
  // On a spiral kappa / (1 + r kappa), at a corner 1 / r. u is s on a spiral; at a corner s stays.
  near.turn_per_length = at.bend / pace;
  near.contact_per_length = is_corner ? 0 : 1 / pace;
  // The last step of the descent.
  near.s += beside * near.contact_per_length;
  near.angle += beside * near.turn_per_length;
  return near;
}

NearPin WheelPath::nearest(const Vec2& point) {
  return described(point, touch::nearest_place(*tree_, seen(point)).place);
}

/// A local search, accepted if it ends within kSameFoot of the radius; else the global one. `from` is where it ended.
NearPin WheelPath::nearest(const Vec2& point, std::optional<touch::PathPlace>& from) {
  if (from) {
    const touch::OnPath found = touch::downhill(path_, seen(point), {*from, path_.at(*from)});
    if ((found.point.centre - point).norm() <= kSameFoot * radius()) {
      from = found.place;
      return described(point, found.place);
    }
  }
  from = touch::nearest_place(*tree_, seen(point)).place;
  return described(point, *from);
}

/// Walks down the tree of discs. A disc farther from the point than its radius and `reach` holds nothing that counts.
std::optional<std::vector<PinStretch>> WheelPath::within(const Vec2& point, double reach) {
  std::vector<PinStretch> found;
  std::vector<std::int32_t> waiting{tree_->root()};
  while (!waiting.empty()) {
    const std::int32_t index = waiting.back();
    waiting.pop_back();
    const touch::PathTree::Node node = tree_->node(index);
    if ((node.middle - point).norm() > node.radius + reach) continue;
    // Pieces end at half the reach, or where they have no halves.
    const bool is_small = node.is_single() && node.radius <= 0.5 * reach;
    const auto [left, right] = is_small ? std::make_pair(index, index) : tree_->halves(index);
    if (left != right) {
      waiting.push_back(left);
      waiting.push_back(right);
      continue;
    }
    if (found.size() == kMostStretches) return std::nullopt;
    const touch::CentreStretch& stretch = path_.stretches()[static_cast<std::size_t>(node.stretch)];
    // About a corner u is the tangent's angle, and s is the corner's.
    found.push_back({stretch.corner ? Interval{stretch.s, stretch.s} : node.u,
                     {node.angle - node.half_turn, node.angle + node.half_turn}});
  }
  return found;
}

struct PinSearch::Question {
  std::size_t wheel = 0;
  std::size_t instant = 0;
  const HeldFrom& from;
  Vec2 arm;           // C - q
  double length = 0;  // of it
  double reach = 0;   // of x, but for the heading
  PinFound* found = nullptr;
};

/// `paths` has to outlive it.
PinSearch::PinSearch(const HeldRows& rows, const std::vector<std::size_t>& instants, const WheelPaths& paths)
    : has_noise_(rows.has_noise), wheels_(rows.wheels), paths_(paths) {
  for (const std::size_t row : instants) pins_.push_back(rows.rows[row].pins);
}

/// In length. With noise of x or y and of the radius, added: on the safe side. Without noise the tolerance.
double PinSearch::slack(std::size_t wheel) const {
  return has_noise_ ? kPossibleSigmas * (wheels_[wheel].place + wheels_[wheel].radius) : wheels_[wheel].place;
}

/// Beyond what follows from where the pin was: a wheel of another radius has turned otherwise.
double PinSearch::spin_slack(std::size_t wheel, std::size_t instant) const {
  const HeldWheel& one = wheels_[wheel];
  if (!has_noise_) return *one.spin;
  // The error of the radius enters t / r by as much as the wheel has turned.
  const double turned = std::abs(pins_[instant][wheel].spin - pins_.front()[wheel].spin) + 2 * std::numbers::pi;
  return kPossibleSigmas * (*one.spin + one.radius / one.wheel_radius * turned);
}

/// `heading` is an arc modulo a turn; its middle is taken to the lap of the finger's own heading, as encoders need
/// it.
bool PinSearch::may_touch(std::size_t wheel, std::size_t instant, const HeldFrom& from,
                          const touch::HeadingArc& heading, PinFound* found) {
  const Vec2 arm = pins_[instant][wheel].at - from.at;
  const Question question{wheel, instant, from, arm, arm.norm(), from.reach + slack(wheel), found};
  std::size_t left = kMostLooks;
  const double middle = from.heading + nearest_angle(heading.middle - from.heading);
  return look(question, middle, std::min(heading.half, std::numbers::pi), left);
}

/// Closure at all headings within `half` of `middle` at once. x moves by at most the chord 2 |C - q| sin(half / 2),
/// and the distance from the path by no more than x does: farther off than the reach no heading of them fits.
bool PinSearch::look(const Question& question, double middle, double half, std::size_t& left) {
  ++looks_;
  left -= left > 0 ? 1 : 0;
  const Vec2 point = question.from.point + Pose{0, 0, -middle}.turned(question.arm);
  const double reach = question.reach + 2 * question.length * std::sin(0.5 * half);
  if (std::abs(paths_[question.wheel]->nearest(point).distance) > reach) return false;
  // As long as the heading moves x by more than the reach, both halves of the arc are looked at. Without `found` one
  // that fits is enough.
  if (half * question.length > question.reach && left > 0) {
    const bool is_left = look(question, middle - 0.5 * half, 0.5 * half, left);
    if (is_left && question.found == nullptr) return true;
    return look(question, middle + 0.5 * half, 0.5 * half, left) || is_left;
  }
  // Closure is all that is asked.
  if (question.found == nullptr && !wheels_[question.wheel].line) return true;
  return keep_touching(question, middle, half, point, reach);
}

/// Keeps what of the path suits the wheel's other measurements.
bool PinSearch::keep_touching(const Question& question, double middle, double half, const Vec2& point, double reach) {
  const HeldWheel& wheel = wheels_[question.wheel];
  // All places where the wheel can touch if x is anywhere within reach.
  const auto stretches = paths_[question.wheel]->within(point, reach);
  // Too many to look at each: all of them count as possible, which loses nothing.
  if (!stretches) {
    if (question.found == nullptr) return true;
    question.found->any_spin = true;
    question.found->touching.push_back({paths_[question.wheel]->whole(), {}});
    return true;
  }
  bool is_any = false;
  // How far off C - q can be, in the world; the direction of it then by asin(off / |C - q|), or any.
  const double off = question.from.place + slack(question.wheel);
  const double line_slack = !wheel.line ? 0
                            : off >= question.length
                                ? std::numbers::pi
                                : (has_noise_ ? kPossibleSigmas : 1) * *wheel.line + std::asin(off / question.length);
  for (const PinStretch& one : *stretches) {
    if (wheel.line) {
      // Squeezed: C - q points along the wheel's outward normal, phi + Theta - pi / 2. Both q and C are measured in the
      // world, so that the arc of first contacts only adds the range of phi.
      const double towards = std::atan2(question.arm.y(), question.arm.x()) + 0.5 * std::numbers::pi;
      if (std::abs(nearest_angle(towards - middle - one.angle.middle())) >
          line_slack + half + 0.5 * one.angle.width()) {
        continue;
      }
    }
    is_any = true;
    if (question.found == nullptr) return true;
    question.found->touching.push_back(one);
    if (!wheel.spin) continue;
    // be0 = be - phi - Theta - t / r, with phi, Theta and t each anywhere in its interval.
    const double spin = pins_[question.instant][question.wheel].spin - middle;
    const double slack = half + spin_slack(question.wheel, question.instant);
    const double radius = wheel.wheel_radius;
    question.found->spins.push_back(
        {spin - one.angle.hi - one.s.hi / radius - slack, spin - one.angle.lo - one.s.lo / radius + slack});
  }
  return is_any;
}

// ---- in the fit
// Notation as in hold_fit.cpp and docs/rig.md:
//   C               a wheel's pin in the world, x on the part: `at`, `point`; c the nearest place of the path of pins
//   n, T            normal and tangent there; rho: how much larger the wheel is than said, be0: its encoder's zero
//   f1 = (x - c).n - rho                       closure
//   f2 = be - phi - (Theta + t / r) - be0      the encoder's, modulo what it grows by around the part
//   f3 = (direction of C - q) - (phi + Theta - pi / 2)   squeezed: the force goes through both contacts
// Follows docs/rig.md.
// Idea: where the wheel touches follows from its pin, so that a wheel adds equations and no unknown contact.

namespace {

constexpr double kPivots = 10;   // times the angle's error: a corner that turns so far on both sides leaves ways to lie
constexpr int kPivotLooks = 48;  // headings of a pivot to start from, ...
constexpr int kFacingLooks = 16;    // ... and of a finger that is on no corner
constexpr double kFacingReach = 3;  // standard deviations of its normal

/// value less whole periods, nearest to 0.
double nearest_in(double value, double period) {
  return period > 0 ? value - period * std::round(value / period) : value;
}

}  // namespace

/// Where a wheel touches in this pose: the place of the path of pins nearest to its pin. With noise from where it was
/// found last for this row and wheel, else globally.
NearPin HoldFit::near_pin(const HeldState& state, std::size_t row, std::size_t wheel) const {
  const Placed& placed = state.placed[row];
  // x = m + R(-phi) (C - A).
  const Vec2 point = middle_ + Pose{0, 0, -placed.heading}.turned(rows_.rows[row].pins[wheel].at - placed.middle);
  if (!rows_.has_noise) return wheels_[wheel]->nearest(point);
  return wheels_[wheel]->nearest(point, feet_[row * rows_.wheels.size() + wheel]);
}

/// The part's heading at a row, unwrapped over all rows: the first finger's tangents say how often the part went
/// round. Encoders need it, as their period is not a whole turn.
double HoldFit::unwrapped_heading(const HeldState& state, std::size_t row) const {
  const double s = place_of(state, row, 0);
  const Boundary boundary = part_.boundary();
  const double angle = part_.turning().angle(boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter));
  // tau is unwrapped over the rows, and so is Theta over laps: their difference has the laps of phi.
  const double about = rows_.rows[row].contacts[0].tangent - angle;
  return about + nearest_angle(state.placed[row].heading - about);
}

/// be - phi - Psi: the encoder's zero, as one row has it.
double HoldFit::spin_of(const HeldState& state, std::size_t row, std::size_t wheel, const NearPin& near) const {
  return rows_.rows[row].pins[wheel].spin - unwrapped_heading(state, row) - near.angle -
         near.s / rows_.wheels[wheel].wheel_radius;
}

/// A wheel's residuals f1, f2 and f3 at a row, with derivatives by A, phi and the wheel's own unknowns. The wheel's
/// place follows from its pin: all three move with it.
HoldFit::PinLook HoldFit::pin_look(const HeldState& state, std::size_t row, std::size_t wheel) const {
  const HeldWheel& one = rows_.wheels[wheel];
  const HeldPin& pin = rows_.rows[row].pins[wheel];
  const Placed& placed = state.placed[row];
  PinLook look;
  const NearPin near = look.near = near_pin(state, row, wheel);
  const Pose turn{0, 0, placed.heading};
  const Vec2 arm = pin.at - placed.middle;
  // d x = -R(-phi) dA - J R(-phi) (C - A) dphi, seen along n and T.
  const auto by_pose = [&](const Vec2& direction) {
    const Vec2 world = turn.turned(direction);
    return Eigen::RowVector3d(-world.x(), -world.y(), world.x() * arm.y() - world.y() * arm.x());
  };
  const double times = weight(row, fingers() + wheel) * rows_.rows[row].weight;
  // f1: x moves off the path along n, while moves along T change it to second order only.
  look.residual(0) = near.distance;
  look.by_pose.row(0) = by_pose(near.away);
  look.information(0) = times / (one.place * one.place);
  look.log_size = -std::log(look.information(0));
  // A wheel that is rho larger has its pin rho farther out.
  if (const auto at = radius_unknown(wheel)) {
    look.residual(0) -= state.unknowns(*at);
    look.by_radius = -1;
  }
  if (one.spin) {
    // f2. Theta + t / r grows by 1 / r per length of the pin's path, on spirals and at corners alike:
    // (kappa + 1 / r) / (1 + r kappa) = 1 / r.
    const double zero = state.unknowns(*spin_unknown(wheel));
    look.residual(1) = nearest_in(spin_of(state, row, wheel, near) - zero, wheels_[wheel]->spin_period());
    look.by_pose.row(1) = -by_pose(near.along) / one.wheel_radius - Eigen::RowVector3d(0, 0, 1);
    look.by_spin = -1;
    // Another radius turns the wheel otherwise over what it has rolled; rho is not followed here, its variance is
    // added.
    const double turned = one.radius / one.wheel_radius * (pin.spin - rows_.rows.front().pins[wheel].spin);
    // Where the wheel touches is known as well as the pin.
    const double beside = rows_.has_noise ? one.place / one.wheel_radius : 0;
    const double variance = *one.spin * *one.spin + turned * turned + beside * beside;
    look.information(1) = times / variance;
    look.log_size -= std::log(look.information(1));
  }
  if (one.line) {
    // f3. q and C are in the world: only phi and Theta change with the pose.
    const Vec2 way = pin.at - rows_.rows[row].contacts[0].at;
    look.residual(2) =
        nearest_angle(std::atan2(way.y(), way.x()) - placed.heading - near.angle + 0.5 * std::numbers::pi);
    look.by_pose.row(2) = -near.turn_per_length * by_pose(near.along) - Eigen::RowVector3d(0, 0, 1);
    // The direction of C - q by the errors of both places, across it.
    const double beside = rows_.has_noise ? std::numbers::sqrt2 * one.place / way.norm() : 0;
    look.information(2) = times / (one.line_alike * *one.line * *one.line + beside * beside);
    look.log_size -= std::log(look.information(2));
  }
  return look;
}

/// Adds a wheel to its row's normal equations. The residuals are independent of one another: W is diagonal.
void HoldFit::add_pin(const HeldState& state, std::size_t row, std::size_t wheel, bool with_unknowns,
                      RowEquations& sum) const {
  const PinLook one = pin_look(state, row, wheel);
  const Eigen::Matrix3d weighed = one.by_pose.transpose() * one.information.asDiagonal();
  sum.pose += weighed * one.by_pose;
  sum.slope -= weighed * one.residual;
  const double square = one.residual.dot(one.information.cwiseProduct(one.residual));
  sum.square += square;
  sum.right_square += square;
  sum.log_size += one.log_size;
  if (!with_unknowns) return;
  // An unknown that enters one residual alone, with derivative `by`.
  const auto add = [&](std::optional<Eigen::Index> at, Eigen::Index residual, double by) {
    if (!at) return;
    sum.mixed.col(*at) += by * weighed.col(residual);
    sum.own(*at, *at) += by * by * one.information(residual);
    sum.own_slope(*at) -= by * one.information(residual) * one.residual(residual);
  };
  add(radius_unknown(wheel), 0, one.by_radius);
  add(spin_unknown(wheel), 1, one.by_spin);
}

/// Headings of the part that the finger's contact allows, evenly spaced: all over a corner's turn, and with noise as
/// far beyond as its normal may be off. Empty without noise off corners: there the normal gives the heading. The only
/// finger is meant.
std::vector<HoldFit::Facing> HoldFit::facings(const HeldState& state, std::size_t row) const {
  const Placed& placed = state.placed[row];
  const HeldErrors& errors = rows_.errors[0];
  const HeldContact& contact = rows_.rows[row].contacts[0];
  const double place = place_of(state, row, 0);
  const BlurredPlace range = ranged(part_, place, (rows_.has_noise ? 3 : 1) * errors.travel);
  std::vector<Facing> facings;
  // Theta is open by much more than its measurement is off: the finger may be on a corner.
  const bool pivots = range.half_turn >= kPivots * errors.angle;
  if (!pivots && !rows_.has_noise) return facings;
  const double off = rows_.has_noise ? std::hypot(errors.angle, contact.finger_curvature * errors.travel) : 0;
  const double reach = range.half_turn + kFacingReach * off;
  const Pose before{0, 0, placed.heading};
  const Vec2 point = point_about(part_, place);
  // The contact keeps its place in the world while the part turns about it.
  const Vec2 touched = placed.middle + before.turned(point - middle_);
  const int looks = pivots ? kPivotLooks : kFacingLooks;
  for (int k = 0; k <= looks; ++k) {
    facings.push_back(faced(row, point, touched, contact.tangent - range.angle + reach * (2.0 * k / looks - 1)));
  }
  return facings;
}

/// The part turned to a heading about where the finger touches it.
HoldFit::Facing HoldFit::faced(std::size_t row, const Vec2& point, const Vec2& touched, double heading) const {
  Facing one;
  one.placed = {touched - Pose{0, 0, heading}.turned(point - middle_), heading};
  for (std::size_t wheel = 0; wheel < rows_.wheels.size(); ++wheel) {
    const Pose back{0, 0, -heading};
    const Vec2 pin = middle_ + back.turned(rows_.rows[row].pins[wheel].at - one.placed.middle);
    // 0 where every wheel touches.
    one.off += std::abs(wheels_[wheel]->nearest(pin).distance);
  }
  return one;
}

/// Poses of a row in which the wheels touch better than in the poses beside them: where fits of it start.
std::vector<Placed> HoldFit::touching(const HeldState& state, std::size_t row) const {
  const std::vector<Facing> all = facings(state, row);
  std::vector<Placed> found;
  for (std::size_t k = 0; k < all.size(); ++k) {
    // Minima of `off` over the headings, ends included; of two equal neighbours the first.
    const bool falls = k == 0 || all[k].off < all[k - 1].off;
    const bool rises = k + 1 == all.size() || all[k].off <= all[k + 1].off;
    if (falls && rises) found.push_back(all[k].placed);
  }
  return found;
}

/// Where the finger may be on a corner: the part at the heading at which all wheels touch best.
void HoldFit::face_wheels(HeldState& state, std::size_t row) const {
  const double reach = (rows_.has_noise ? 3 : 1) * rows_.errors[0].travel;
  if (ranged(part_, place_of(state, row, 0), reach).half_turn < kPivots * rows_.errors[0].angle) return;
  state.placed[row] = std::ranges::min(facings(state, row), {}, &Facing::off).placed;
}

/// The state, and the state with each other pose of this row that fits about as well: its square larger by no more
/// than kFitsToo. Several fingers leave a row one pose.
std::vector<HeldState> HoldFit::poses_of(const HeldState& state, std::size_t row) const {
  std::vector<HeldState> found{state};
  if (fingers() > 1 || wheels() == 0) return found;
  const std::vector<Placed> all = touching(state, row);
  if (all.empty()) return found;
  // All else stays, so that a pose costs what its row costs more.
  const RowEquations here = equations(state, row, sights_at(state, row), false);
  for (const Placed& placed : all) {
    HeldState other = state;
    other.placed[row] = placed;
    const RowEquations there = settled(other, row);
    const double more = there.square - here.square;
    if (more > kFitsToo) continue;
    const double same = kSamePose * std::sqrt(pose_at(other, row).covariance(2, 2));
    // Starts may settle in one and the same pose.
    const bool is_known = std::any_of(found.begin(), found.end(), [&](const HeldState& one) {
      return std::abs(nearest_angle(one.placed[row].heading - other.placed[row].heading)) < same;
    });
    if (is_known) continue;
    other.square += more;
    other.cost += more;
    other.right_square += there.right_square - here.right_square;
    found.push_back(std::move(other));
  }
  return found;
}

/// With noise poses follow from one another over all rows; without, those of the first and of the last row are
/// combined.
std::vector<HeldState> HoldFit::poses_at_ends(const HeldState& state) const {
  const std::size_t last = rows_.rows.size() - 1;
  if (rows_.has_noise && fingers() == 1 && wheels() > 0 && last > 0) return paths(state);
  std::vector<HeldState> found = poses_of(state, 0);
  if (last == 0) return found;
  std::vector<HeldState> both;
  for (const HeldState& first : found) {
    for (HeldState& one : poses_of(first, last)) both.push_back(std::move(one));
  }
  return both;
}

/// Sets each encoder's zero to the mean of what the first `rows` rows say.
void HoldFit::zero_spins(HeldState& state, std::size_t rows) const {
  for (std::size_t wheel = 0; wheel < rows_.wheels.size(); ++wheel) {
    const std::optional<Eigen::Index> at = spin_unknown(wheel);
    if (!at) continue;
    const double period = wheels_[wheel]->spin_period();
    // The mean of angles modulo the period: each as near to the first as can be.
    const double first = spin_of(state, 0, wheel, near_pin(state, 0, wheel));
    double off = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      off += nearest_in(spin_of(state, row, wheel, near_pin(state, row, wheel)) - first, period);
    }
    state.unknowns(*at) = first + off / static_cast<double>(rows);
  }
}

/// The largest of a wheel's residuals at a row, over its tolerance.
double HoldFit::worst_of_wheel(const HeldState& state, std::size_t row, std::size_t wheel) const {
  const PinLook one = pin_look(state, row, wheel);
  const HeldWheel& errors = rows_.wheels[wheel];
  double most = std::abs(one.residual(0)) / errors.place;
  if (errors.spin) most = std::max(most, std::abs(one.residual(1)) / *errors.spin);
  if (errors.line) most = std::max(most, std::abs(one.residual(2)) / *errors.line);
  return most;
}

ContactResidual HoldFit::wheel_residual(const HeldState& state, std::size_t row, std::size_t wheel) const {
  const PinLook one = pin_look(state, row, wheel);
  ContactResidual result;
  result.place = {one.residual(0), 0};
  result.turn = rows_.wheels[wheel].spin ? one.residual(1) : 0;
  return result;
}

/// t at a row, and its derivative by the pose's x, y and heading: through the pin's move along T. At a corner t
/// stays.
HoldFit::WheelAt HoldFit::wheel_at(const HeldState& state, std::size_t row, std::size_t wheel) const {
  const NearPin near = near_pin(state, row, wheel);
  const Pose pose = pose_at(state, row).pose;
  const Vec2 arm = rows_.rows[row].pins[wheel].at - Vec2(pose.x, pose.y);
  const Vec2 world = Pose{0, 0, pose.heading}.turned(near.along);
  WheelAt result;
  result.s = near.s;
  result.by_pose =
      near.contact_per_length * Eigen::RowVector3d(-world.x(), -world.y(), world.x() * arm.y() - world.y() * arm.x());
  result.variance = std::pow(near.contact_per_length * rows_.wheels[wheel].place, 2);
  return result;
}

}  // namespace rollfix::hold
