#pragma once

#include <box2d/box2d.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/turning_function.hpp"

/// A disk that rolls on a part because friction makes it: Box2D, a rigid-body engine, which knows of contacts, impulses
/// and friction, and nothing of rolling, arc length or turning functions.
namespace physics {

using rollfix::Interval;
using rollfix::Part;
using rollfix::Pose;
using rollfix::Vec2;

// Of the engine's world. A contact gives way by up to b2_linearSlop (5 mm): the part is made so large that this is
// little.
inline constexpr double kPerimeter = 400;       // m
inline constexpr double kStep = 1.0 / 240;      // s
inline constexpr int kStepsPerRow = 8;          // a row each 1/30 s
inline constexpr int kVelocityIterations = 20;  // so that friction holds as firmly as it can
inline constexpr int kPositionIterations = 10;
inline constexpr std::size_t kVertices = 3000;  // of the polyline that stands for the outline
inline constexpr double kLeastEdge =
    1.5F * b2_linearSlop;                 // m; the engine refuses vertices closer together than half that
inline constexpr double kGap = 0.02;      // m, between finger and part before it is pressed on
inline constexpr double kSettling = 0.5;  // s, pressed on without turning
inline constexpr double kStarting = 0.5;  // s, until it turns as fast as it shall
inline constexpr double kMostTime = 120;  // s; a finger that gets nowhere gives up

/// What the finger is and how the robot moves it. Lengths in the part's unit.
struct Rolling {
  double radius = 0;
  double start = 0;       // s, about where the finger is pressed on
  double distance = 0;    // it stops after its own sensor has counted so much, above 0
  double friction = 1;    // Coulomb's, between finger and part
  double oiled_from = 0;  // s, where an oily stretch begins ...
  double oiled_for = 0;   // ... so long, with ...
  double oily = 0;        // ... this friction
  double press = 300;     // force towards the part, per mass of the finger, m/s^2
  double drag = 0;        // of the arm that the finger has to pull along: force per mass and speed, 1/s
  double omega = 1;       // commanded angular velocity, rad/s, counter-clockwise: along the stored outline
  Pose pose;              // of the part in the world
};

/// What the robot writes down, and what it can't know.
struct Row {
  double time = 0;  // s
  bool contact = false;
  double u = 0;    // of the contact in the finger's frame, radians; where there is contact
  double psi = 0;  // of the finger, radians
  Vec2 centre = Vec2::Zero();
  double s = 0;  // the truth: of the point of the part that is nearest to the contact, unwrapped
};

/// The outline as points, closer together where it bends.
struct Polyline {
  std::vector<double> s;
  std::vector<Vec2> points;
};

inline Polyline polyline_of(const Part& part) {
  constexpr std::size_t kFine = 8 * kVertices;  // places to choose from
  const double P = part.perimeter();
  const double least = kLeastEdge * P / kPerimeter;
  std::vector<double> places{P};
  for (std::size_t k = 0; k < kFine; ++k) places.push_back(P * static_cast<double>(k) / static_cast<double>(kFine));
  for (const rollfix::Corner& corner : part.corners()) places.push_back(corner.s);
  std::sort(places.begin(), places.end());
  const auto is_corner = [&](double s) {
    return std::any_of(part.corners().begin(), part.corners().end(),
                       [&](const rollfix::Corner& corner) { return corner.s == s; });
  };
  Polyline polyline{{0}, {part.point(0)}};
  std::vector<Vec2>& points = polyline.points;
  double weight = 0;
  for (std::size_t k = 1; k + 1 < places.size(); ++k) {
    const double s = places[k];
    const double bend = part.turning().angle(s, rollfix::Side::before) - part.turning().angle(places[k - 1]);
    weight += (s - places[k - 1]) / P + std::abs(bend) / (2 * std::numbers::pi);
    const Vec2 point = part.point(s);
    if (is_corner(s)) {
      while (points.size() > 1 && (point - points.back()).norm() < least) {
        points.pop_back();
        polyline.s.pop_back();
      }
    } else if (weight * kVertices < 2 || (point - points.back()).norm() < least ||
               (point - points.front()).norm() < least) {
      continue;
    }
    if ((point - points.back()).norm() < least) continue;
    points.push_back(point);
    polyline.s.push_back(s);
    weight = 0;
  }
  return polyline;
}

/// The place on the part nearest to a point, looked for around the place where it was last; all around without one.
inline double nearest(const Part& part, const Vec2& point, std::optional<double> last) {
  constexpr int kPlaces = 2000;     // all around
  constexpr double kAround = 0.01;  // of the perimeter
  constexpr int kThirds = 45;       // then the place is known to 1e-11 of the perimeter
  const double P = part.perimeter();
  const auto distance = [&](double s) { return (part.point(s) - point).squaredNorm(); };
  const double step = P / kPlaces;
  const int count = last ? static_cast<int>(2 * kAround * kPlaces) : kPlaces;
  const double first = last ? *last - kAround * P : 0;
  double best = first;
  double least = distance(first);
  for (int k = 1; k <= count; ++k) {
    const double d = distance(first + k * step);
    if (d < least) best = first + k * step;
    least = std::min(least, d);
  }
  Interval around{best - step, best + step};
  for (int k = 0; k < kThirds; ++k) {
    const double third = around.width() / 3;
    (distance(around.lo + third) < distance(around.hi - third) ? around.hi : around.lo) +=
        distance(around.lo + third) < distance(around.hi - third) ? -third : third;
  }
  return around.middle();
}

/// A part that is fixed and a finger that is free, in the engine's world.
class World : private b2ContactListener {
 public:
  World(const Part& part, const Polyline& polyline, const Rolling& rolling)
      : part_(part),
        places_(polyline.s),
        rolling_(rolling),
        scale_(kPerimeter / part.perimeter()),
        world_(b2Vec2(0, 0)) {
    world_.SetAllowSleeping(false);
    world_.SetContinuousPhysics(false);  // nothing is fast enough to pass through an edge within a step
    world_.SetContactListener(this);
    add_part(polyline);
    add_finger();
  }

