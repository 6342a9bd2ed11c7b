#include "rollfix/part_argument.hpp"

#include <fmt/format.h>

#include "rollfix/error.hpp"
#include "rollfix/json_part.hpp"
#include "rollfix/outline/load.hpp"
#include "rollfix/typed_number.hpp"
#include "rollfix/usage.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kStandardInput = "standard input";

OutlineOptions outline_options(const PartArgument& argument) {
  OutlineOptions options;
  options.open = argument.open;
  if (!argument.corner_angle.empty()) {
    options.corner_angle = read_angle(argument.corner_angle, "--corner-angle");
  }
  return options;
}

/// Gallery shapes know themselves whether they are open and where their corners are.
void refuse_options_for_points(const PartArgument& argument) {
  const std::string option = argument.open ? "--open" : argument.corner_angle.empty() ? "" : "--corner-angle";
  if (option.empty()) return;
  throw InputError(
      fmt::format("{} is for points, and {} is a gallery shape: leave the option out", option, argument.part));
}

bool is_gallery(const std::string& part) { return part.rfind("gallery:", 0) == 0; }

/// A message that says which file it is about.
std::string naming(const std::string& part, const std::string& message) {
  const std::string name = part == "-" ? kStandardInput : part;
  return is_gallery(part) || message.find(name) != std::string::npos ? message : fmt::format("{}: {}", name, message);
}

}  // namespace

void add_part_argument(CLI::App& command, PartArgument& argument) {
  command
      .add_option("PART", argument.part,
                  "points (.csv .dat .txt, - for stdin), gallery:NAME[,key=value...], or such a shape in .json")
      ->type_name("");
  add_switch(command, "--open", argument.open, "the points are an open curve, not a loop");
  command
      .add_option("--corner-angle", argument.corner_angle,
                  "where the points' chords turn by at least this there is a corner; default 59deg")
      ->type_name("ANGLE");
  add_switch(command, "--allow-crossing", argument.allow_crossing, "take an outline that crosses itself");
}

Part load_part(const PartArgument& argument) {
  if (argument.part.empty()) {
    throw InputError("expected a PART: a points file, or a shape as in gallery:ellipse,a=2,b=1");
  }
  const bool is_json = is_json_part(argument.part);
  if (is_json || is_gallery(argument.part)) refuse_options_for_points(argument);
  const OutlineOptions options = outline_options(argument);
  try {
    Outline outline = is_json ? load_json_part(argument.part) : load_outline(argument.part, options);
    if (argument.part == "-") outline.name = kStandardInput;
    return Part(std::move(outline), {argument.allow_crossing});
  } catch (const InputError& error) {
    throw InputError(naming(argument.part, error.what()));
  }
}

std::string reversed_note(const Part& part) {
  return fmt::format(
      "{} runs clockwise; it is stored counter-clockwise with the same first point, and --reading lengths "
      "are positive that way",
      part.name());
}

}  // namespace rollfix::app
