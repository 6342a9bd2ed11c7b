#include "rollfix/watch_lines.hpp"

#include <utility>

namespace rollfix::app {
namespace {

constexpr std::size_t kBlock = std::size_t{64} * 1024;  // as much as a pipe holds

}  // namespace

LineSource::LineSource(ByteSource& bytes) : bytes_(bytes), block_(kBlock) {}

Heard LineSource::next(Deadline deadline) {
  note_.clear();
  for (;;) {
    if (const std::optional<ReadLine> line = buffer_.next()) return take(*line);
    if (ended_) return Heard::ended;
    Arrived arrived = bytes_.read(block_.data(), block_.size(), deadline);
    note_ = std::move(arrived.note);
    if (arrived.what == Arrival::dropped || arrived.what == Arrival::restarted) buffer_.drop_partial();
    buffer_.append(std::string_view(block_.data(), arrived.count));
    switch (arrived.what) {
      case Arrival::bytes:
        continue;
      case Arrival::nothing:
        return Heard::nothing;
      case Arrival::dropped:
        return Heard::dropped;
      case Arrival::resumed:
        return Heard::resumed;
      case Arrival::restarted:
        return Heard::restarted;
      case Arrival::ended:
        break;
    }
    ended_ = true;
    const std::optional<ReadLine> rest = bytes_.ends_whole() ? buffer_.last() : std::nullopt;
    return rest ? take(*rest) : Heard::ended;
  }
}

Heard LineSource::take(ReadLine line) {
  line_ = line;
  return Heard::line;
}

}  // namespace rollfix::app
