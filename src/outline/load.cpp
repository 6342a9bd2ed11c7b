#include "rollfix/outline/load.hpp"

#include <fmt/format.h>

#include "outline/naming.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/gallery.hpp"

namespace rollfix {

namespace {

constexpr const char* kKnown = "points in .csv, .dat or .txt, or gallery:NAME as in gallery:ellipse,a=2,b=1";

}  // namespace

Outline load_outline(const std::string& argument, const OutlineOptions& options, std::vector<std::string>* notes) {
  if (argument.rfind("gallery:", 0) == 0) {
    Outline outline = gallery(argument);
    outline.name = argument;
    return outline;
  }
  const std::string ending = ending_of(argument);
  if (argument == "-" || ending == ".csv" || ending == ".dat" || ending == ".txt") {
    return outline_through(read_points(argument, options, notes), argument, options, notes);
  }
  if (ending == ".json" || ending == ".dxf" || ending == ".svg") {
    throw InputError(
        fmt::format("{}: {} files are not supported here, expected {}; see load_part", argument, ending, kKnown));
  }
  throw InputError(unknown_ending(argument, kKnown));
}

}  // namespace rollfix
