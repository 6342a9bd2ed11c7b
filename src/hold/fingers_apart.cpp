#include "steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "box_search.hpp"
#include "finger/convex_body.hpp"
#include "held_rows.hpp"
#include "log/log_rows.hpp"
#include "part/turning_range.hpp"
#include "rollfix/error.hpp"
#include "rollfix/rolling.hpp"

// Notation, as in docs/two_fingers.md, "Three and more fingers":
//   s, Theta        a contact on the part, and the tangent there; from there the finger lies to the right
//   tau, w, psi     the tangent in the world, the contact as seen from the finger's centre, the finger's orientation;
//                   so that on the part the finger is at p(s) - R(Theta - tau) w, turned by psi + Theta - tau
// Idea: a body moves by no more than its contact does and its reach times its turn. What is left of the depth in the
// middle of both arcs is there everywhere on them.
namespace rollfix::hold {
namespace {

constexpr std::size_t kMostRowsApart = 64;
constexpr double kApartRounding = 1e-9;  // of the perimeter: fingers that touch are apart
// With x and y, of noise: so many standard deviations, as wherever something is refused.
constexpr double kRefusedSigmas = kPossibleSigmas;
// Rows that may be outliers where the problem is robust.
constexpr double kStrayRows = 0.1;

/// How far any point of the finger is at most from a contact on it, if it turns about that; of a jaw 0.
double size_of(const Finger& finger) {
  if (finger.is_disk()) return finger.disk()->radius;
  return finger.is_jaw() ? 0 : finger.outline()->perimeter();
}

}  // namespace

/// A finger on the part.
struct FingersApart::Body {
  const Finger* finger = nullptr;
  Pose pose;  // in the part's frame
  Vec2 contact = Vec2::Zero();
  double moved = 0;  // of its contact and with its turn, at most
  double turn = 0;   // at most, radians
  double size = 0;
};

/// Rows are spread evenly, the first and the last among them. A row that is not looked at excludes nothing.
FingersApart::FingersApart(const HoldProblem& problem, const HeldRows& rows)
    : problem_(problem), has_noise_(rows.has_noise) {
  const std::size_t last = rows.rows.size() - 1;
  const std::size_t steps = std::min(last, kMostRowsApart - 1);
  for (std::size_t k = 0; k <= steps; ++k) rows_.push_back(rows.rows[steps == 0 ? 0 : k * last / steps]);
  for (const HeldRow& row : rows_) {
    travel_.emplace_back();
    for (std::size_t k = 0; k < rows.fingers(); ++k) {
      travel_.back().push_back(slack_of(rows.errors[k], row.contacts[k], rows.has_noise).travel);
    }
  }
  for (std::size_t k = 0; k < rows.fingers(); ++k) size_.push_back(size_of(finger_of_log(problem, k)));
  if (problem.noise) radius_slack_ = kRefusedSigmas * std::numbers::sqrt2 * problem.noise->radius;
}

/// The finger with its contact in the middle of the arc at this row. `moved` bounds the way of any of its points
/// while the contact goes over the arc.
FingersApart::Body FingersApart::body_at(std::size_t row, std::size_t finger, const Interval& first_contact) const {
  const HeldContact& contact = rows_[row].contacts[finger];
  const double off = travel_[row][finger];
  const double middle = first_contact.middle() + contact.travelled;
  // The arc of first contacts, and what the travelled length may be off by.
  const double about = together(0.5 * first_contact.width(), off);
  const Interval arc{middle - about, middle + about};
  const Boundary boundary = problem_.part.boundary();
  const auto on = [&](double s) { return boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter); };
  const Interval angles = angles_over(problem_.part.turning(), {on(arc.lo), on(arc.hi)});
  Body body;
  body.finger = &finger_of_log(problem_, finger);
  // From the world to the part's frame: Theta - tau.
  const double turned = angles.middle() - contact.tangent;
  body.contact = problem_.part.point(on(arc.middle()));
  // The lever leads from the finger's centre to the contact.
  const Vec2 centre = body.contact - Pose{0, 0, turned}.turned(contact.lever);
  body.pose = {centre.x(), centre.y(), contact.orientation + turned};
  // How an outline is turned is only known as well as the contact on it.
  const double by_outline = body.finger->outline() == nullptr ? 0 : contact.finger_curvature * off;
  body.turn = 0.5 * angles.width() + by_outline;
  body.size = size_[finger];
  // The contact moves along the arc; any other point besides by its distance from it times the turn.
  body.moved = about + body.turn * body.size;
  return body;
}

