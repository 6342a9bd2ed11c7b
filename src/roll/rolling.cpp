#include <fmt/format.h>
#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "log/wrapping.hpp"
#include "roll/motion.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"

// Notation:
//   omega, omega_p  angular velocities of a finger and of the part; as the part sees it the finger turns by omega -
//                   omega_p
//   s, Theta        the contact on the part and the tangent's angle there, psi how far the finger has turned
//   (X, phi)        the part's pose at a row; c: a finger's centre in its frame, X + R(phi) c in the world
// Follows eqs. (1) and (2) of the paper: each finger is rolled as the part sees it, from its own plan, and what its
// sensors say in the world follows from the part's poses. Of these a velocity is given of the part or of finger a's
// centre.
namespace rollfix {
namespace {

// Beyond this a log holds more laps than anybody rolls, and too few digits of each.
constexpr double kMostLaps = 1e5;

/// Each throws InputError that names the number: not finite, 0, or not above 0.
void require_finite(double value, const char* what) {
  if (!std::isfinite(value)) throw InputError(fmt::format("expected a finite {} of a roll, found {}", what, value));
}

void require_not_zero(double value, const char* what) {
  require_finite(value, what);
  if (value == 0) throw InputError(fmt::format("expected a {} of a roll other than 0: nothing would move", what));
}

void require_positive(double value, const char* what) {
  if (value > 0 && std::isfinite(value)) return;
  throw InputError(fmt::format("expected a {} of a roll above 0, found {}", what, value));
}

/// Throws InputError unless exactly one of distance, rotation and duration says where the roll ends, in finite numbers.
void require_consistent(const RollPlan& plan) {
  const int ends = (plan.distance ? 1 : 0) + (plan.rotation ? 1 : 0) + (plan.duration ? 1 : 0);
  if (ends != 1) {
    throw InputError(
        fmt::format("expected exactly one of distance, rotation and duration of a roll, found {} of them", ends));
  }
  if (plan.duration.has_value() != static_cast<bool>(plan.omega)) {
    throw InputError(
        "expected an angular velocity by time together with the duration of a roll, and neither with a distance or a "
        "rotation: those take a constant speed");
  }
  if (plan.distance) require_not_zero(*plan.distance, "distance");
  if (plan.rotation) require_not_zero(*plan.rotation, "rotation");
  if (plan.duration) require_positive(*plan.duration, "duration");
  require_positive(plan.speed, "speed");
  require_finite(plan.start, "start");
  require_finite(plan.psi, "orientation psi at the start");
  if (plan.rows < 2) throw InputError(fmt::format("expected at least 2 rows of a log, found {}", plan.rows));
}

/// The largest change of N per length of the finger, off its corners: 1 / r of a disk, 0 of a jaw.
double turn_per_length(const Finger& finger) { return finger.turn_per_u() / finger.length_per_u(); }

/// Where the roll sets off to, +1 or -1. A profile may begin at rest.
int direction_of(const RollPlan& plan) {
  if (plan.distance) return *plan.distance < 0 ? -1 : 1;
  if (plan.rotation) return *plan.rotation < 0 ? -1 : 1;
  // The first of 65 instants at which the finger turns; none: forwards.
  constexpr int kLooks = 64;
  double omega = 0;
  for (int k = 0; k <= kLooks && omega == 0; ++k) omega = plan.omega(*plan.duration * k / kLooks);
  return omega < 0 ? -1 : 1;
}

/// How far the finger turns on the way.
double rotation_of(const Track& track, const RollPlan& plan, const TrackPlace& start, double start_angle) {
  if (plan.rotation) return *plan.rotation;
  // On the stretch that it arrives on: at a corner the pivot is still ahead.
  const TrackPlace stop = track.place(start.s + *plan.distance, *plan.distance > 0 ? -1 : 1);  // as it arrives
  const double stop_angle = track.turning(track.stretch(stop.index), stop.s).angle;
  // Over falls the finger turns back, which Track::rotation has in its values; the plan's turn is without them.
  return track.rotation(track.stretch(stop.index), stop.s, stop_angle) -
         track.rotation(track.stretch(start.index), start.s, start_angle) - track.fall_between(start.index, stop.index);
}

/// rad/s by time in seconds
using Rate = std::function<double(double)>;

/// The plan gives both fingers' distances, not their angular velocities by time.
bool is_by_distances(const FreePlan& plan) { return plan.fingers[0].distance.has_value(); }

/// Throws InputError unless the plan gives both distances or both angular velocities, and what goes with them.
void require_consistent(const FreePlan& plan) {
  const int distances = (plan.fingers[0].distance ? 1 : 0) + (plan.fingers[1].distance ? 1 : 0);
  const int omegas = (plan.fingers[0].omega ? 1 : 0) + (plan.fingers[1].omega ? 1 : 0);
  // Both fingers the same way: either how far they roll, or how fast they turn.
  if (distances + omegas != 2 || distances * omegas != 0) {
    throw InputError(
        fmt::format("expected a distance for both fingers or an angular velocity by time for both, found {} distances "
                    "and {} angular velocities",
                    distances, omegas));
  }
  if (omegas == 2 && !plan.duration) {
    throw InputError("expected a duration together with the fingers' angular velocities, found none");
  }
  if (omegas == 2 && plan.part_rotation != 0) {
    throw InputError(
        "expected the part's angular velocity by time together with the fingers', found a rotation, "
        "which goes with distances");
  }
  if (distances == 2 && plan.omega_part) {
    throw InputError(
        "expected the part's rotation together with the fingers' distances, found an angular velocity by time");
  }
  // Each of them says where everything is; together they would contradict each other.
  if (plan.velocity_a && plan.velocity_part) {
    throw InputError("expected the velocity of finger a's centre or the part's, found both");
  }
  if (distances == 2 && *plan.fingers[0].distance == 0 && *plan.fingers[1].distance == 0) {
    throw InputError("expected a distance other than 0 of one finger at least, found 0 of both");
  }
  if (plan.duration && !(*plan.duration > 0 && std::isfinite(*plan.duration))) {
    throw InputError(fmt::format("expected a duration of a roll above 0, found {}", *plan.duration));
  }
  if (!(plan.speed > 0 && std::isfinite(plan.speed))) {
    throw InputError(fmt::format("expected a speed of a roll above 0, found {}", plan.speed));
  }
  if (!std::isfinite(plan.part_rotation)) {
    throw InputError(fmt::format("expected a finite rotation of the part, found {}", plan.part_rotation));
  }
  if (!std::isfinite(plan.pose.x) || !std::isfinite(plan.pose.y) || !std::isfinite(plan.pose.heading)) {
    throw InputError(fmt::format("expected a finite pose of the part at the start, found {}, {}, {}", plan.pose.x,
                                 plan.pose.y, plan.pose.heading));
  }
}

/// The finger's angular velocity as the part sees it: what stands in the numerators of eqs. (1) and (2).
Rate against_part(const Rate& omega, const Rate& omega_part) {
  if (!omega_part) return omega;
  return [omega, omega_part](double time) { return omega(time) - omega_part(time); };
}

/// The motion of a finger that stays where it is on the part.
Motion resting(const Track& track, RollPlan plan) {
  // Where an open part ends the only stretch to rest on lies behind.
  const double ahead = !track.part().closed() && plan.start >= track.part().perimeter() ? -1 : 1;
  plan.duration = 1;
  plan.omega = [ahead](double /*time*/) { return ahead; };
  Motion motion = plan_motion(track, plan);
  // The velocity stays 0: the plan's omega only said on which side of a corner it rests.
  motion.omega = nullptr;
  return motion;
}

/// One finger's motion as the part sees it.
Motion motion_against_part(const Track& track, const FreeFinger& finger, const FreePlan& plan) {
  RollPlan roll;
  roll.start = finger.start;
  // In the part's frame, in which the part is at rest and one finger rolls as `roll` has it.
  roll.psi = finger.psi - plan.pose.heading;
  roll.u = finger.u;
  roll.rows = plan.rows;
  if (!is_by_distances(plan)) {
    roll.duration = plan.duration;
    roll.omega = against_part(finger.omega, plan.omega_part);
    return plan_motion(track, roll);
  }
  // A contact that stays: plan_motion takes no distance of 0.
  if (*finger.distance == 0) return resting(track, roll);
  roll.distance = finger.distance;
  return plan_motion(track, roll);
}

/// Two even motions at once: both last as long as the longer one at the plan's speed, or as the plan says.
void share_duration(Motion& a, Motion& b, const FreePlan& plan) {
  const double rotation_a = a.velocity * a.duration;
  const double rotation_b = b.velocity * b.duration;
  // Without a duration, the finger that turns further goes at the plan's speed.
  const double longest = std::max(std::abs(rotation_a), std::abs(rotation_b));
  a.duration = b.duration = plan.duration.value_or(longest / plan.speed);
  a.velocity = rotation_a / a.duration;
  b.velocity = rotation_b / b.duration;
}

/// phi at each row: the start's, and the integral of omega_p; with distances an even share of part_rotation.
std::vector<double> headings_of(const FreePlan& plan, const std::vector<double>& times) {
  std::vector<double> headings(times.size());
  if (plan.omega_part) headings = integrals(plan.omega_part, times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (is_by_distances(plan)) headings[k] = plan.part_rotation * (times[k] / times.back());
    headings[k] += plan.pose.heading;
  }
  return headings;
}

/// How far something with this velocity has come at each of the times.
std::vector<Vec2> displacements(const std::function<Vec2(double)>& velocity, const std::vector<double>& times) {
  // no velocity: it stays
  std::vector<Vec2> result(times.size(), Vec2::Zero());
  if (!velocity) return result;
  const std::vector<double> x = integrals([&](double time) { return velocity(time).x(); }, times);
  const std::vector<double> y = integrals([&](double time) { return velocity(time).y(); }, times);
  for (std::size_t k = 0; k < times.size(); ++k) result[k] = {x[k], y[k]};
  return result;
}

/// One finger's roll as the part sees it.
struct Rolling {
  /// in the part's frame, as are the states
  std::shared_ptr<const Track> way;
  Motion motion;
  std::vector<RollState> states;

