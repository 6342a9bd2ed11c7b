#include "rollfix/watch_reconnect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "rollfix/watch_descriptor.hpp"

namespace rollfix::app {

Arrived ReconnectingSource::read(char* block, std::size_t size, Deadline deadline) {
  if (!connected_) return try_again(deadline);
  const ReadResult result = read_when_ready(descriptor(), block, size, deadline, stop_);
  switch (result.what) {
    case ReadResult::What::bytes:
      back_off_.reset();
      return {Arrival::bytes, result.count, ""};
    case ReadResult::What::nothing:
      return {};
    case ReadResult::What::end:
      return drop("it was closed");
    case ReadResult::What::error:
      break;
  }
  return drop(std::generic_category().message(result.error));
}

Arrived ReconnectingSource::try_again(Deadline deadline) {
  stop_.sleep(std::min(deadline, next_try_));
  if (stop_.came() || Clock::now() < next_try_) return {};
  const std::string failure = connect();
  if (stop_.came()) return {};
  if (failure.empty()) {
    told_.clear();
    const bool again = was_connected_;
    set_connected();
    if (again) return {Arrival::resumed, 0, name_ + ": connected again"};
    return {Arrival::nothing, 0, name_ + ": connected"};
  }
  next_try_ = Clock::now() + back_off_.next();
  if (failure == std::exchange(told_, failure)) return {};
  return {Arrival::nothing, 0, fmt::format("{}: {}; trying again", name_, failure)};
}

Arrived ReconnectingSource::drop(const std::string& why) {
  disconnect();
  connected_ = false;
  if (once_) return {Arrival::ended, 0, ""};
  next_try_ = Clock::now() + back_off_.next();
  return {Arrival::dropped, 0, fmt::format("{}: {}; connecting again", name_, why)};
}

}  // namespace rollfix::app
