#include "rollfix/outline.hpp"

#include <fmt/format.h>

#include "outline/naming.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

constexpr const char* kKnown = "points in .csv, .dat or .txt, or gallery:NAME as in gallery:ellipse,a=2,b=1";

/// "ellipse,a=2" without "gallery:", or a slip of the pen in it.
std::string gallery_hint(const std::string& argument) {
  std::vector<std::string> names;
  for (const GalleryShape& shape : gallery_shapes()) names.push_back(shape.name);
  const std::string nearest = nearest_name(argument.substr(0, argument.find(',')), names);
  return nearest.empty() ? "" : fmt::format("; did you mean gallery:{}?", nearest);
}

}  // namespace

std::string unknown_ending(const std::string& path, const std::string& known) {
  const std::string ending = ending_of(path);
  if (ending == ".gz") return fmt::format("{}: is compressed, expected plain text: gunzip -k {}", path, path);
  const std::string found = ending.empty() ? "has no ending" : fmt::format("has the unknown ending '{}'", ending);
  return fmt::format("{}: {}, expected {}{}", path, found, known, gallery_hint(path));
}

Outline load_outline(const std::string& argument, const OutlineOptions& options, std::vector<std::string>* notes) {
  if (argument.rfind("gallery:", 0) == 0) {
    Outline outline = gallery(argument);
    outline.name = argument;
    outline.unit = options.unit;
    return outline;
  }
  const std::string ending = ending_of(argument);
  if (argument == "-" || ending == ".csv" || ending == ".dat" || ending == ".txt") {
    OutlineOptions known = options;
    const std::vector<Vec2> points = read_points(argument, options, notes, &known.unit, &known.airfoil);
    return outline_through(points, argument, known, notes);
  }
  if (ending == ".json" || ending == ".dxf" || ending == ".svg") {
    throw InputError(
        fmt::format("{}: {} files are read by the library rollfix::files, as load_part(\"{}\", {{}}).part of "
                    "<rollfix/files.hpp>; here expected {}",
                    argument, ending, argument, kKnown));
  }
  throw InputError(unknown_ending(argument, kKnown));
}

}  // namespace rollfix
