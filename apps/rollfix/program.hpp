#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "rollfix/output/report.hpp"

namespace rollfix::app {

/// The whole program: `arguments` are those after its name, the result is the exit code. Data goes to `out`,
/// narration to `err`; on an error one line to `err` and nothing else.
int run(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err);

/// The command that these arguments ask for, ready to run. Throws InputError.
Command command_of(const std::vector<std::string>& arguments);

}  // namespace rollfix::app
