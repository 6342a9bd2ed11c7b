#pragma once

#include <fmt/format.h>

#include <string>

#include "rollfix/output/table.hpp"
#include "rollfix/solve.hpp"
#include "text/text.hpp"

namespace rollfix::app {

/// "contact 0.1 mm, angle 0.300 deg": each kind of noise that there is. `unit`: behind a length.
std::string noise_words(const Noise& noise, const std::string& unit);

/// What all parts of an answer's text have in common: names, places and units. What is of a finger is said of each.
class AnswerWords {
 protected:
  explicit AnswerWords(const Answer& answer)
      : answer_(answer),
        fingers_(answer.finger_count()),
        decimals_(decimals_for(answer.part.perimeter())),
        unit_(behind(answer.part.unit())) {}

  /// The names in figures: a0 is where the first placement starts; of two fingers it is pair 0.
  std::string label(std::size_t i) const { return fingers_ == 1 ? fmt::format("a{}", i) : fmt::format("{}", i); }
  /// "start", of two fingers "start a" and "start b".
  std::string of(const std::string& what, std::size_t finger) const {
    return fingers_ == 1 ? what : what + (finger == 0 ? " a" : " b");
  }
  std::string place(double s) const { return fixed(s, decimals_); }
  /// In a text, with the unit.
  std::string at(double s) const { return place(s) + unit_; }
  std::string span(const Interval& interval) const {
    return fmt::format("from {} to {}", place(interval.lo), at(interval.hi));
  }
  std::string over_lengths(const std::string& title) const { return title_in(title, answer_.part.unit()); }
  std::string where(const Placement& placement) const {
    if (fingers_ == 1) {
      return fmt::format("s = {:.6g}, sd {:.2g}{}{}", placement.start[0], placement.sd[0], unit_, way_of(placement));
    }
    return fmt::format("finger a at s = {:.6g}, sd {:.2g}, finger b at {:.6g}, sd {:.2g}{}{}", placement.start[0],
                       placement.sd[0], placement.start[1], placement.sd[1], unit_, way_of(placement));
  }
  /// ", lengths counted cw", where that was to be found out.
  std::string way_of(const Placement& placement) const {
    if (!answer_.either_way) return "";
    return placement.clockwise ? ", lengths counted cw" : ", lengths counted ccw";
  }
  std::string more_line(std::size_t count) const {
    return count <= kMostRows ? "" : fmt::format("... and {} more; --json lists them all\n", count - kMostRows);
  }

  const Answer& answer_;
  std::size_t fingers_;
  int decimals_;
  std::string unit_;  // behind a length
};

// What an answer's text consists of, section by section.

/// The verdict with what to do next, and below it what may be wrong.
std::string verdict_lines(const Answer& answer);

/// What was asked: the part, the readings, the tolerance, the noise and what the rows are like; `verbose`: what was
/// taken as exact as well.
std::string asked_lines(const Answer& answer, bool verbose);

/// What was dropped because the fingers can't do it; `explain`: one by one.
std::string dropped_lines(const Answer& answer, bool explain);

/// The placements, with noise their probabilities; `verbose`: without noise their widths, errors, and how they move.
/// REQUIRES some.
std::string placements_table(const Answer& answer, bool verbose);

}  // namespace rollfix::app
