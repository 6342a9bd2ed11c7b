#include "rollfix/watch_descriptor.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "rollfix/error.hpp"

namespace rollfix::app {

ReadResult read_when_ready(int descriptor, char* block, std::size_t size, Deadline deadline, const StopSignal& stop) {
  if (!stop.wait_readable(descriptor, deadline)) return {};
  const ssize_t count = ::read(descriptor, block, size);
  if (count > 0) return {ReadResult::What::bytes, static_cast<std::size_t>(count), 0};
  if (count == 0) return {ReadResult::What::end, 0, 0};
  if (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK) return {};
  return {ReadResult::What::error, 0, errno};
}

Descriptor open_for_reading(const std::string& path, int more_flags) {
  return Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | more_flags));
}

void refuse_to_read(const std::string& name, int error) {
  throw InputError(fmt::format("{}: can't be read: {}", name, std::generic_category().message(error)));
}

}  // namespace rollfix::app
