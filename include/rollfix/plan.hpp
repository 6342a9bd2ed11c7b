#pragma once

// How two fingers have to move so that both roll on a part in between as far as is asked, and which condition fails if
// they can't: docs/plan.md.
//
//     PlanProblem problem{load_part("gallery:ellipse,a=2,b=1")};
//     problem.fingers[0].finger = disk(0.3);
//     problem.fingers[1].finger = disk(0.3);
//     problem.fingers[0].start = 0.0;
//     problem.fingers[1].start = problem.part.perimeter() / 2;
//     problem.fingers[0].length = 0.2;
//     problem.fingers[0].friction = problem.fingers[1].friction = 0.5;
//     const Plan plan = solve(problem);
//     plan.decided;  // true
//
// Degenerate cases: contacts that can't squeeze the part fail a condition, which `margins` names with the time and the
// row; a length beyond a concave corner is an InputError.
//
// Accuracy: conditions are proved between the rows as well where `proved` says so; else they hold in many instants.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/finger.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/rolling.hpp"

namespace rollfix {

/// One finger of a roll that is to be planned.
struct PlanFinger {
  Finger finger = DiskFinger{};
  std::optional<double> start{};   // s of the first contact; only of a wheel it may be left open
  std::optional<double> length{};  // how far its contact is to travel, below 0 for backwards, 0 for staying; of finger
                                   // b it may be left open: what keeps the worst margin largest
  std::optional<double> friction{};  // coefficient between it and the part; none: what it would need is told
  bool wheel = false;                // a disk on a free pin: it passes no torque, so that its force goes through the
                                     // pin. Finger b only, and its length follows
  double psi = 0;                    // a disk's orientation at the first contact, in the world, radians
  std::optional<double> u{};         // of any other finger: where on it the first contact is, as of RollPlan
};

/// What stays in place while two fingers roll.
enum class Staying { middle, a, b, part };

/// What the robot can do; nothing: no limit.
struct PlanLimits {
  std::optional<double> speed{};     // of a finger's frame, length per second
  std::optional<double> turn{};      // of a finger that is turned, rad/s
  std::optional<double> travel{};    // of a finger's frame, from where it starts, length
  std::optional<double> rotation{};  // of a finger that is turned, from how it starts, radians
};

/// A roll that is to be planned: one finger on a part at rest, or two on a part that is free to move.
struct PlanProblem {
  Part part;
  PerFinger<PlanFinger> fingers;
  Pose pose{};                            // the part's at the start
  std::optional<double> part_rotation{};  // by how much it turns meanwhile, evenly; none: so that the force keeps
                                          // its direction, beside a wheel so that finger a does not turn
  Staying staying = Staying::middle;      // middle: both fingers move by the same, against each other
  std::optional<double> duration{};       // seconds; none: the shortest within the limits, else a finger turns against
                                          // the part at 1 rad/s at most
  PlanLimits limits{};
  double margin = 0;         // radians: how far the force must stay inside the friction cones
  double clearance = 0;      // length: how far the fingers must stay apart
  bool may_overlap = false;  // two fingers at different heights pass one another
  bool mirrored = false;     // the part lies face down: x = -x of the outline, then the pose. Starts and lengths are
                             // along the outline as drawn
  std::size_t rows = 101;    // of the plan, at equal times, both ends included; at least 2
};

/// What a roll needs.
enum class Condition {
  reach,       // the finger does not enter the part: length it would enter by, below 0
  friction,    // the force is inside the finger's cone: angle to the edge
  apart,       // the fingers do not enter each other: their distance
  stable,      // squeezed between finger a and a wheel the part does not roll out: docs/plan.md, without a unit
  turns_back,  // the wheel can follow: 1 - kappa D, without a unit
  speed,       // a limit less what is reached, as of PlanLimits
  turn,
  travel,
  rotation
};

/// "friction", ...
const char* name_of(Condition condition);

/// The worst of one condition all along the roll.
struct PlanMargin {
  Condition condition = Condition::friction;
  std::size_t finger = 0;   // 0 for a; of what concerns both: 0
  double value = 0;         // what is left where it is worst: below 0, or below what is asked for, it fails
  double allowed = 0;       // the cone's half angle, the limit; else 0
  double time = 0;          // seconds, when it is worst, or else when it first fails
  std::size_t row = 0;      // of the plan, the nearest in time
  PerFinger<double> place;  // where the contacts are then, unwrapped
  bool fails = false;
  bool proved = false;  // between the rows as well, not only in many instants
};

/// How the contacts travel.
enum class PlanPath {
  even,      // each finger turns against the part at a rate that keeps its share of the other's
  searched,  // as the widest way that was found says
  squeezed   // as the passive wheel settles
};

/// The rates of one finger's frame, or of the part's, in each row.
struct PlanRates {
  std::vector<double> vx;     // of its origin, in the world, length per second
  std::vector<double> vy;     //
  std::vector<double> omega;  // rad/s, counter-clockwise
};

/// A plan, or why there is none: then it is the one that fails by least, for looking at.
struct Plan {
  Roll roll;                   // its rows: what the sensors will say, where the fingers and the part are
  PerFinger<PlanRates> rates;  // of the fingers
  PlanRates part_rates;        // of a part that is free to move
  std::vector<double> force;   // of two fingers: direction in which finger a presses, radians in the world
  PlanPath path = PlanPath::even;
  bool expanding = false;             // the fingers press apart, as in a hole
  double duration = 0;                // seconds
  PerFinger<double> length;           // how far each contact travels
  PerFinger<double> friction_needed;  // the least coefficient that would do; of one finger 0, infinite where none would
  std::vector<PlanMargin> margins;    // one for each condition and finger that was looked at
  std::optional<std::size_t> failure;  // of margins: the first to fail; nothing: the roll can be done
  bool decided = true;                 // false: close to failing, and not proved that it never does
  std::vector<std::string> unchecked;  // what was not looked at, in words

  bool feasible() const { return !failure && decided; }
};

/// Plans a roll. Two fingers hold a part in the plane by two forces that are equal and opposite, on the line through
/// both contacts, as long as the floor's friction is small against the squeeze: that line must lie in both friction
/// cones all the time, and a wheel's must go through its pin. docs/plan.md has the derivation. Friction, fingers that
/// enter each other, and the balance on a wheel are proved between the rows as well, by bounds on how fast
/// they can change; speeds and travels are looked at in many instants. Throws InputError: a problem that contradicts
/// itself, a finger that can't roll there at all (with the place and the cure), a wheel that no start keeps in balance.
Plan solve(const PlanProblem& problem);

/// In one sentence: what the plan does, or which condition fails, where, when and by how much.
std::string verdict_text(const Plan& plan, const PlanProblem& problem);

/// The plan as a table: the columns of a log, `u_a`, `psi_a`, `x_a`, `y_a` and so on, which `locate` reads, and for the
/// robot `vx`, `vy`, `omega` of each finger, `part_x`, `part_y`, `part_heading`, and `force`, the direction in which
/// finger a presses. 17 digits; angles are radians. `finger`: only that one's, of two.
std::string format_plan(const Plan& plan, std::optional<std::size_t> finger = {});

/// Why two fingers, or one on a part at rest, can't do this roll; nothing: they can. For whoever proposes rolls.
/// Never throws InputError: what solve refuses is a reason as well.
std::optional<std::string> plannable(const PlanProblem& problem);

}  // namespace rollfix
