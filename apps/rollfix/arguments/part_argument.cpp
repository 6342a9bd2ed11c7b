#include "rollfix/arguments/part_argument.hpp"

#include <fmt/format.h>

#include <utility>

#include "rollfix/arguments/typed.hpp"
#include "rollfix/error.hpp"
#include "rollfix/usage.hpp"

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

}  // namespace rollfix::app