/// Two ways to be off. With noise both are normally distributed, each on its own.
double FingersApart::together(double one, double other) const {
  return has_noise_ ? std::hypot(one, other) : one + other;
}

/// At least, from anywhere on the arcs. A jaw's line turns about its contact, and passes the other body that far away.
double FingersApart::depth(const Body& one, const Body& other) const {
  // With both contacts in the middles of their arcs.
  const double deep = depth_of_overlap(*one.finger, one.pose, *other.finger, other.pose, 0);
  // A jaw has no ends: how far its line moves grows with the distance from its contact to the other body.
  const auto by_jaw = [&](const Body& jaw, const Body& body) {
    if (!jaw.finger->is_jaw()) return 0.0;
    return jaw.turn * ((body.contact - jaw.contact).norm() + 2 * body.size + body.moved + jaw.moved);
  };
  return deep - together(one.moved, other.moved) - by_jaw(one, other) - by_jaw(other, one) - radius_slack_;
}

/// One row and one pair that overlap everywhere on the arcs are enough.
bool FingersApart::must_overlap(const std::vector<Interval>& first_contacts) const {
  if (problem_.may_overlap) return false;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    std::vector<Body> bodies;
    for (std::size_t k = 0; k < size_.size(); ++k) {
      bodies.push_back(body_at(row, k, first_contacts[k]));
      for (std::size_t i = 0; i < k; ++i) {
        if (depth(bodies[i], bodies[k]) > kApartRounding * problem_.part.perimeter()) return true;
      }
    }
  }
  return false;
}

namespace {

/// A finger, or behind all of them a wheel, as its log has it in the world.
struct LoggedBody {
  LoggedBody(const HoldProblem& problem, const std::vector<Log>& logs, std::size_t number)
      : finger(shape_of(problem, number)), log(&logs[number]), is_wheel(number >= problem.logs.size()) {}

  bool has_place() const { return !log->fingers.front().x.empty(); }
  /// Of its frame at a row. A wheel may have no psi, and is the same however it is turned.
  Pose pose(std::size_t row) const {
    const FingerRows& rows = log->fingers.front();
    return {rows.x[row], rows.y[row], is_wheel ? 0 : rows.psi[row]};
  }

