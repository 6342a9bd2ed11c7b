#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/hold.hpp"

namespace rollfix::hold {

/// One finger at one instant, or on average over neighbouring ones.
struct HeldContact {
  double travelled = 0;         // L: from the first contact, along the stored outline
  double tangent = 0;           // direction of the part's tangent in the world, by u and psi, radians
  Vec2 at = Vec2::Zero();       // the contact in the world, where the log has x and y
  Vec2 lever = Vec2::Zero();    // from the finger's centre to it, in the world
  double orientation = 0;       // psi: of the finger's frame, radians
  double finger_curvature = 0;  // 1 / r of a disk
  double rows_alike = 1;        // rows that may be at one corner together with this one
};

/// A wheel's pin at one instant.
struct HeldPin {
  Vec2 at = Vec2::Zero();  // in the world
  double spin = 0;         // the wheel's orientation, radians, unwrapped; without an encoder 0
};

/// What a wheel is, and how far its measurements may be off. With noise standard deviations, else tolerances.
struct HeldWheel {
  double wheel_radius = 0;
  double place = 0;              // of x and y each; without noise of the distance from the part
  double radius = 0;             // of the wheel's radius
  std::optional<double> spin{};  // of the orientation, radians; none: it has no encoder
  std::optional<double> line{};  // of the angle between its normal and the way to the finger's contact; none: not known
  double line_alike = 1;         // with noise so many rows are off alike: all of them, since what tilts a force lasts
};

/// How far one finger's measurements may be off. With noise standard deviations, else tolerances.
struct HeldErrors {
  bool has_place = false;  // x and y are evidence
  double travel = 0;       // of the contact along the boundary, length
  double stretch = 0;      // of all lengths, per length: slip and the radius
  double arm_share = 0;    // of the stretch's variance, as far as it is the radius: that stretches the arm as well
  double angle = 0;        // of psi, radians; without noise of u + psi
  double place = 0;        // of x and y each; without noise of the distance
};

/// All fingers at one instant.
struct HeldRow {
  std::vector<HeldContact> contacts;
  std::vector<HeldPin> pins{};
  double weight = 1;  // rows of which it is the mean
  double time = 0;
};

/// What all logs say.
struct HeldRows {
  std::vector<HeldRow> rows;
  std::vector<HeldErrors> errors;  // of each finger
  std::vector<HeldWheel> wheels{};
  bool has_noise = false;
  bool any_place = false;
  std::optional<std::size_t> reference{};  // without any: the finger whose x and y only say where the part is
  double outlier_share = 0;                // robust: so many of a finger's rows are anything
  std::optional<Prior> prior{};            // of the first finger's first contact
  std::optional<PosePrior> pose{};         // of the first row

  std::size_t fingers() const { return errors.size(); }
};

/// The logs cut to the instants that all of them share. Throws InputError as `paired` does.
std::vector<Log> aligned(std::vector<Log> logs);

/// `logs`: aligned; of the fingers, then of the wheels.
HeldRows held_rows(const HoldProblem& problem, const std::vector<Log>& logs);

/// Rows to search with, in the order in which they tell most: the first, the last, the middle one, ... Those of
/// HoldProblem::at, or kHoldInstants spread evenly, more if outliers are allowed.
std::vector<std::size_t> rows_to_search(const HoldProblem& problem, const Log& log);

/// The same with neighbouring rows averaged, but for the first and the last one. Rows of one finger beside wheels that
/// follow a smooth motion, but for noise, become as few means as say what the rows say. Others are averaged where there
/// are more than 512, to 512 means.
HeldRows averaged(const HeldRows& rows);

// A problem as all steps look at it: its logs by number, what of it is refused, and a part that lies face down as a
// mirror shows it.

/// The finger of a log: one may hold for all.
const Finger& finger_of_log(const HoldProblem& problem, std::size_t log);

/// The same of fingers and wheels. What a wheel's log is mirrored and measured as: a disk.
Finger shape_of(const HoldProblem& problem, std::size_t number);

/// How a finger is called, or a wheel: 0 is a.
inline char finger_letter(std::size_t number) { return static_cast<char>('a' + number); }

/// The logs of the fingers, then of the wheels.
std::size_t count_of_logs(const HoldProblem& problem);
const Log& log_of(const HoldProblem& problem, std::size_t number);
Log& log_of(HoldProblem& problem, std::size_t number);

/// What an answer says of a log, but for how far its contact travelled.
HoldRoll roll_of(const HoldProblem& problem, const Log& log, std::size_t number);

/// The problem, and its aligned logs, as a mirror shows them: x has the other sign. A part that lies face down lies
/// face up there.
HoldProblem in_mirror(const HoldProblem& problem, std::vector<Log>& logs);
/// Its answer in the world as it is.
void out_of_mirror(HoldAnswer& answer);

/// Throws InputError unless the problem can be asked.
void require_valid(const HoldProblem& problem);

/// Throws InputError where angles may be wrapped or not. `logs`: of fingers and wheels, as they are measured.
void require_clear(const HoldProblem& problem, const std::vector<Log>& logs);

}  // namespace rollfix::hold
