#pragma once

#include <string>

#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::app {

/// Adds the certificate of an answer as a file of this name, or, where it is "-", in place of the data. The exit code
/// says where it leaves something unproved. Throws InputError: what certificates can't be of.
void add_certificate(const std::string& file, bool force, const Problem& problem, const Answer& answer, Report& report);

/// The same of an answer to touches.
void add_certificate(const std::string& file, bool force, const TouchProblem& problem, const TouchAnswer& answer,
                     Report& report);

/// The same of three and more fingers, and of fingers beside wheels.
void add_certificate(const std::string& file, bool force, const HoldProblem& problem, const HoldAnswer& answer,
                     Report& report);

/// Throws InputError where --certify can't be followed, before any work.
void require_certificate(const std::string& file, bool force, bool json, const std::string& output);

}  // namespace rollfix::app