  Finger finger;
  const Log* log;
  bool is_wheel;
};

/// Rows in which two bodies are deeper in one another than they may be off.
struct Crossing {
  std::size_t rows = 0;
  std::size_t row = 0;  // the deepest of them
  double depth = 0;
};

/// Of two logs with x and y, in the world: the part plays no role. `slack`: by the row, a depth that counts as apart.
template <class Slack>
Crossing crossing_of(const LoggedBody& one, const LoggedBody& other, const Slack& slack) {
  Crossing found;
  for (std::size_t row = 0; row < one.log->rows(); ++row) {
    const double allowed = slack(row);
    const double depth = depth_of_overlap(one.finger, one.pose(row), other.finger, other.pose(row), allowed);
    if (depth <= allowed) continue;
    ++found.rows;
    if (depth <= found.depth) continue;
    found.depth = depth;
    found.row = row;
  }
  return found;
}

/// How deep two fingers may seem by x, y and radii, length.
double slack_of_centres(const HoldProblem& problem) {
  if (!problem.noise) return kApartRounding * problem.part.perimeter();
  // Of the deepest of all rows, and of both centres and radii.
  return kRefusedSigmas * std::numbers::sqrt2 * (problem.noise->position + problem.noise->radius);
}

/// How far off a body beside a wheel can be, or a wheel.
struct Off {
  double place = 0;  // its x and y, and a wheel's radius, length
  double angle = 0;  // its orientation, radians; of what is round 0
};

Off off_of(const HoldProblem& problem, const HeldRows& rows, std::size_t number) {
  if (number < problem.logs.size()) {
    const HeldErrors& errors = rows.errors[number];
    return {errors.place, finger_of_log(problem, number).is_disk() ? 0 : errors.angle};
  }
  const HeldWheel& errors = rows.wheels[number - problem.logs.size()];
  return {std::hypot(errors.place, errors.radius), 0};
}

/// How far off the depth in a wheel can be. `pin`: where it is as seen from the body's place.
double slack_of_pin(const Off& body, const Off& wheel, const Vec2& pin, bool has_noise) {
  // An error of psi moves the pin, as the body's frame has it, by that angle times the distance.
  const double turned = body.angle * std::hypot(pin.x(), pin.y());
  if (!has_noise) return body.place + wheel.place + turned;
  return kRefusedSigmas * std::hypot(body.place, wheel.place, turned);
}

}  // namespace

void require_apart(const HoldProblem& problem, const std::vector<Log>& logs) {
  if (problem.may_overlap || (problem.noise && problem.noise->position <= 0)) return;
  const double slack = slack_of_centres(problem);
  for (std::size_t b = 1; b < problem.logs.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const LoggedBody one(problem, logs, a), other(problem, logs, b);
      if (!one.has_place() || !other.has_place()) continue;
      const Crossing found = crossing_of(one, other, [&](std::size_t) { return slack; });
      // Outliers among x and y are no refusal.
      const double allowed = problem.robust ? kStrayRows * static_cast<double>(logs[a].rows()) : 0;
      if (static_cast<double>(found.rows) <= allowed) continue;
      throw InputError(fmt::format(
          "fingers on a free part: {} and {}: expected x and y at which fingers {} and {} are apart, found them {:.4g} "
          "deep in each other, in {} of {} rows, whatever the part does; check the radii and the units of x and y, or "
          "if the fingers are at different heights say that they may overlap",
          where(logs[a], 0, found.row), where(logs[b], 0, found.row), finger_letter(a), finger_letter(b), found.depth,
          found.rows, logs[a].rows()));
    }
  }
}

void require_wheels_apart(const HoldProblem& problem, const std::vector<Log>& logs) {
  if (problem.may_overlap || problem.wheels.empty()) return;
  const HeldRows rows = held_rows(problem, logs);
  for (std::size_t b = problem.logs.size(); b < logs.size(); ++b) {
    // Each wheel with all fingers and the wheels before it.
    for (std::size_t a = 0; a < b; ++a) {
      const LoggedBody body(problem, logs, a), wheel(problem, logs, b);
      if (!body.has_place()) continue;
      const Off body_off = off_of(problem, rows, a), wheel_off = off_of(problem, rows, b);
      const Crossing found = crossing_of(body, wheel, [&](std::size_t row) {
        const Pose at = body.pose(row), pin = wheel.pose(row);
        return slack_of_pin(body_off, wheel_off, {at.x - pin.x, at.y - pin.y}, rows.has_noise);
      });
      if (found.rows == 0) continue;
      throw InputError(fmt::format(
          "{}: expected x and y at which {} {} and wheel {} are apart, found them {:.4g} deep in each other, in {} of "
          "{} rows, whatever the part does; check the radius and the unit of x and y{}; if they are at different "
          "heights, or the jaw ends before the wheel, say that they may overlap",
          where(logs[b], 0, found.row), body.is_wheel ? "wheel" : "finger", finger_letter(a), finger_letter(b),
          found.depth, found.rows, logs[b].rows(),
          body.finger.is_disk() ? "" : ", and the unit and the direction of psi"));
    }
  }
}

}  // namespace rollfix::hold