  const Track& track() const { return *way; }
  /// c, the finger's centre at a row, in the part's frame.
  Vec2 centre(std::size_t row) const {
    return centre_of(track().finger(), track().part().point(states[row].s), states[row].contact);
  }
};

/// The part's pose at each row: phi from headings_of, X from the velocity that is given. With finger a's it is
/// X + R(phi) c = c_0 + a's way; without any velocity finger a's centre stays.
std::vector<Pose> poses_of(const FreePlan& plan, const Rolling& a, const std::vector<double>& times) {
  const std::vector<double> headings = headings_of(plan, times);
  const std::vector<Vec2> moved = displacements(plan.velocity_part ? plan.velocity_part : plan.velocity_a, times);
  // finger a's centre in the world at the start
  const Vec2 centre = plan.pose.world(a.centre(0));
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < times.size(); ++k) {
    Pose pose{0, 0, headings[k]};
    const Vec2 origin = plan.velocity_part ? Vec2(plan.pose.x, plan.pose.y) + moved[k]
                                           : Vec2(centre + moved[k] - pose.turned(a.centre(k)));
    pose.x = origin.x();
    pose.y = origin.y();
    poses.push_back(pose);
  }
  return poses;
}

std::string name_of_roll(const Part& part) { return "the roll on " + part.name(); }

/// What the finger's sensors say in the world, where the part is at these poses; none: it is at rest there.
FingerRows rows_of(const Rolling& rolling, const FreeFinger& finger, const std::vector<Pose>& poses) {
  // x, y and psi are of the finger's frame; in the world by the part's pose at that row.
  FingerRows rows;
  rows.u_period = rolling.track().finger().period();
  // psi at the first contact, in the part's frame
  const double first_psi = rolling.motion.first.psi;
  for (std::size_t k = 0; k < rolling.states.size(); ++k) {
    const Contact& contact = rolling.states[k].contact;
    Vec2 centre = rolling.centre(k);
    double psi = contact.psi;
    if (!poses.empty()) {
      // psi in the world: that in the part's frame, and the heading. A disk's is planned; of another finger psi follows
      // from u at the first contact.
      const double start = finger.finger.is_disk() ? finger.psi : first_psi + poses[0].heading;
      psi = start + (contact.psi - first_psi) + (poses[k].heading - poses[0].heading);
      centre = poses[k].world(centre);
    }
    rows.u.push_back(contact.u);
    rows.psi.push_back(psi);
    rows.x.push_back(centre.x());
    rows.y.push_back(centre.y());
  }
  require_readable(rows, name_of_roll(rolling.track().part()));
  return rows;
}

/// Where the finger is on the part, of each row.
void add_places(Roll& roll, std::size_t finger, const Rolling& rolling) {
  for (const RollState& state : rolling.states) {
    roll.s[finger].push_back(state.s);
    roll.angle[finger].push_back(state.angle);
  }
}

}  // namespace

