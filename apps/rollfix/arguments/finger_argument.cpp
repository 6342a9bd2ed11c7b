#include "rollfix/arguments/finger_argument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "rollfix/arguments/typed.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/units.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kJaw = "jaw";
constexpr std::string_view kWheel = "wheel";
constexpr std::string_view kOpen = ",open";
constexpr std::string_view kPolygon = ",polygon";

/// Whether that stands at the end of a name, which loses it.
bool take_suffix(std::string& name, std::string_view suffix) {
  if (name.size() <= suffix.size() || name.substr(name.size() - suffix.size()) != suffix) return false;
  name.resize(name.size() - suffix.size());
  return true;
}

/// "did you mean disk,r=10? ", of what looks like a disk: "disc,r=10", "circle,r=10", "disk,10", "r=10".
std::string question_about(const std::vector<std::string_view>& fields) {
  std::string_view radius = fields.back();
  for (const std::string_view mark : {"r=", "radius=", "R="}) {
    if (radius.substr(0, mark.size()) == mark) radius.remove_prefix(mark.size());
  }
  if (fields.size() > 2 || !parse_length(radius)) return "";
  return fmt::format("did you mean disk,r={}? ", radius);
}

DiskFinger read_disk(const std::string& text, const std::string& unit) {
  const std::string what = fmt::format("--finger {}", text);
  const std::vector<std::string_view> fields = split(text, ',');
  const bool is_disk = fields.size() == 2 && fields[0] == "disk" && fields[1].substr(0, 2) == "r=";
  if (!is_disk) {
    throw InputError(fmt::format(
        "{}: {}expected a disk with its radius, as in disk,r=0.1, or jaw, or the file of an outline{}", what,
        question_about(fields), fields.size() == 3 ? decimal_comma_hint(text.substr(text.find('=') + 1)) : ""));
  }
  const DiskFinger finger{read_length(fields[1].substr(2), what, unit)};
  try {
    require_valid(finger);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", what, error.what()));
  }
  return finger;
}

/// "pad.csv", "pad.csv,open", "tip.csv,polygon", "gallery:stadium".
Finger read_outlined(const std::string& text, const std::string& unit) {
  LoadOptions options;
  if (unit_named(unit)) options.points.unit = unit;  // of a part in pixels, which are no length, as it is
  std::string name = text;
  for (bool is_word = true; is_word;) {
    const bool is_open = take_suffix(name, kOpen);
    const bool is_polygon = take_suffix(name, kPolygon);
    if (is_open) options.points.open = true;
    if (is_polygon) options.points.corner_angle = 0;
    is_word = is_open || is_polygon;
  }
  try {
    return Finger::outlined(rollfix::load_part(name, options).part);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--finger {}: {}", text, error.what()));
  }
}

Finger read_any(const std::string& text, const std::string& unit) {
  if (text == kJaw) return jaw();
  if (split(text, ',')[0] == kJaw)
    throw InputError(fmt::format("--finger {}: a jaw is flat: expected jaw alone", text));
  if (names_wheel(text)) {
    throw InputError(
        fmt::format("--finger {}: a wheel has no skin: locate, watch and advise take it beside a finger with skin, "
                    "with a log of each, as "
                    "in --log jaw.csv --log pin.csv --finger jaw --finger {}",
                    text, text));
  }
  return names_outline(text) ? read_outlined(text, unit) : Finger(read_disk(text, unit));
}

}  // namespace

bool names_wheel(const std::string& text) { return split(text, ',')[0] == kWheel; }

double read_wheel(const std::string& text, const std::string& unit) {
  const std::string what = fmt::format("--finger {}", text);
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() != 2 || fields[1].substr(0, 2) != "r=") {
    throw InputError(fmt::format("{}: expected a wheel with its radius, as in wheel,r=0.4", what));
  }
  const double radius = read_length(fields[1].substr(2), what, unit);
  if (radius > 0 && std::isfinite(radius)) return radius;
  throw InputError(fmt::format(
      "{}: expected a wheel whose radius is a finite number above 0, found {}: give it in the outline's unit", what,
      radius));
}

bool names_outline(const std::string& text) {
  if (text.find("gallery:") == 0) return true;
  const std::size_t dot = text.rfind('.');
  return dot != std::string::npos && dot + 1 < text.size() &&
         std::isalpha(static_cast<unsigned char>(text[dot + 1])) != 0;
}

void add_finger_argument(CLI::App& command, std::vector<std::string>& fingers) {
  command
      .add_option(
          "--finger", fingers,
          "the finger: disk,r=RADIUS, in the part's unit or with a unit as in r=8mm; jaw, a flat one; or the file of "
          "a convex outline, with ,open behind it if it is open, and ,polygon if its points are the corners of a "
          "polygon; for several fingers once, or once for each if they differ; `locate`, `watch` and `advise` "
          "take wheel,r=RADIUS beside them, a wheel without skin on a pin")
      ->type_name("FINGER")
      ->allow_extra_args(false);
}

std::vector<Finger> read_fingers(const std::vector<std::string>& fingers, std::size_t most, const std::string& unit) {
  if (fingers.size() > most && most == 1) {
    throw InputError(fmt::format(
        "--finger is given {0} times, which is {0} fingers, and the rest is about one: give it once", fingers.size()));
  }
  if (fingers.size() > most) {
    throw InputError(
        fmt::format("--finger is given {} times, expected at most {}, one for each finger", fingers.size(), most));
  }
  std::vector<Finger> read;
  for (const std::string& text : fingers) read.push_back(read_any(text, unit));
  return read;
}

void require_disks(const std::vector<Finger>& fingers, const std::string& what) {
  for (const Finger& finger : fingers) {
    if (finger.is_disk()) continue;
    throw InputError(fmt::format("--finger {}: {} takes disks only, as in --finger disk,r=0.1", finger.name(), what));
  }
}

void require_owners(const std::vector<std::string>& typed, const std::vector<Finger>& fingers, bool of_disks) {
  const bool of_a = finger_of(fingers, 0)->is_disk() == of_disks;
  const bool of_b = finger_of(fingers, 1)->is_disk() == of_disks;
  if (typed.empty() || (of_a && of_b) || (typed.size() == 1 && (of_a || of_b))) return;
  const char* const option = of_disks ? "--contact-angle" : "--contact";
  const char* const kind = of_disks ? "a disk" : "a jaw or an outline";
  if (!of_a && !of_b) {
    throw InputError(of_disks ? "--contact-angle is of a disk; a jaw or an outline has --contact, an arc length"
                              : "--contact is of a jaw or an outline; a disk has --contact-angle");
  }
  throw InputError(fmt::format("{} is given twice, and only finger {} is {}; give it once, and {} for the other one",
                               option, of_a ? "a" : "b", kind, of_disks ? "--contact" : "--contact-angle"));
}

std::string no_reach_note(const Finger& finger) {
  return fmt::format(
      "whether the finger {} would hit the part elsewhere is not looked at: that is known of disks and "
      "jaws only",
      finger.name());
}

std::vector<double> read_coefficients(const std::string& text, std::size_t fingers) {
  const std::string what = "--friction " + text;
  const std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() > fingers) {
    throw InputError(fmt::format("{}: expected a coefficient for all fingers, or one for each of {}, found {}", what,
                                 fingers, fields.size()));
  }
  std::vector<double> friction;
  for (std::size_t which = 0; which < fingers; ++which) {
    friction.push_back(read_number(fields[std::min(which, fields.size() - 1)], what));
    if (friction.back() < 0) throw InputError(fmt::format("{}: expected a coefficient of at least 0", what));
  }
  return friction;
}

}  // namespace rollfix::app
