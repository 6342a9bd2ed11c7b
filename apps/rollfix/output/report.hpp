#pragma once

#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace rollfix::app {

/// A file that is to be written.
struct OutputFile {
  std::string path;
  std::string bytes;
  bool replace = true;  // false: nothing of this name is replaced, even if it came to be meanwhile
};

/// Is there such a file already, with these very bytes?
bool holds(const OutputFile& file);

/// Throws InputError when a file of this name exists and `force` is not given, or when its folder does not exist.
/// Asked before the work starts, so that nobody waits for a refusal. Devices and pipes are always fine.
void require_writable(const std::string& path, bool force);

/// Writes all of them, each beside its final name first; only then do they take their names: whole or not at all, even
/// where the disk is full, or a signal comes.
/// Throws InputError when that is not possible, when two are one file, and when one that is not to be replaced is
/// there.
void write_files(const std::vector<OutputFile>& files);

/// The library's text for who typed options: it names the fields of its structs, `allow_crossing`, and this
/// --allow-crossing.
std::string with_options(std::string text);

/// A line on the terminal of stderr that is written over again and again, and is gone in the end.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_wanted = true) : is_shown_(is_wanted && isatty(STDERR_FILENO) != 0) {}
  ~ProgressLine() {
    if (width_ > 0) std::fprintf(stderr, "\r%*s\r", static_cast<int>(width_), "");
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool is_shown() const { return is_shown_; }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  void show(const std::string& line) {
    if (!is_shown_ || line == last_) return;
    last_ = line;
    std::fprintf(stderr, "\r%-*s", static_cast<int>(width_), line.c_str());
    std::fflush(stderr);
    width_ = std::max(width_, line.size());
  }

 private:
  bool is_shown_;
  std::string last_;
  std::size_t width_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

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
