#include "rollfix/finger_argument.hpp"

#include <fmt/format.h>

#include "rollfix/error.hpp"
#include "rollfix/typed_number.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kJaw = "jaw";

DiskFinger read_disk(const std::string& text) {
  const std::string what = fmt::format("--finger {}", text);
  const std::vector<std::string_view> fields = split(text, ',');
  const bool is_disk = fields.size() == 2 && fields[0] == "disk" && fields[1].substr(0, 2) == "r=";
  if (!is_disk) throw InputError(what + ": expected a disk with its radius, as in disk,r=0.1, or jaw");
  const DiskFinger finger{read_number(fields[1].substr(2), what)};
  try {
    require_valid(finger);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", what, error.what()));
  }
  return finger;
}

FingerShape read_any(const std::string& text) {
  if (text == kJaw) return {};
  return {read_disk(text)};
}

/// What reads logs and writes them knows disks only.
DiskFinger require_disk(const std::string& text) {
  if (text == kJaw) {
    throw InputError(
        "--finger jaw: a flat jaw is known to --reading and to inspect only; expected a disk with its radius here, as "
        "in disk,r=0.1");
  }
  return read_disk(text);
}

void require_one(const std::vector<std::string>& fingers) {
  if (fingers.size() <= 1) return;
  throw InputError("--finger is given twice, which is two fingers, and the rest is about one; leave one out");
}

void require_at_most_two(const std::vector<std::string>& fingers) {
  if (fingers.size() <= 2) return;
  throw InputError(fmt::format("--finger is given {} times, expected at most two fingers", fingers.size()));
}

}  // namespace

std::string FingerShape::name() const { return disk ? fmt::format("disk,r={}", disk->radius) : kJaw; }

void add_finger_argument(CLI::App& command, std::vector<std::string>& fingers) {
  command
      .add_option(
          "--finger", fingers,
          "the finger: disk,r=RADIUS, in the outline's unit, or jaw, a flat one; for two fingers once or, where they "
          "differ, twice")
      ->type_name("FINGER")
      ->allow_extra_args(false);
}

std::optional<DiskFinger> read_finger(const std::vector<std::string>& fingers) {
  if (fingers.empty()) return std::nullopt;
  require_one(fingers);
  return require_disk(fingers.front());
}

std::optional<FingerPair> read_fingers(const std::vector<std::string>& fingers) {
  if (fingers.empty()) return std::nullopt;
  require_at_most_two(fingers);
  return FingerPair{require_disk(fingers.front()), require_disk(fingers.back())};
}

std::optional<FingerShape> read_shape(const std::vector<std::string>& fingers) {
  if (fingers.empty()) return std::nullopt;
  require_one(fingers);
  return read_any(fingers.front());
}

std::optional<std::array<FingerShape, 2>> read_shapes(const std::vector<std::string>& fingers) {
  if (fingers.empty()) return std::nullopt;
  require_at_most_two(fingers);
  return std::array<FingerShape, 2>{read_any(fingers.front()), read_any(fingers.back())};
}

}  // namespace rollfix::app