  /// One step of the robot: it presses the finger on where it feels the part, and turns it.
  void step(double omega) {
    constexpr double kGain = 20;  // 1/s: how fast the angular velocity is put right
    const b2Vec2 inward = -normal_;
    finger_->ApplyForceToCenter(static_cast<float>(rolling_.press) * finger_->GetMass() * inward, true);
    const double r = rolling_.radius * scale_;
    const double inertia = finger_->GetInertia() + finger_->GetMass() * r * r;
    finger_->ApplyTorque(static_cast<float>(kGain * inertia * (omega - finger_->GetAngularVelocity())), true);
    felt_from_ = finger_->GetTransform();
    felt_angle_ = finger_->GetAngle();
    world_.Step(static_cast<float>(kStep), kVelocityIterations, kPositionIterations);
    time_ += kStep;
    feel();
  }

  /// What the sensors say now; `s` is left out.
  Row row() const {
    Row row;
    row.time = time_;
    row.contact = touches_;
    row.psi = felt_angle_;
    row.centre = length_of(felt_from_.p);
    const Vec2 towards = contact_ - row.centre;
    row.u = std::atan2(towards.y(), towards.x()) - row.psi;
    return row;
  }

  /// Where the contact is, in the part's frame.
  Vec2 contact() const {
    const Pose& pose = rolling_.pose;
    return Pose{0, 0, -pose.heading}.turned(contact_ - Vec2(pose.x, pose.y));
  }

 private:
  b2Vec2 metres(const Vec2& point) const {
    return {static_cast<float>(point.x() * scale_), static_cast<float>(point.y() * scale_)};
  }
  Vec2 length_of(const b2Vec2& point) const { return Vec2(point.x, point.y) / scale_; }

  void add_part(const Polyline& polyline) {
    std::vector<b2Vec2> vertices;
    for (const Vec2& point : polyline.points) vertices.push_back(metres(rolling_.pose.world(point)));
    b2ChainShape outline;
    outline.CreateLoop(vertices.data(), static_cast<int32>(vertices.size()));
    const b2BodyDef at_rest;
    b2Fixture* fixture = world_.CreateBody(&at_rest)->CreateFixture(&outline, 0);
    fixture->GetShape()->m_radius = 0;  // no skin about the outline: the finger touches the part itself
  }