/// One finger on a part at rest, whose frame is the world's.
Roll roll_with(Solve solve, const Part& part, const Finger& finger, const RollPlan& plan) {
  // The way of the contact first, then the plan on it, the states at equal times, and what the sensors say of them.
  Rolling rolling{track_of(part, finger, plan.start, plan.u), {}, {}};
  rolling.motion = plan_motion(rolling.track(), plan);
  Roll roll;
  roll.log.name = name_of_roll(part);
  roll.log.unit = part.unit();
  roll.log.time = times_of(rolling.motion, plan.rows);
  rolling.states = solve(rolling.track(), rolling.motion, roll.log.time);
  roll.log.fingers[0] = rows_of(rolling, {}, {});
  add_places(roll, 0, rolling);
  return roll;
}

/// Two fingers: each is rolled in the part's frame alone; the part's poses then put both into the world.
Roll roll_with(Solve solve, const Part& part, const FreePlan& plan) {
  require_consistent(plan);
  std::vector<Rolling> both(2);
  for (std::size_t k = 0; k < 2; ++k) {
    const FreeFinger& finger = plan.fingers[k];
    naming(kFingerNames[k], [&] {
      both[k].way = track_of(part, finger.finger, finger.start, finger.u);
      both[k].motion = motion_against_part(both[k].track(), finger, plan);
    });
  }
  // By distances both last equally long; by angular velocities both have the plan's duration already.
  if (is_by_distances(plan)) share_duration(both[0].motion, both[1].motion, plan);
  Roll roll;
  roll.log.name = name_of_roll(part);
  roll.log.unit = part.unit();
  roll.log.time = times_of(both[0].motion, plan.rows);
  for (std::size_t k = 0; k < 2; ++k) {
    naming(kFingerNames[k], [&] { both[k].states = solve(both[k].track(), both[k].motion, roll.log.time); });
  }
  // Of the fingers only a tells where the part is: the plan moves its centre, or the part itself.
  roll.pose = poses_of(plan, both[0], roll.log.time);
  roll.log.fingers.resize(2);
  roll.s = roll.angle = PerFinger<std::vector<double>>::of(2);
  for (std::size_t k = 0; k < 2; ++k) {
    naming(kFingerNames[k], [&] { roll.log.fingers[k] = rows_of(both[k], plan.fingers[k], roll.pose); });
    add_places(roll, k, both[k]);
  }
  return roll;
}

