#pragma once

#include <string>

#include "documents/json_output.hpp"
#include "rollfix/output/report.hpp"

namespace rollfix::app {

/// For people: what a document of "rollfix/identify/1" says.
std::string identify_text(const Json& document, const std::string& unit);

ExitCode exit_code_of(const Json& identified);

}  // namespace rollfix::app
