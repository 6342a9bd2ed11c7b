#pragma once

// The JSON documents that the program prints with --json, as text: docs/json.md lists their fields.
//
//     const Part part = load_part("gallery:ellipse,a=2,b=1");
//     const Answer answer = solve({part, Reading(1.0, 0.5)});
//     const std::string text = format_answer(answer, Layout::line);
//     text.find("rollfix/locate/1") != std::string::npos;  // true
//
// Numbers are written with as many digits as bring each bit back; what is not known is null.

#include <string>
#include <vector>

#include "rollfix/advise.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/files.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/plan.hpp"
#include "rollfix/question.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/teach.hpp"
#include "rollfix/touch.hpp"

namespace rollfix {

/// How a document is laid out: a field on each line, or all of it on one.
enum class Layout { lines, line };

/// "rollfix/locate/1". `explain`: with what the fingers can't do.
std::string format_answer(const Answer& answer, Layout layout = Layout::lines, bool explain = false);

/// "rollfix/certificate/1".
std::string format_certificate(const Certificate& certificate);

/// "rollfix/pair-certificate/1".
std::string format_certificate(const PairCertificate& certificate);

/// "rollfix/touch-certificate/1".
std::string format_certificate(const TouchCertificate& certificate);

/// "rollfix/inspect/1" of the part of `loaded`, with the loops of its drawing.
std::string format_inspection(const Inspection& inspection, const LoadedPart& loaded, Layout layout = Layout::lines);

/// "rollfix/advise/1".
std::string format_next_roll(const NextRoll& next, Layout layout = Layout::lines);

/// "rollfix/teach/1": the inspection of the part that was taught, and how it was.
std::string format_taught(const Inspection& inspection, const Taught& taught, Layout layout = Layout::lines);

/// "rollfix/locate/1" of touches: docs/json.md lists its fields.
std::string format_touches(const TouchAnswer& answer, Layout layout = Layout::lines);

/// "rollfix/advise/1" of touches.
std::string format_next_touch(const TouchAnswer& answer, const NextTouch& next, Layout layout = Layout::lines);

/// "rollfix/locate/1" of three and more fingers: docs/json.md lists its fields.
std::string format_hold(const HoldAnswer& answer, Layout layout = Layout::lines);

/// "rollfix/advise/1" of how a wheel's pin moves next.
std::string format_next_pin(const HoldAnswer& held, const NextPin& next, Layout layout = Layout::lines);

/// "rollfix/hold-certificate/1".
std::string format_certificate(const HoldCertificate& certificate);

/// What to know about how a roll was understood, a sentence each: rows on corners of a finger, a way round that can't
/// be, lengths that changed their signs.
std::vector<std::string> notes_of(const Answer& answer);

/// What is wrong, and what to give instead, in plain English.
std::string words_of(const HoldDiagnosis& diagnosis, const HoldAnswer& answer);
std::string cure_of(const HoldDiagnosis& diagnosis, const HoldAnswer& answer);

/// "rollfix/locate/1" of whichever kind: docs/json.md lists its fields. `explain`: of one roll, with what the fingers
/// can't do.
std::string format_solution(const Solution& solution, Layout layout = Layout::lines, bool explain = false);

/// "rollfix/plan/1": docs/json.md lists its fields.
std::string format_plan_document(const Plan& plan, const PlanProblem& problem, Layout layout = Layout::lines);

}  // namespace rollfix
