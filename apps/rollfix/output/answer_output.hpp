#pragma once

#include <string>

#include "rollfix/answer/answer.hpp"
#include "rollfix/output/json_output.hpp"
#include "rollfix/output/report.hpp"

namespace rollfix::app {

/// The contract's "rollfix/locate/1"; docs/json.md lists the fields. `explain`: with what the fingers can't do.
Json answer_json(const Answer& answer, bool explain);

/// For people: the verdict, what was asked, a table of the placements, and what is special about some.
std::string answer_text(const Answer& answer, bool explain);

/// What an answer tells whoever called the program.
ExitCode exit_code_of(const Answer& answer);

/// Notes on a part that is stored the other way round than its file has it, on a log that follows it, and on fingers
/// whose reach is not known.
void add_notes(const Answer& answer, Report& report);

/// "the part is at x = 1, y = 2, heading 12.000 deg; the contacts agree": the last pose. With noise "at the first
/// contact, at 0 s, the part was at x = 1 ± 0.1, ...": standard deviations.
std::string about_pose(const Placement& placement, const Answer& answer);

/// "touching at s = 1.0 the finger would hit the part at s = 2.0, ...": where a roll can't go on.
std::string about(const Obstruction& obstruction, const Part& part);

/// What would have to be otherwise for something to fit; empty where something does.
std::string about(const Diagnosis& diagnosis);
const char* name_of(Cause cause);
/// What to give instead, with these fingers and this noise as given.
std::string cure_of(const Diagnosis& diagnosis, const std::vector<Finger>& fingers, const Noise& noise);

/// What --json says of a part (`inspect` says more), of diagnoses (null where the rows fit) and of noise.
Json part_json(const Part& part);
Json diagnoses_json(const std::vector<Diagnosis>& diagnoses, const std::vector<Finger>& fingers, const Noise& noise);
Json noise_json(const Noise& noise);
/// null without; x and y are null where only the heading is known.
Json pose_prior_json(const std::optional<PosePrior>& prior);

/// How far a part that was measured may be off, as text and as JSON; null where it is exact.
std::string accuracy_text(const Accuracy& accuracy);
Json accuracy_json(const Accuracy& accuracy);

}  // namespace rollfix::app
