#pragma once

#include <string>

#include "documents/documents.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::app {

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