  void add_finger() {
    const double tangent = part_.tangent(rolling_.start);
    const Vec2 outward = rolling_.pose.turned(Vec2(std::sin(tangent), -std::cos(tangent)));
    normal_ = b2Vec2(static_cast<float>(outward.x()), static_cast<float>(outward.y()));
    const Vec2 touching = rolling_.pose.world(part_.point(rolling_.start));
    b2BodyDef free;
    free.type = b2_dynamicBody;
    free.position = metres(touching + (rolling_.radius + kGap / scale_) * outward);
    free.linearDamping = static_cast<float>(rolling_.drag);
    finger_ = world_.CreateBody(&free);
    disk_.m_radius = static_cast<float>(rolling_.radius * scale_);
    finger_->CreateFixture(&disk_, 1);
  }

  /// Where the pressure's centre was when the engine looked, as a tactile skin would have it; while nothing touches,
  /// what was felt last.
  void feel() {
    Vec2 sum = Vec2::Zero();
    double total = 0;
    for (b2ContactEdge* edge = finger_->GetContactList(); edge != nullptr; edge = edge->next) {
      const b2Manifold& manifold = *edge->contact->GetManifold();
      if (!edge->contact->IsTouching() || manifold.pointCount == 0) continue;
      b2WorldManifold where;
      where.Initialize(&manifold, edge->other->GetTransform(), 0, felt_from_, disk_.m_radius);
      const double weight = manifold.points[0].normalImpulse;
      sum += weight * length_of(where.points[0]);
      total += weight;
    }
    touches_ = total > 0;
    if (!touches_) return;
    contact_ = sum / total;
    const Vec2 outward = (length_of(felt_from_.p) - contact_).normalized();
    normal_ = b2Vec2(static_cast<float>(outward.x()), static_cast<float>(outward.y()));
  }

  /// The engine asks this of each contact: that of edge k, from vertex k to the next.
  void PreSolve(b2Contact* contact, const b2Manifold* /*before*/) override {
    const double s = places_[static_cast<std::size_t>(contact->GetChildIndexA())];
    const bool is_oily = rollfix::wrap(s - rolling_.oiled_from, part_.perimeter()).base < rolling_.oiled_for;
    contact->SetFriction(static_cast<float>(is_oily ? rolling_.oily : rolling_.friction));
  }

  const Part& part_;
  const std::vector<double>& places_;  // of the vertices
  Rolling rolling_;
  double scale_;  // m per unit of the part
  b2World world_;
  b2Body* finger_ = nullptr;
  b2CircleShape disk_;
  b2Transform felt_from_;  // where the finger was when the engine looked for contacts: before the step moved it on
  double felt_angle_ = 0;
  b2Vec2 normal_;
  Vec2 contact_ = Vec2::Zero();
  bool touches_ = false;
  double time_ = 0;
};

/// Presses the finger on and rolls it. A row is the first step with contact in its time; only where there is none it is
/// a row without.
inline std::vector<Row> roll(const Part& part, const Polyline& polyline, const Rolling& rolling) {
  World world(part, polyline, rolling);
  std::vector<Row> rows;
  std::optional<Row> first;
  std::optional<Row> last;  // with contact
  bool is_written = false;
  double travelled = 0;  // as the finger's own sensor counts
  for (int k = 1; k * kStep < kMostTime && travelled < rolling.distance; ++k) {
    world.step(rolling.omega * std::clamp((k * kStep - kSettling) / kStarting, 0.0, 1.0));
    const bool row_ends = k % kStepsPerRow == 0;
    Row row = world.row();
    if (row.contact && !is_written) {
      if (last) row.u = last->u + std::remainder(row.u - last->u, 2 * std::numbers::pi);
      row.s = nearest(part, world.contact(), last ? std::optional<double>(last->s) : std::nullopt);
      if (!first) first = row;
      last = row;
      travelled = -rolling.radius * (row.u - first->u);
    }
    if (!is_written && (row.contact || row_ends)) rows.push_back(row);
    is_written = !row_ends && (is_written || row.contact);
  }
  return rows;
}

/// As a log: what the robot knows.
inline std::string csv(const std::vector<Row>& rows) {
  std::string text = "time,u,psi,x,y,contact\n";
  for (const Row& row : rows) {
    text +=
        fmt::format("{:.6f},{},{:.7f},{:.7f},{:.7f},{}\n", row.time, row.contact ? fmt::format("{:.7f}", row.u) : "",
                    row.psi, row.centre.x(), row.centre.y(), row.contact ? 1 : 0);
  }
  return text;
}

}  // namespace physics
