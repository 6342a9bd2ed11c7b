#pragma once

#include <fmt/format.h>
#include <string>

#include "documents/documents.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"
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

/// How much of an answer is told.
struct AnswerDetail {
  bool explain = false;  // what was dropped, one by one
  bool verbose = false;  // how wide placements are, how they move with what was measured, what was taken as exact
};

/// For people: the verdict, a table of the placements, what is special about some, and what was asked.
std::string answer_text(const Answer& answer, const AnswerDetail& detail);

/// What an answer tells whoever called the program.
ExitCode exit_code_of(const Solution& solution);

/// Notes on a part that is stored the other way round than its file has it, on a log that follows it, and on fingers
/// whose reach is not known.
void add_notes(const Answer& answer, Report& report);

/// "the part is at x = 1, y = 2, heading 12.000 deg; the contacts agree": the last pose. With noise "at the first
/// contact, at 0 s, the part was at x = 1 ± 0.1, ...": standard deviations.
std::string about_pose(const Placement& placement, const Answer& answer);

/// "touching at s = 1.0 the finger would hit the part at s = 2.0, ...": where a roll can't go on.
std::string about(const Obstruction& obstruction, const Part& part);

/// How far a part that was measured may be off.
std::string accuracy_text(const Accuracy& accuracy);

/// For people: the verdict, a table of the first contacts, poses, each finger, and what was asked.
std::string hold_text(const HoldAnswer& answer);

/// For people: the verdict, a table of the poses, what they leave open, and what was asked. `verbose`: with each
/// touch's place on the part.
std::string touches_text(const TouchAnswer& answer, bool verbose);

/// "scale 1.0020 ± 0.0004 (1 = as measured): they are 0.2 % longer": a scale that the rows tell. `more`, `less`: what
/// they are where it is above 1, and below.
std::string scale_text(double scale, double sd, const char* more, const char* less);

/// Lines "lengths ...", "turns ...", "bias ...": what the rows tell of the scales of lengths and turns and of a
/// gyroscope's bias, as far as the noise leaves them open.
std::string scale_lines(const Fit& fit, std::size_t fingers);

}  // namespace rollfix::app
