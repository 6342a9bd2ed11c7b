#include "rollfix/watch_writer.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <ostream>
#include <utility>

#include "rollfix/error.hpp"

namespace rollfix::app {

std::string name_of(WatchEnd end) {
  switch (end) {
    case WatchEnd::stream:
      return "end of input";
    case WatchEnd::signal:
      return "stopped";
    case WatchEnd::idle:
      break;
  }
  return "nothing more came";
}

WatchWriter::WatchWriter(std::ostream& out, std::ostream& err, std::function<bool()> is_ready)
    : out_(out), err_(err), is_ready_(std::move(is_ready)) {}

void WatchWriter::note(const std::string& message) {
  const std::optional<std::size_t> left_out = limit_.allow(Clock::now());
  if (!left_out) return;
  if (*left_out > 0) err_ << fmt::format("rollfix: ... {} such lines were left out here\n", *left_out);
  err_ << "rollfix: " << message << std::endl;
}

void WatchWriter::write(const std::string& lines) {
  out_ << std::exchange(announced_, "") << lines << std::flush;
  if (!out_) throw InputError("standard output can't be written to");
}

void WatchWriter::show() {
  if (!announced_.empty()) write("");
}

bool standard_output_is_ready() {
  pollfd output = {STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&output, 1, 0) != 0;  // errors are for the one who writes
}

}  // namespace rollfix::app
