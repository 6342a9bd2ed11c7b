#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/program.hpp"
#include "text/number.hpp"
#include "text/text.hpp"
#include "text/units.hpp"

namespace rollfix::app {

LoadOptions read_load_options(const PartArgument& argument) {
  LoadOptions options;
  options.points.open = argument.open;
  if (!argument.corner_angle.empty())
    options.points.corner_angle = written_angle(argument.corner_angle, "--corner-angle");
  if (!argument.smooth.empty()) options.points.smooth = written_length(argument.smooth, "--smooth");
  if (!argument.loop.empty()) options.loop = read_count(argument.loop, "--loop", 1);
  if (!argument.gap.empty()) options.gap = written_length(argument.gap, "--gap");
  options.outer = argument.outer;
  options.layer = argument.layer;
  options.points.unit = argument.unit;
  options.points.decimal_comma = has_decimal_comma(argument.decimal);
  options.allow_crossing = argument.allow_crossing;
  return options;
}

void add_unit_argument(CLI::App& command, std::string& unit) {
  command
      .add_option(
          "--unit", unit,
          "the unit of all lengths, typed and printed: mm, cm, m, in, ...; if the part's file states another unit, "
          "the part is converted; if it states none, its numbers are in this unit")
      ->type_name("UNIT");
}

void add_decimal_argument(CLI::App& command, std::string& decimal) {
  if (command.get_option_no_throw("--decimal") != nullptr) return;
  command
      .add_option(
          "--decimal", decimal,
          "the decimal mark of numbers in files: a comma or a point; give it for commas if blanks or tabs separate the "
          "columns; between semicolons commas are recognised")
      ->type_name("MARK");
}

std::optional<bool> has_decimal_comma(const std::string& decimal) {
  if (decimal.empty()) return std::nullopt;
  if (decimal == "," || decimal == ".") return decimal == ",";
  throw InputError(fmt::format("--decimal {}: expected a comma or a point, as in --decimal ,", decimal));
}

void add_part_argument(CLI::App& command, PartArgument& argument) {
  command
      .add_option("PART", argument.part,
                  "points (.csv .dat .txt), a drawing (.dxf .svg), a shape or a saved part (.json), - for stdin, or "
                  "gallery:NAME[,key=value...]")
      ->type_name("");
  command.add_option("--loop", argument.loop, "which loop of a drawing, as inspect lists them; default 1, the largest")
      ->type_name("N");
  add_load_arguments(command, argument);
}

void add_load_arguments(CLI::App& command, PartArgument& argument) {
  command
      .add_option(
          "--gap", argument.gap,
          "ends of a drawing's curves meet if they are this close together; default a millionth of its diagonal")
      ->type_name("LENGTH");
  add_switch(command, "--outer", argument.outer,
             "where more than two ends of a drawing's curves meet, take those around the outside");
  command.add_option("--layer", argument.layer, "take only this layer of a DXF")->type_name("NAME");
  add_switch(command, "--open", argument.open, "the points or curves have two ends and are not a loop");
  command
      .add_option("--corner-angle", argument.corner_angle,
                  "there is a corner where the points' chords turn by at least this angle; default 59deg")
      ->type_name("ANGLE");
  command
      .add_option("--smooth", argument.smooth,
                  "the points are a scan: stay within this length of each, and leave out noise and pixel stairs")
      ->type_name("TOL");
  add_unit_argument(command, argument.unit);
  add_decimal_argument(command, argument.decimal);
  add_switch(command, "--allow-crossing", argument.allow_crossing, "accept an outline that crosses itself");
}

void require_part(const PartArgument& argument) {
  if (!argument.part.empty()) return;
  throw InputError("expected a PART: a file with points, a drawing or a saved part, or gallery:ellipse,a=2,b=1");
}

LoadedPart load(const PartArgument& argument) {
  require_part(argument);
  return rollfix::load_part(argument.part, read_load_options(argument));
}

std::vector<Outline> other_loops(const LoadedPart& loaded) {
  std::vector<Outline> others;
  for (std::size_t k = 0; k < loaded.loops.size(); ++k) {
    if (k + 1 != loaded.loop) others.push_back(loaded.loops[k].outline);
  }
  return others;
}

Part load_part(const PartArgument& argument, std::vector<std::string>& notes, std::vector<Outline>* others) {
  LoadedPart loaded = load(argument);
  if (others != nullptr) *others = other_loops(loaded);
  notes.insert(notes.end(), loaded.notes.begin(), loaded.notes.end());
  if (loaded.loops.size() > 1 && argument.loop.empty())
    notes.push_back(fmt::format("rollfix inspect {} lists all loops", argument.part));
  return std::move(loaded.part);
}

std::string reversed_note(const Part& part) {
  if (part.outline().hole) {
    return fmt::format(
        "{} is a hole that runs counter-clockwise; it is stored clockwise, the material on its left, with "
        "the same first point, and --reading lengths are positive that way",
        part.name());
  }
  return fmt::format(
      "{} runs clockwise; it is stored counter-clockwise with the same first point, and --reading lengths "
      "are positive that way",
      part.name());
}

void add_catalog_argument(CLI::App& command, std::string& argument) {
  command.add_option("--catalog", argument, "instead of a PART: which of the parts of this catalog is it?")
      ->type_name("FILE");
}

void require_part_or_catalog(const std::string& command, const PartArgument& part, const std::string& catalog) {
  if (part.part.empty() == catalog.empty()) {
    throw InputError(command + (catalog.empty() ? ": expected a PART, or --catalog FILE, found neither"
                                                : ": expected a PART or --catalog FILE, found both"));
  }
  if (catalog.empty()) return;
  const std::string said = part.corner_angle + part.smooth + part.loop + part.gap + part.layer + part.unit;
  if (part.open || part.outer || part.allow_crossing || !said.empty()) {
    throw InputError(
        "--catalog: its parts were loaded when it was built: leave --corner-angle, --smooth, --loop, --gap, --layer, "
        "--outer, --unit, --open and --allow-crossing out");
  }
}

void require_no_prior(const std::string& prior) {
  if (!prior.empty()) throw InputError("--prior: is about a place on one part: leave it out");
}

// ---- fingers

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
                    "with a log of each, as in --log jaw.csv --log pin.csv --finger jaw --finger {}",
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
      "whether the finger {} would hit the part elsewhere is not looked at: that is known of "
      "disks and jaws only",
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
