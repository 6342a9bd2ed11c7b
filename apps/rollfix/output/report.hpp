#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rollfix/output/files.hpp"

namespace rollfix::app {

/// What the program tells whoever called it (a contract: scripts depend on it).
enum class ExitCode {
  fits = 0,          // complete, and something fits; or the command did what it was asked
  nothing_fits = 1,  // complete, and nothing fits
  bad_input = 2,     // bad usage or input
  incomplete = 3,    // the search could not decide everything
  internal_error = 4
};

/// Everything that a command has to say. Commands only compute: nothing is printed or written before all is known, so
/// an error leaves nothing behind. `watch` alone prints as it goes, and reports only how it ended.
struct Report {
  std::string data;                // for stdout
  std::vector<std::string> notes;  // narration for stderr, a line each
  bool notes_first = false;        // on a terminal data is the last that is seen
  std::vector<OutputFile> files;
  ExitCode exit_code = ExitCode::fits;
};

/// A command with its arguments, ready to run.
using Command = std::function<Report()>;

}  // namespace rollfix::app