Motion plan_motion(const Track& track, const RollPlan& plan) {
  require_consistent(plan);
  const double perimeter = track.part().perimeter();
  if (plan.distance && std::abs(*plan.distance) > kMostLaps * perimeter) {
    throw InputError(fmt::format("expected a roll of at most {:g} times the perimeter, found {:.9g}", kMostLaps,
                                 std::abs(*plan.distance) / perimeter));
  }
  Motion motion;
  // The first lap's place; the rest of the roll is unwrapped from there.
  const double start = track.part().closed() ? wrap(plan.start, perimeter).base : plan.start;
  // Before anything is solved, so that an error names the tightest place of the whole way.
  if (plan.distance) track.require_way(start, start + *plan.distance);
  motion.start = track.place(start, direction_of(plan));
  // One-sided: at a corner Theta on the side on which the roll leaves.
  motion.start_angle = track.turning(track.stretch(motion.start.index), motion.start.s).angle;
  motion.first = track.first_contact(motion.start, motion.start_angle, plan.psi);
  // The turn follows from omega, row by row; how far the contact goes is known only then.
  if (plan.omega) {
    motion.duration = *plan.duration;
    motion.omega = plan.omega;
    return motion;
  }
  const double rotation = rotation_of(track, plan, motion.start, motion.start_angle);
  // kMostLaps laps turn the finger by its own normal's change over the perimeter, and by the part's turn of 2 pi each.
  const double most = kMostLaps * (perimeter * turn_per_length(track.finger()) + 2 * std::numbers::pi);
  if (!(std::abs(rotation) <= most)) {
    throw InputError(
        fmt::format("expected a roll that turns the finger by at most {:g} rad, {:g} times around the "
                    "part, found {:.9g}",
                    most, kMostLaps, rotation));
  }
  // An even rotation: as fast as the plan's speed, in the direction of the rotation.
  motion.duration = std::abs(rotation) / plan.speed;
  motion.velocity = std::copysign(plan.speed, rotation);
  return motion;
}

std::vector<double> times_of(const Motion& motion, std::size_t rows) {
  std::vector<double> times(rows);
  const auto last = static_cast<double>(rows - 1);
  // The last is k / last = 1: the duration itself.
  for (std::size_t k = 0; k < rows; ++k) times[k] = motion.duration * (static_cast<double>(k) / last);
  return times;
}

/// Interval by interval, so that each sum is the one before and one quadrature more.
std::vector<double> integrals(const std::function<double(double)>& rate, const std::vector<double>& times) {
  constexpr unsigned kMostHalvings = 10;
  constexpr double kRelative = 1e-12;
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;
  std::vector<double> sums(times.size());
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double step = times[k] - times[k - 1];
    // Over [0, 1]: over a short interval it would take its own rounding for an error and halve on and on.
    const auto share = [&](double x) { return step * rate(times[k - 1] + x * step); };
    sums[k] = sums[k - 1] + Quadrature::integrate(share, 0.0, 1.0, kMostHalvings, kRelative);
  }
  return sums;
}

Roll roll(const Part& part, const Finger& finger, const RollPlan& plan) {
  return roll_with(&states_of, part, finger, plan);
}

Roll roll_free(const Part& part, const FreePlan& plan) { return roll_with(&states_of, part, plan); }

}  // namespace rollfix
