#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/log.hpp"

namespace rollfix {

/// How far the tangent of a part can turn over a stretch of some length.
class TurnRange {
 public:
  explicit TurnRange(const Part& part);

  /// Bounds that hold every Theta(s + l) - Theta(s) with l among these lengths (at least 0), the jumps of corners at
  /// both ends included.
  Interval of(const Interval& lengths) const;

  /// The turns over one lap without their signs, added up.
  double variation() const { return variation_; }

 private:
  /// A stretch of the boundary and the least and the largest Theta on it, radians.
  struct Cell {
    Interval s;
    Interval angle;
  };

  Part part_;
  double variation_ = 0;
  std::vector<Cell> cells_;  // equal ones
};

/// A row that jumps away is a stray one if the roll comes back within so many of them.
inline constexpr std::size_t kMostStrays = 3;

/// What the rows of a roll have to be, of each finger: the one place for files and streams.
///
/// u is on the finger. And between neighbouring rows there is no jump: no finger
///  1. goes farther than an open part is long,
///  2. turns by more than a lap has turns (all of them added up, no signs), for each lap begun, and a little,
///  3. goes more than 50 times as far as usual, over a stretch that the part does not have: none of about that length
///     turns by about that much; or more than a lap.
/// The first two hold for rows however far apart. The third one compares with what is usual per second, where there are
/// times, and not before it knows; what the part allows is never a jump. With two fingers the part may turn, by any
/// angle but the same for both: 2 is about the difference of their turns, and by 3 it is a jump only if no turn of the
/// part makes both steps stretches of it. docs/rolling.md says more.
class RollCheck {
 public:
  /// `fingers`: none where they are not known, else one for each. `count`: how many of them there are.
  RollCheck(const Part& part, LogKind kind, const std::vector<Finger>& fingers, std::size_t count, const Noise& noise);

  /// What is wrong with this place of the finger: it is beyond the end of an open one; nothing where all is well.
  std::optional<std::string> off_finger(std::size_t finger, double u, double rounding) const;

  /// What is not physical, and of which finger.
  struct Jump {
    std::size_t finger = 0;
    std::string why;
  };

  /// What is not physical about this row, after `before`, the row before it; nothing where all is well, or where this
  /// is the roll's first. Each finger's reading on its own, lengths along the stored outline. Either way the next row
  /// comes after this one.
  std::optional<Jump> jump(const PerFinger<std::size_t>& line, const PerFinger<Reading>& before,
                           const PerFinger<Reading>& now, const std::optional<double>& time);

  /// The row that was a jump is a stray one: the next row comes after the one before it.
  void disregard();

  /// The next row starts a roll.
  void restart() { has_row_ = false; }
  /// Rows may be missing before the next one, so that it may be far away.
  void skip() { may_be_far_ = true; }

 private:
  static constexpr std::size_t kRecent = 32;  // steps that say what is usual

  /// How far errors can move what one row says against the row before it, ten standard deviations each.
  struct StepError {
    double length = 0;      // in the part's unit
    double turn = 0;        // radians
    double share = 0;       // of the length that was travelled
    double turn_share = 0;  // of the turn
  };

  /// What a finger did from one row to the next.
  struct Step {
    double length = 0;            // on the part, in its unit, signed
    double turn = 0;              // radians; of a contact on a corner the least that it leaves possible
    std::size_t line_before = 0;  // line of the row that it starts at, for messages
  };

  // The rules, as roll_check.cpp has them.
  static StepError error_of(LogKind kind, const Finger* finger, const Noise& noise);
  std::optional<Jump> impossible(const PerFinger<Step>& steps) const;
  double most_turn(std::size_t finger, double length) const;
  bool is_sudden(std::size_t finger, double size) const;
  bool is_explained(const PerFinger<Step>& steps) const;
  std::vector<Interval> part_turns(std::size_t finger, const Step& step) const;
  std::string text(std::size_t finger, const Step& step) const;

  Part part_;
  TurnRange turns_;
  std::vector<Finger> fingers_;  // none where they are not known
  double noise_in_place_;        // how far u may be beyond an open finger's end by noise, length
  PerFinger<StepError> error_;
  PerFinger<std::array<double, kRecent>> recent_;  // speeds of steps, in turn; jumps are not among them
  std::size_t steps_ = 0;                          // that were taken in, jumps left out
  bool has_row_ = false;                           // there is a row before, in this roll
  PerFinger<std::size_t> line_;                    // of that row
  std::optional<double> time_;                     // of that row, seconds
  PerFinger<std::size_t> line_before_;             // of the row before that
  std::optional<double> time_before_;
  bool may_be_far_ = false;  // rows are missing before the next one: rule 3 does not hold for it
};

}  // namespace rollfix
