#include "rollfix/watch_source.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "rollfix/error.hpp"
#include "rollfix/watch_descriptor.hpp"

namespace rollfix::app {
namespace {

constexpr std::string_view kTcp = "tcp:";

bool is_terminal(const std::string& path) {
  const Descriptor device = open_for_reading(path, O_NONBLOCK);
  return device.is_open() && ::isatty(device.number()) == 1;
}

}  // namespace

std::unique_ptr<ByteSource> open_source(const std::string& name, const SourceOptions& options, const StopSignal& stop) {
  if (name == "-") return read_descriptor(STDIN_FILENO, stop);
  if (name.starts_with(kTcp)) return connect_tcp(name.substr(kTcp.size()), options.once, stop);
  struct stat status = {};
  if (::stat(name.c_str(), &status) != 0) {
    if (errno != ENOENT) refuse_to_read(name, errno);
    throw InputError(
        fmt::format("{}: no such file; to wait for a log, create the file empty, or use tcp:HOST:PORT", name));
  }
  if (S_ISDIR(status.st_mode)) {
    throw InputError(fmt::format("{}: is a folder; expected a file, a serial device, - or tcp:HOST:PORT", name));
  }
  if (S_ISFIFO(status.st_mode)) return open_named_pipe(name, options.once, stop);
  if (S_ISCHR(status.st_mode) && is_terminal(name)) return open_serial(name, options, stop);
  return follow_file(name, options.once, stop);
}

}  // namespace rollfix::app
