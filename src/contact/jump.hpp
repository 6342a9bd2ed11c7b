#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "contact/turn_range.hpp"
#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/contact/noise.hpp"

namespace rollfix {

/// How far errors can move what one row says against the row before it, ten standard deviations each.
struct StepError {
  double length = 0;
  double turn = 0;
  double share = 0;  // of the length that was travelled

  StepError(LogKind kind, const std::optional<Finger>& finger, const Noise& noise);
};

/// How far beyond the ends of an open finger u may be written.
double end_slack(const Finger& finger, double rounding, const Noise& noise);
/// "u is 12, but the finger's outline goes from 0 to 10", for messages.
std::string off_finger(const Finger& finger, double u);

/// Tells a jump from a roll. Between neighbouring rows no finger
///  1. goes farther than an open part is long,
///  2. turns by more than a lap has turns (all of them added up, no signs), for each lap begun, and a little,
///  3. goes more than 50 times as far as usual, over a stretch that the part does not have: none of about that length
///     turns by about that much; or more than a lap.
/// The first two hold for rows however far apart. The third one compares with what is usual per second, where there are
/// times, and not before it knows; what the part allows is never a jump. docs/rolling.md says more.
class JumpWatch {
 public:
  JumpWatch(const Part& part, const StepError& error);

  /// What is not physical about this row, after `before`, the row before it; nothing where all is well, or where this
  /// is the roll's first. Lengths along the stored outline. Either way the next row comes after this one.
  std::optional<std::string> look(std::size_t line, const Reading& before, const Reading& now,
                                  const std::optional<double>& time);

  /// The next row starts a roll.
  void restart() { last_line_ = 0; }
  /// Rows may be missing before the next one, so that it may be far away.
  void skip() { may_be_far_ = true; }

 private:
  static constexpr std::size_t kRecent = 32;  // steps that say what is usual

  bool is_sudden(double size) const;
  void remember(double size);
  std::optional<std::string> impossible(const Reading& step) const;
  bool is_explained(const Reading& step) const;

  Part part_;
  StepError error_;
  TurnRange turns_;
  std::array<double, kRecent> recent_{};
  std::size_t steps_ = 0;
  std::size_t last_line_ = 0;  // 0: none
  std::optional<double> last_time_;
  bool may_be_far_ = false;
};

}  // namespace rollfix
