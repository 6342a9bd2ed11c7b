#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/plan.hpp"

/// A plan of two disks carried out in Box2D: the part is free and lies on a floor with little friction, finger a goes
/// where the plan says, finger b is turned and led sideways as the plan says and pushes towards the part with a
/// constant force. The engine knows of contacts, impulses and friction, and nothing of rolling, arc length or plans.
namespace plan_physics {

using rollfix::Part;
using rollfix::Plan;
using rollfix::PlanProblem;
using rollfix::Pose;
using rollfix::Vec2;

// Of the engine's world, where a contact gives way by b2_linearSlop (5 mm): the part is made so large that this is
// little.
inline constexpr double kPerimeter = 400;       // m
inline constexpr std::size_t kVertices = 1000;  // of the polyline that stands for the outline
inline constexpr double kStep = 1.0 / 240;      // s
inline constexpr double kSettling = 1;          // s, squeezed before anything moves
inline constexpr double kDuration = 15;         // s, of the roll: so slow that inertia is little
inline constexpr int kVelocityIterations = 30;
inline constexpr int kPositionIterations = 10;
inline constexpr double kSqueeze = 400;  // force of finger b per its mass, m/s^2
inline constexpr double kFloor = 0.01;   // the floor's friction, of the squeeze
inline constexpr double kLeading = 40;   // rad/s: how stiffly finger b is led sideways
inline constexpr double kDamping = 20;   // 1/s, of finger b's velocity towards the part

/// How it went. Lengths are shares of the perimeter.
struct Played {
  std::array<double, 2> slip{};  // how far each contact went on the part, less how far its finger rolled
  double apart = 0;              // s, the longest time in which not both fingers touched
  double place = 0;              // of the part at the end, off the plan
  double heading = 0;            // radians
};

/// The plan between its rows.
class Course {
 public:
  explicit Course(const Plan& plan) : plan_(plan) {}

  Pose finger(std::size_t which, double share) const {
    const rollfix::FingerRows& rows = plan_.roll.log.fingers[which];
    return {at(rows.x, share), at(rows.y, share), at(rows.psi, share)};
  }
  double force(double share) const { return at(plan_.force, share); }

 private:
  static double at(const std::vector<double>& column, double share) {
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(column.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(place), column.size() - 2);
    const double rest = place - static_cast<double>(k);
    return column[k] + rest * (column[k + 1] - column[k]);
  }
  const Plan& plan_;
};

class Stage : private b2ContactListener {
 public:
  Stage(const PlanProblem& problem, const Plan& plan, const std::array<double, 2>& friction)
      : problem_(problem),
        plan_(plan),
        course_(plan),
        friction_(friction),
        scale_(kPerimeter / problem.part.perimeter()),
        world_({0, 0}) {
    world_.SetContactListener(this);
    add_part();
    add_fingers();
  }

  Played play() {
    const int settling = static_cast<int>(kSettling / kStep);
    const int steps = settling + static_cast<int>(kDuration / kStep);
    int apart = 0;
    int longest = 0;
    for (int k = 0; k < steps; ++k) {
      const double share = (k + 1 - settling) * kStep / kDuration;
      step(share);
      if (k + 1 < settling) continue;
      if (k + 1 == settling) begin();
      follow();
      apart = touches_[0] && touches_[1] ? 0 : apart + 1;
      longest = std::max(longest, apart);
    }
    Played played;
    for (const std::size_t which : {0U, 1U}) {
      const double radius = problem_.fingers[which].finger.disk()->radius;
      const double rolled = -radius * (u_[which] - first_u_[which]);
      played.slip[which] = std::abs((s_[which] - first_s_[which]) - rolled) / problem_.part.perimeter();
    }
    played.apart = longest * kStep;
    const Pose& last = plan_.roll.pose.back();
    played.place = (length_of(part_->GetPosition()) - Vec2(last.x, last.y)).norm() / problem_.part.perimeter();
    played.heading = std::abs(part_->GetAngle() - last.heading);
    return played;
  }

 private:
  b2Vec2 metres(const Vec2& point) const {
    return {static_cast<float>(point.x() * scale_), static_cast<float>(point.y() * scale_)};
  }
  Vec2 length_of(const b2Vec2& point) const { return Vec2(point.x, point.y) / scale_; }

  void add_part() {
    std::vector<b2Vec2> vertices;
    std::vector<Vec2> points;
    const double P = problem_.part.perimeter();
    for (std::size_t k = 0; k < kVertices; ++k) {
      const Vec2 point = problem_.part.point(P * static_cast<double>(k) / kVertices);
      if (!points.empty() && (point - points.back()).norm() * scale_ < 2 * b2_linearSlop) continue;
      points.push_back(point);
      vertices.push_back(metres(point));
    }
    const Pose& pose = plan_.roll.pose.front();
    b2BodyDef free;
    free.type = b2_dynamicBody;
    free.position = metres({pose.x, pose.y});
    free.angle = static_cast<float>(pose.heading);
    part_ = world_.CreateBody(&free);
    b2ChainShape outline;
    outline.CreateLoop(vertices.data(), static_cast<int32>(vertices.size()));
    part_->CreateFixture(&outline, 0)->GetShape()->m_radius = 0;
    Vec2 middle = Vec2::Zero();
    for (const Vec2& point : points) middle += point / static_cast<double>(points.size());
    b2MassData mass;
    mass.mass = 1000;
    mass.center = metres(middle);
    const double radius = kPerimeter / (2 * std::numbers::pi);
    mass.I = static_cast<float>(mass.mass * (0.5 * radius * radius + mass.center.LengthSquared()));
    part_->SetMassData(&mass);
    b2BodyDef still;
    b2FrictionJointDef floor;
    floor.Initialize(world_.CreateBody(&still), part_, part_->GetWorldCenter());
    floor.maxForce = static_cast<float>(kFloor * kSqueeze * mass.mass);
    floor.maxTorque = static_cast<float>(floor.maxForce * 0.5 * radius);
    world_.CreateJoint(&floor);
  }

