#include "rollfix/finger_argument.hpp"

#include <fmt/format.h>

#include "rollfix/error.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
namespace {

DiskFinger read_disk(const std::string& text) {
  const std::string what = fmt::format("--finger {}", text);
  const std::vector<std::string_view> fields = split(text, ',');
  const bool is_disk = fields.size() == 2 && fields[0] == "disk" && fields[1].substr(0, 2) == "r=";
  if (!is_disk) throw InputError(what + ": expected a disk with its radius, as in disk,r=0.1");
  const DiskFinger finger{read_number(fields[1].substr(2), what)};
  try {
    require_valid(finger);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", what, error.what()));
  }
  return finger;
}

}  // namespace

void add_finger_argument(CLI::App& command, std::vector<std::string>& fingers) {
  command
      .add_option("--finger", fingers,
                  "the finger: disk,r=RADIUS, in the outline's unit; for two fingers once or, where they differ, twice")
      ->type_name("FINGER")
      ->allow_extra_args(false);
}

std::optional<DiskFinger> read_finger(const std::vector<std::string>& fingers) {
  if (fingers.empty()) return std::nullopt;
  if (fingers.size() > 1) {
    throw InputError("--finger is given twice, which is two fingers, and the rest is about one; leave one out");
  }
  return read_disk(fingers.front());
}

std::optional<FingerPair> read_fingers(const std::vector<std::string>& fingers) {
  if (fingers.empty()) return std::nullopt;
  if (fingers.size() > 2) {
    throw InputError(fmt::format("--finger is given {} times, expected at most two fingers", fingers.size()));
  }
  return FingerPair{read_disk(fingers.front()), read_disk(fingers.back())};
}

}  // namespace rollfix::app
