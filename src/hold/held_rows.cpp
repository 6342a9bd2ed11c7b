#include "held_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "answer/weighing.hpp"
#include "belief/posterior.hpp"
#include "hold_facts.hpp"

// Notation, as in docs/two_fingers.md, "Three and more fingers":
//   L_i(t)          what contact i has travelled on the part since the first row: `travelled`
//   tau_i(t)        direction of the part's tangent at contact i in the world: `tangent`
//   q_i(t)          the contact in the world: `at`, x and y and from there by the finger's own shape, `lever`
// Idea: u and psi say where on the finger the contact is and how that points, so that a finger of any shape is its
// contact. An error n of the contact along the boundary moves q along the tangent by n and L by n: on the part both are
// the same place, so that n is only seen in the normal.
namespace rollfix::hold {
namespace {

// Without noise centres and lengths are known to this share of the perimeter at best: an outline's own accuracy.
constexpr double kLeastHeldPlace = 1e-6;
constexpr double kLeastHeldTravel = 1e-9;
constexpr double kLeastHeldAngle = 1e-9;  // radians
// A row is at the same corner as another if both contacts are within so many standard deviations of one another.
constexpr double kAlikeSigmas = 3;
constexpr std::size_t kRobustInstants = 15;  // in place of kHoldInstants: of some a measurement may be an outlier

double radius_share(const Noise& noise, const Finger& finger) {
  return finger.is_disk() ? noise.radius / finger.disk()->radius : 0;
}

HeldErrors errors_with(const Noise& noise, const Finger& finger, bool has_centre, double perimeter) {
  HeldErrors errors;
  errors.has_place = has_centre && noise.position > 0;
  errors.travel = std::max(noise.contact, kLeastHeldTravel * perimeter);
  errors.stretch = std::hypot(noise.slip, radius_share(noise, finger), noise.part.length);
  errors.angle = std::hypot(std::max(noise.angle, kLeastHeldAngle), noise.part.turn);
  errors.place = noise.position;
  return errors;
}

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
  if (!problem.tolerance) return errors;
  errors.angle = std::max(problem.tolerance->angle, kLeastHeldAngle);
  if (problem.tolerance->length > 0) errors.place = problem.tolerance->length;
  return errors;
}

void add_contacts(const Log& log, const Finger& finger, HeldRows& held) {
  const FingerRows& rows = log.fingers.front();
  const std::vector<Contact> contacts = contacts_of(rows, finger);
  for (std::size_t row = 0; row < contacts.size(); ++row) {
    HeldContact contact;
    contact.travelled = reading_between(finger, contacts.front(), contacts[row]).length[0];
    contact.tangent = facing(finger, contacts[row]) - 0.5 * std::numbers::pi;
    contact.lever = -centre_of(finger, Vec2::Zero(), contacts[row]);
    if (!rows.x.empty()) contact.at = Vec2(rows.x[row], rows.y[row]) + contact.lever;
    contact.orientation = contacts[row].psi;
    contact.finger_curvature = finger.curvature(contacts[row].u);
    held.rows[row].contacts.push_back(contact);
  }
}

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
    wheel.line_alike = static_cast<double>(rows.x.size());
    return wheel;
  }
  std::vector<double> coordinates = rows.x;
  coordinates.insert(coordinates.end(), rows.y.begin(), rows.y.end());
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

}  // namespace

std::vector<Log> aligned(std::vector<Log> logs) {
  Log first = std::move(logs.front());
  for (std::size_t k = 1; k < logs.size(); ++k) first = one_finger(paired(first, logs[k]), 0);
  std::vector<Log> result{first};
  for (std::size_t k = 1; k < logs.size(); ++k) result.push_back(one_finger(paired(first, logs[k]), 1));
  return result;
}

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
  if (held.any_place) held.reference.reset();
  held.outlier_share = problem.robust ? belief::kOutlierShare : 0;
  held.prior = problem.prior;
  held.pose = problem.pose;
  return held;
}

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

}  // namespace rollfix::hold