  void add_fingers() {
    for (const std::size_t which : {0U, 1U}) {
      const Pose pose = course_.finger(which, 0);
      b2BodyDef body;
      body.type = which == 0 ? b2_kinematicBody : b2_dynamicBody;
      body.fixedRotation = true;  // it is turned as the plan says, whatever presses on it
      body.position = metres({pose.x, pose.y});
      body.angle = static_cast<float>(pose.heading);
      fingers_[which] = world_.CreateBody(&body);
      b2CircleShape disk;
      disk.m_radius = static_cast<float>(problem_.fingers[which].finger.disk()->radius * scale_);
      fingers_[which]->CreateFixture(&disk, 0);
    }
    b2MassData mass;
    mass.mass = 1000;
    mass.center = {0, 0};
    mass.I = 0;
    fingers_[1]->SetMassData(&mass);
  }

  void step(double share) {
    for (const std::size_t which : {0U, 1U}) {
      const Pose to = course_.finger(which, share);
      b2Body* const finger = fingers_[which];
      finger->SetAngularVelocity(static_cast<float>((to.heading - finger->GetAngle()) / kStep));
      if (which == 0) {
        const b2Vec2 way = metres({to.x, to.y}) - finger->GetPosition();
        finger->SetLinearVelocity(static_cast<float>(1 / kStep) * way);
      }
    }
    push(share);
    world_.Step(static_cast<float>(kStep), kVelocityIterations, kPositionIterations);
  }

  /// Finger b: a constant force against the direction in which finger a presses, and sideways as it is led.
  void push(double share) {
    b2Body* const finger = fingers_[1];
    const double angle = course_.force(share);
    const Vec2 along(-std::cos(angle), -std::sin(angle));
    const Pose at = course_.finger(1, share);
    const Pose next = course_.finger(1, share + kStep / kDuration);
    const Vec2 planned = Vec2(next.x - at.x, next.y - at.y) * scale_ / kStep;
    const Vec2 off = Vec2(at.x, at.y) * scale_ - Vec2(finger->GetPosition().x, finger->GetPosition().y);
    const Vec2 late = planned - Vec2(finger->GetLinearVelocity().x, finger->GetLinearVelocity().y);
    const Vec2 pull = kLeading * kLeading * off + 2 * kLeading * late;
    const Vec2 sideways = pull - pull.dot(along) * along;
    const Vec2 force = (kSqueeze + kDamping * late.dot(along)) * along + sideways;
    finger->ApplyForceToCenter(
        {static_cast<float>(finger->GetMass() * force.x()), static_cast<float>(finger->GetMass() * force.y())}, true);
  }

  /// Where each finger is nearest to the part, and the direction to there in its own frame, unwrapped.
  void follow() {
    const b2Transform part = part_->GetTransform();
    for (const std::size_t which : {0U, 1U}) {
      const Vec2 centre = length_of(b2MulT(part, fingers_[which]->GetPosition()));
      s_[which] = nearest(centre, s_[which]);
      const Vec2 towards = problem_.part.point(s_[which]) - centre;
      const double angle = std::atan2(towards.y(), towards.x()) + part_->GetAngle() - fingers_[which]->GetAngle();
      u_[which] += std::remainder(angle - u_[which], 2 * std::numbers::pi);
      touches_[which] = false;
      for (b2ContactEdge* edge = fingers_[which]->GetContactList(); edge != nullptr; edge = edge->next) {
        touches_[which] = touches_[which] || edge->contact->IsTouching();
      }
    }
  }

  void begin() {
    for (const std::size_t which : {0U, 1U}) s_[which] = plan_.roll.s[which].front();
    follow();
    first_s_ = s_;
    first_u_ = u_;
  }

  double nearest(const Vec2& point, double around) const {
    const double P = problem_.part.perimeter();
    double step = 0.002 * P;
    double best = around;
    const auto distance = [&](double s) { return (problem_.part.point(s) - point).squaredNorm(); };
    while (step > 1e-9 * P) {
      if (distance(best + step) < distance(best)) {
        best += step;
      } else if (distance(best - step) < distance(best)) {
        best -= step;
      } else {
        step /= 2;
      }
    }
    return best;
  }

  void PreSolve(b2Contact* contact, const b2Manifold* /*before*/) override {
    const bool of_a =
        contact->GetFixtureA()->GetBody() == fingers_[0] || contact->GetFixtureB()->GetBody() == fingers_[0];
    contact->SetFriction(static_cast<float>(friction_[of_a ? 0 : 1]));
  }

  const PlanProblem& problem_;
  const Plan& plan_;
  Course course_;
  std::array<double, 2> friction_;
  double scale_;  // m per unit of the part
  b2World world_;
  b2Body* part_ = nullptr;
  std::array<b2Body*, 2> fingers_{};
  std::array<bool, 2> touches_{};
  std::array<double, 2> s_{};
  std::array<double, 2> u_{};
  std::array<double, 2> first_s_{};
  std::array<double, 2> first_u_{};
};

}  // namespace plan_physics
