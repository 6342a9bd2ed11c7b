#include "rollfix/watch/source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "rollfix/error.hpp"

namespace rollfix::app {
namespace {

constexpr std::string_view kTcp = "tcp:";

error_code last_error() { return {errno, boost::system::generic_category()}; }

bool is_terminal(const std::string& path) {
  const int device = try_to_open(path, O_NONBLOCK);
  if (device < 0) return false;
  const bool answer = ::isatty(device) == 1;
  ::close(device);
  return answer;
}

}  // namespace

int try_to_open(const std::string& path, int more_flags) {
  return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | more_flags);
}

int open_for_reading(const std::string& path, int more_flags) {
  const int descriptor = try_to_open(path, more_flags);
  if (descriptor < 0) refuse_to_read(path, last_error());
  return descriptor;
}

void refuse_to_read(const std::string& name, const error_code& error) {
  throw InputError(fmt::format("{}: can't be read: {}", name, error.message()));
}

bool may_begin_midway(const std::string& name) {
  struct stat status = {};
  return name.starts_with(kTcp) || (name != "-" && ::stat(name.c_str(), &status) == 0 && S_ISCHR(status.st_mode));
}

std::unique_ptr<Source> open_source(const std::shared_ptr<asio::io_context>& io, const std::string& name,
                                    const SourceOptions& options, Hear hear) {
  if (name == "-") return read_descriptor(*io, STDIN_FILENO, options, std::move(hear));
  if (name.starts_with(kTcp)) return connect_tcp(io, name.substr(kTcp.size()), options, std::move(hear));
  struct stat status = {};
  if (::stat(name.c_str(), &status) != 0) {
    if (errno != ENOENT) refuse_to_read(name, last_error());
    throw InputError(
        fmt::format("{}: no such file; to wait for a log, create the file empty, or use tcp:HOST:PORT", name));
  }
  if (S_ISDIR(status.st_mode)) {
    throw InputError(fmt::format("{}: is a folder; expected a file, a serial device, - or tcp:HOST:PORT", name));
  }
  if (S_ISFIFO(status.st_mode)) return open_named_pipe(*io, name, options, std::move(hear));
  if (S_ISCHR(status.st_mode) && is_terminal(name)) return open_serial(*io, name, options, std::move(hear));
  return follow_file(*io, name, options, std::move(hear));
}

}  // namespace rollfix::app
