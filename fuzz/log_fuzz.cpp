// Logs: whatever the bytes are, they give rows of one length, and readings, and a part to teach, or an InputError.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/teach.hpp"

namespace {

/// More rows only make it slower.
constexpr std::size_t kMostRows = 500;

void require(bool holds) {
  if (!holds) std::abort();
}

void teach(const rollfix::Log& log, const rollfix::DiskFinger& finger) {
  if (log.fingers.size() > 1) return;
  rollfix::TeachOptions options;
  options.finger = finger;
  options.bridge = log.rows() % 2 == 0;
  const rollfix::Taught taught = rollfix::teach(log, options);
  require(!taught.outline.curves.empty());
}
/// Line by line: whatever comes, each line is one of the kinds, and what is skipped is counted.
void stream(std::string_view text, const rollfix::DiskFinger& finger) {
  static const rollfix::Part part(rollfix::gallery("ellipse"));
  rollfix::LogStream stream("fuzz", part, {finger});
  std::size_t malformed = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    if (stream.push(text.substr(0, end)).kind == rollfix::LineKind::malformed) ++malformed;
    if (end % 17 == 0) stream.resume();
    text.remove_prefix(end);
  }
  require(stream.malformed() == malformed);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const rollfix::DiskFinger finger{0.5};
  try {
    const rollfix::Log log = rollfix::parse_log(text, "fuzz.csv");
    for (const rollfix::FingerRows& rows : log.fingers) require(log.rows() > 0 && rows.line.size() == log.rows());
    const std::vector<rollfix::Reading> readings = rollfix::readings_as_given(log, {finger});
    require(readings.size() == log.rows());
    if (log.rows() <= kMostRows) teach(log, finger);
  } catch (const rollfix::InputError&) {
  }
  try {
    stream(text, finger);
  } catch (const rollfix::InputError&) {
  }
  return 0;
}
