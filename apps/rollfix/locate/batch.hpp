#pragma once

#include <iosfwd>
#include <string>

#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/output/report.hpp"

namespace rollfix::app {

/// The answers to many problems, a JSON object in each line of the file, in order, on all cores: docs/json.md lists the
/// fields. They go to `out` as they come. `like` holds what a line does not say. What is wrong with a line is its
/// answer; the exit code remembers it. Throws InputError: a file that can't be read, a part that can't be loaded, an
/// output that can't be written to.
Report locate_batch(const RollArguments& like, const std::string& file, bool explain, std::ostream& out);

}  // namespace rollfix::app
