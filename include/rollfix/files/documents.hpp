#pragma once

#include <string>

#include "rollfix/answer/answer.hpp"
#include "rollfix/answer/next_roll.hpp"
#include "rollfix/certify/certify.hpp"
#include "rollfix/certify/pair_certificate.hpp"
#include "rollfix/certify/touch_certificate.hpp"
#include "rollfix/contact/teach.hpp"
#include "rollfix/files/inspection.hpp"

// The JSON documents that the program prints with --json, as text: docs/json.md lists their fields.
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

/// "rollfix/inspect/1".
std::string format_inspection(const Inspection& inspection, Layout layout = Layout::lines);

/// "rollfix/advise/1".
std::string format_next_roll(const NextRoll& next, Layout layout = Layout::lines);

/// "rollfix/teach/1": the inspection of the part that was taught, and how it was.
std::string format_taught(const Inspection& inspection, const Taught& taught, Layout layout = Layout::lines);

}  // namespace rollfix
