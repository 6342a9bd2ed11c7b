#include "held_rows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "belief/nodes.hpp"
#include "belief/posterior.hpp"
#include "log/jitter.hpp"

// Notation, as in docs/two_fingers.md, "Three and more fingers":
//   L_i(t)          what contact i has travelled on the part since the first row: `travelled`
//   tau_i(t)        direction of the part's tangent at contact i in the world: `tangent`
//   q_i(t)          the contact in the world: `at`, x and y and from there by the finger's own shape, `lever`
//   lot             rows that go together as their mean, as if measured in its middle: `means`, `middles_of`
// Idea: u and psi say where on the finger the contact is and how that points, so that a finger of any shape is its
// contact. An error n of the contact along the boundary moves q along the tangent by n and L by n: on the part both are
// the same place, so that n is only seen in the normal.
// Of one finger beside wheels rows between the first and the last one go together, as few means as even motion allows:
// belief/nodes.hpp.
namespace rollfix::hold {
namespace {

// Centres and lengths are known to this share of the perimeter at best, an outline's own accuracy, and angles to so
// many radians. No error that residuals are divided by is 0.
constexpr double kLeastHeldPlace = 1e-6;
constexpr double kLeastHeldTravel = 1e-9;
constexpr double kLeastHeldAngle = 1e-9;  // radians
// A row is at the same corner as another if both contacts are within so many standard deviations of one another.
constexpr double kAlikeSigmas = 3;
constexpr std::size_t kRobustInstants = 15;  // in place of kHoldInstants: of some a measurement may be an outlier

/// The radius's error as one of all lengths, per length: a disk's lengths are r times angles. 0 of other fingers.
double radius_share(const Noise& noise, const Finger& finger) {
  return finger.is_disk() ? noise.radius / finger.disk()->radius : 0;
}

/// Standard deviations of one finger; those of travel and of angle are above 0. `noise`: with the outline's own
/// accuracy in `part`. x and y are evidence only if the noise has a position.
HeldErrors errors_with(const Noise& noise, const Finger& finger, bool has_centre, double perimeter) {
  HeldErrors errors;
  errors.has_place = has_centre && noise.position > 0;
  errors.travel = std::max(noise.contact, kLeastHeldTravel * perimeter);
  errors.stretch = std::hypot(noise.slip, radius_share(noise, finger), noise.part.length);
  if (errors.stretch > 0) errors.arm_share = std::pow(radius_share(noise, finger) / errors.stretch, 2);
  errors.angle = std::hypot(std::max(noise.angle, kLeastHeldAngle), noise.part.turn);
  errors.place = noise.position;
  return errors;
}

/// Tolerances of one finger, without noise: by the digits of its log, or as the problem states them.
HeldErrors errors_by_digits(const HoldProblem& problem, const Log& log, const Finger& finger) {
  const FingerRows& rows = log.fingers.front();
  const double perimeter = problem.part.perimeter();
  const Rounding rounding = rounding_of(log, {finger});
  HeldErrors errors;
  errors.has_place = !rows.x.empty();
  errors.travel = std::max(rounding.length, kLeastHeldTravel * perimeter);
  errors.angle = std::max(rounding.turn, kLeastHeldAngle);
  std::vector<double> coordinates = rows.x;
  coordinates.insert(coordinates.end(), rows.y.begin(), rows.y.end());
  if (errors.has_place) {
    errors.place =
        std::numbers::sqrt2 * rounding_of_column(coordinates) + rounding.length + kLeastHeldPlace * perimeter;
  }
  // A stated tolerance replaces the digits'; a length of 0 in it leaves theirs.
  if (!problem.tolerance) return errors;
  errors.angle = std::max(problem.tolerance->angle, kLeastHeldAngle);
  if (problem.tolerance->length > 0) errors.place = problem.tolerance->length;
  return errors;
}

/// How much too near to the centre a contact is on average, in the world: its normal is measured, and an error turns
/// the arm, by n along the finger and by a of the orientation: r (1 - cos) of a disk. To second order.
Vec2 too_near(const HeldContact& contact, double normal, const HeldErrors& errors) {
  const Vec2 outward(std::cos(normal), std::sin(normal));
  return 0.5 * (errors.travel * errors.travel * contact.finger_curvature * outward +
                errors.angle * errors.angle * contact.lever);
}

/// Appends one finger's contact to each row.
void add_contacts(const Log& log, const Finger& finger, HeldRows& held) {
  const FingerRows& rows = log.fingers.front();
  const std::vector<Contact> contacts = contacts_of(rows, finger);
  for (std::size_t row = 0; row < contacts.size(); ++row) {
    HeldContact contact;
    contact.travelled = reading_between(finger, contacts.front(), contacts[row]).length[0];
    // The normal u + psi points into the part, a quarter turn to the left of the tangent.
    const double normal = normal_direction(finger, contacts[row]);
    contact.tangent = normal - 0.5 * std::numbers::pi;
    // The centre of a finger that touches at the origin, taken back: from the centre to the contact.
    contact.lever = -centre_of(finger, Vec2::Zero(), contacts[row]);
    if (!rows.x.empty()) contact.at = Vec2(rows.x[row], rows.y[row]) + contact.lever;
    contact.orientation = contacts[row].psi;
    contact.finger_curvature = finger.curvature(contacts[row].u);
    if (held.has_noise) contact.at += too_near(contact, normal, held.errors.back());
    held.rows[row].contacts.push_back(contact);
  }
}

/// What a wheel is and how far its measurements may be off: standard deviations with noise, else tolerances.
HeldWheel wheel_of(const HoldProblem& problem, std::size_t number, const Log& log) {
  const PassiveWheel& given = problem.wheels[number];
  const FingerRows& rows = log.fingers.front();
  HeldWheel wheel;
  wheel.wheel_radius = given.radius;
  wheel.line = problem.squeezed;
  if (problem.noise) {
    wheel.place = problem.noise->position;
    wheel.radius = problem.noise->radius;
    if (given.log.has_encoder()) wheel.spin = std::max(problem.noise->angle, kLeastHeldAngle);
    // A squeeze's error may last over all rows: each is weighed with n SD^2. docs/rig.md, "Squeezed".
    wheel.line_alike = static_cast<double>(rows.x.size());
    return wheel;
  }
  std::vector<double> coordinates = rows.x;
  coordinates.insert(coordinates.end(), rows.y.begin(), rows.y.end());
  // x and y are each off by half a digit at most: sqrt(2) of that in distance.
  wheel.place = std::numbers::sqrt2 * rounding_of_column(coordinates) + kLeastHeldPlace * problem.part.perimeter();
  double angle = rows.angle_rounding;
  if (problem.tolerance) {
    angle = std::max(angle, problem.tolerance->angle);
    if (problem.tolerance->length > 0) wheel.place = problem.tolerance->length;
  }
  // The wheel's contact is as uncertain as the pin.
  if (given.log.has_encoder()) wheel.spin = angle + kLeastHeldAngle + wheel.place / given.radius;
  return wheel;
}

/// Appends one wheel's pin to each row; an encoder's angles are unwrapped.
void add_pins(const Log& log, const HeldWheel& wheel, HeldRows& held) {
  const FingerRows& rows = log.fingers.front();
  std::vector<Contact> turned;
  if (wheel.spin) turned = contacts_of(rows, disk(wheel.wheel_radius));
  for (std::size_t row = 0; row < held.rows.size(); ++row) {
    held.rows[row].pins.push_back({{rows.x[row], rows.y[row]}, wheel.spin ? turned[row].psi : 0});
  }
}

/// For each row of a finger: how many rows are as far as it is, as far as noise can tell.
void count_alike(std::size_t finger, HeldRows& held) {
  // By sorted lengths in n log n. A row counts itself, so that the number is at least 1.
  const double reach = kAlikeSigmas * held.errors[finger].travel;
  std::vector<double> lengths;
  for (const HeldRow& row : held.rows) lengths.push_back(row.contacts[finger].travelled);
  std::sort(lengths.begin(), lengths.end());
  for (HeldRow& row : held.rows) {
    HeldContact& contact = row.contacts[finger];
    const auto lo = std::lower_bound(lengths.begin(), lengths.end(), contact.travelled - reach);
    const auto hi = std::upper_bound(lengths.begin(), lengths.end(), contact.travelled + reach);
    contact.rows_alike = std::max(1.0, static_cast<double>(hi - lo));
  }
}

constexpr double kMedianVariance = 0.5 * std::numbers::pi;  // of a median, in those of a mean
constexpr std::size_t kMostMeans = 512;                     // rows that fits take, however long the log is

/// The same by medians, which an outlier does not move. The curvature at the contact and the rows at one corner stay
/// means: `mean`.
HeldContact median_of(const std::vector<HeldRow>& rows, std::size_t from, std::size_t to, std::size_t finger,
                      HeldContact mean) {
  const auto of = [&](auto number) {
    std::vector<double> values;
    for (std::size_t k = from; k < to; ++k) values.push_back(number(rows[k].contacts[finger]));
    return belief::median(values);
  };
  mean.travelled = of([](const HeldContact& one) { return one.travelled; });
  mean.tangent = of([](const HeldContact& one) { return one.tangent; });
  mean.orientation = of([](const HeldContact& one) { return one.orientation; });
  mean.at = {of([](const HeldContact& one) { return one.at.x(); }),
             of([](const HeldContact& one) { return one.at.y(); })};
  mean.lever = {of([](const HeldContact& one) { return one.lever.x(); }),
                of([](const HeldContact& one) { return one.lever.y(); })};
  return mean;
}

/// The mean of the rows `from` up to `to`, which is not included. `robust`: the median of what fingers measured.
HeldRow mean_of(const std::vector<HeldRow>& rows, std::size_t from, std::size_t to, bool robust) {
  HeldRow mean = rows[from];
  // A row alone stays as it is, to the last bit.
  if (to - from == 1) return mean;
  const auto count = static_cast<double>(to - from);
  mean.time = 0;
  for (std::size_t k = from; k < to; ++k) mean.time += rows[k].time / count;
  for (std::size_t finger = 0; finger < mean.contacts.size(); ++finger) {
    HeldContact sum{0, 0, Vec2::Zero(), Vec2::Zero(), 0, 0, 0};
    for (std::size_t k = from; k < to; ++k) {
      const HeldContact& one = rows[k].contacts[finger];
      sum.travelled += one.travelled / count;
      sum.tangent += one.tangent / count;
      sum.at += one.at / count;
      sum.lever += one.lever / count;
      sum.orientation += one.orientation / count;
      sum.finger_curvature += one.finger_curvature / count;
      sum.rows_alike += one.rows_alike / count;
    }
    mean.contacts[finger] = robust ? median_of(rows, from, to, finger, sum) : sum;
  }
  for (std::size_t pin = 0; pin < mean.pins.size(); ++pin) {
    HeldPin sum;
    for (std::size_t k = from; k < to; ++k) {
      sum.at += rows[k].pins[pin].at / count;
      sum.spin += rows[k].pins[pin].spin / count;
    }
    mean.pins[pin] = sum;
  }
  // A median of n rows is as good as a mean of n / (pi / 2) of them.
  mean.weight = robust ? count / kMedianVariance : count;
  return mean;
}

/// A number that was measured, and its standard deviation.
struct Measured {
  std::function<double&(HeldRow&)> of;  // where a row has it
  double sd = 0;                        // of one row
};

/// All numbers of a row whose course tells whether the motion is smooth: of each finger L, tau and q, of each wheel
/// its pin and its encoder.
std::vector<Measured> measured_numbers(const HeldRows& rows) {
  std::vector<Measured> all;
  for (std::size_t k = 0; k < rows.fingers(); ++k) {
    const HeldErrors& errors = rows.errors[k];
    // The largest curvature makes the largest error, so that no motion seems uneven by noise alone.
    double curvature = 0;
    for (const HeldRow& row : rows.rows) curvature = std::max(curvature, row.contacts[k].finger_curvature);
    const double turn = std::hypot(errors.angle, curvature * errors.travel);
    all.push_back({[k](HeldRow& row) -> double& { return row.contacts[k].travelled; }, errors.travel});
    all.push_back({[k](HeldRow& row) -> double& { return row.contacts[k].tangent; }, turn});
    if (!errors.has_place) continue;
    const double place = std::hypot(errors.place, errors.travel);
    all.push_back({[k](HeldRow& row) -> double& { return row.contacts[k].at.x(); }, place});
    all.push_back({[k](HeldRow& row) -> double& { return row.contacts[k].at.y(); }, place});
  }
  for (std::size_t k = 0; k < rows.wheels.size(); ++k) {
    const HeldWheel& wheel = rows.wheels[k];
    all.push_back({[k](HeldRow& row) -> double& { return row.pins[k].at.x(); }, wheel.place});
    all.push_back({[k](HeldRow& row) -> double& { return row.pins[k].at.y(); }, wheel.place});
    if (wheel.spin) all.push_back({[k](HeldRow& row) -> double& { return row.pins[k].spin; }, *wheel.spin});
  }
  return all;
}

/// One number over all rows, with the standard deviation of one of them as a mean.
belief::Course course_of(std::vector<HeldRow>& rows, const Measured& measured) {
  belief::Course course{{}, measured.sd / std::sqrt(rows.front().weight)};
  for (HeldRow& row : rows) {
    course.values.push_back(measured.of(row));
    course.rows.push_back(row.weight);
  }
  return course;
}

/// Lots of rows between the first and the last one, about as many in each.
std::vector<HeldRow> means(const HeldRows& rows, std::size_t lots) {
  const std::size_t count = rows.rows.size() - 2;
  std::vector<HeldRow> result;
  for (std::size_t k = 0; k < lots; ++k) {
    // Rows 1 to n - 2, split at whole shares of their number.
    result.push_back(mean_of(rows.rows, 1 + k * count / lots, 1 + (k + 1) * count / lots, rows.outlier_share > 0));
  }
  return result;
}

/// What was in the middles of such means; none: they go too uneven for that.
std::optional<std::vector<HeldRow>> middles_of(std::vector<HeldRow> means, const std::vector<Measured>& numbers) {
  for (const Measured& measured : numbers) {
    const auto middles = belief::at_middles(course_of(means, measured));
    if (!middles) return std::nullopt;
    for (std::size_t k = 0; k < means.size(); ++k) measured.of(means[k]) = (*middles)[k];
  }
  return means;
}

/// The first and the last row stay themselves: at them the answer says where the contacts and the part are.
HeldRows between_ends(const HeldRows& rows, std::vector<HeldRow> means) {
  HeldRows result = rows;
  result.rows = std::move(means);
  result.rows.insert(result.rows.begin(), rows.rows.front());
  result.rows.push_back(rows.rows.back());
  return result;
}

}  // namespace

std::vector<Log> aligned(std::vector<Log> logs) {
  Log first = std::move(logs.front());
  // First the rows that all logs share, then each log cut to these.
  for (std::size_t k = 1; k < logs.size(); ++k) first = one_finger(paired(first, logs[k]), 0);
  std::vector<Log> result{first};
  for (std::size_t k = 1; k < logs.size(); ++k) result.push_back(one_finger(paired(first, logs[k]), 1));
  return result;
}

/// Rows of logs without times are timed by their number. x and y of a finger without noise of the position only say
/// where the part is: `reference`, of the first finger that has them.
HeldRows held_rows(const HoldProblem& problem, const std::vector<Log>& logs) {
  HeldRows held;
  held.has_noise = problem.noise.has_value();
  held.rows.resize(logs.front().rows());
  for (std::size_t row = 0; row < held.rows.size(); ++row) {
    const std::vector<double>& time = logs.front().time;
    held.rows[row].time = time.empty() ? static_cast<double>(row) : time[row];
  }
  for (std::size_t k = 0; k < problem.logs.size(); ++k) {
    const Finger& finger = finger_of_log(problem, k);
    const bool has_centre = !logs[k].fingers.front().x.empty();
    held.errors.push_back(problem.noise ? errors_with(noise_on(problem.part, *problem.noise), finger, has_centre,
                                                      problem.part.perimeter())
                                        : errors_by_digits(problem, logs[k], finger));
    held.any_place = held.any_place || held.errors.back().has_place;
    if (has_centre && !held.reference) held.reference = k;
    add_contacts(logs[k], finger, held);
    count_alike(k, held);
  }
  for (std::size_t k = 0; k < problem.wheels.size(); ++k) {
    held.wheels.push_back(wheel_of(problem, k, logs[problem.logs.size() + k]));
    add_pins(logs[problem.logs.size() + k], held.wheels.back(), held);
  }
  // Where some x and y are evidence they place the part; no other finger's are needed.
  if (held.any_place) held.reference.reset();
  held.outlier_share = problem.robust ? belief::kOutlierShare : 0;
  held.prior = problem.prior;
  held.pose = problem.pose;
  return held;
}

/// Row 0 first. Greedy: the next row is the one farthest from all chosen ones, so that any first few are spread over
/// the log.
std::vector<std::size_t> rows_to_search(const HoldProblem& problem, const Log& log) {
  std::vector<std::size_t> chosen{0};
  const std::size_t last = log.rows() - 1;
  std::vector<std::size_t> others;
  if (!problem.at.empty()) {
    others = rows_at(log, problem.at);
  } else {
    const std::size_t steps = std::min(last, (problem.robust ? kRobustInstants : kHoldInstants) - 1);
    for (std::size_t k = 1; k <= steps; ++k) others.push_back(k * last / steps);
  }
  // The one furthest from those that are chosen comes next.
  while (!others.empty()) {
    // Rows to the nearest chosen one.
    const auto away = [&](std::size_t row) {
      std::size_t least = last + 1;
      for (const std::size_t one : chosen) least = std::min(least, row > one ? row - one : one - row);
      return least;
    };
    const auto next =
        std::max_element(others.begin(), others.end(), [&](std::size_t a, std::size_t b) { return away(a) < away(b); });
    chosen.push_back(*next);
    others.erase(next);
  }
  return chosen;
}

HeldRows averaged(const HeldRows& rows) {
  // Rows between the first and the last one.
  const std::size_t count = rows.rows.size() - std::min<std::size_t>(2, rows.rows.size());
  const std::vector<Measured> numbers = measured_numbers(rows);
  std::vector<HeldRow> all = rows.rows;
  // Fewer rows leave less to chance where a row beside a wheel fits in several poses (docs/rig.md, "How far it is
  // right"). Rows of several fingers are fitted in one pose each, and averaged only where they are too many.
  const bool is_smooth =
      rows.fingers() == 1 && rows.outlier_share == 0 && count >= 2 * belief::kFewestMeans &&
      std::ranges::all_of(numbers, [&](const Measured& one) { return belief::is_even(course_of(all, one)); });
  // So many means, as values in their middles: over a bend the mean is off them.
  const auto middles = [&](std::size_t lots) { return middles_of(means(rows, lots), numbers); };
  if (is_smooth) {
    auto few = belief::fewest_means(std::min(count / 2, kMostMeans - 1), middles);
    // None: too uneven for any number of means, and rows stay as they are while there is room.
    if (few) return between_ends(rows, *std::move(few));
  }
  return rows.rows.size() <= kMostMeans ? rows : between_ends(rows, means(rows, kMostMeans));
}

}  // namespace rollfix::hold
