#include "rollfix/outline/load.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "rollfix/error.hpp"
#include "rollfix/outline/gallery.hpp"
#include "rollfix/outline/names.hpp"

namespace rollfix {

namespace {

constexpr const char* kKnown = "points in .csv, .dat or .txt, or gallery:NAME as in gallery:ellipse,a=2,b=1";

/// What follows the last dot of the file's name, in lower case: ".csv"; empty when there is none.
std::string ending_of(const std::string& path) {
  const std::size_t slash = path.find_last_of("/\\");
  const std::size_t dot = path.find_last_of('.');
  const bool has_ending = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  std::string ending = has_ending ? path.substr(dot) : "";
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

/// "ellipse,a=2" without "gallery:", or a slip of the pen in it.
std::string gallery_hint(const std::string& argument) {
  std::vector<std::string> names;
  for (const GalleryShape& shape : gallery_shapes()) names.push_back(shape.name);
  const std::string nearest = nearest_name(argument.substr(0, argument.find(',')), names);
  return nearest.empty() ? "" : fmt::format("; did you mean gallery:{}?", nearest);
}

}  // namespace

Outline load_outline(const std::string& argument, const OutlineOptions& options) {
  if (argument.rfind("gallery:", 0) == 0) {
    Outline outline = gallery(argument);
    outline.name = argument;
    return outline;
  }
  const std::string ending = ending_of(argument);
  if (argument == "-" || ending == ".csv" || ending == ".dat" || ending == ".txt") {
    return outline_through(read_points(argument, options), argument, options);
  }
  if (ending == ".json" || ending == ".dxf" || ending == ".svg") {
    throw InputError(fmt::format("{}: {} files are not supported here, expected {}", argument, ending, kKnown));
  }
  const std::string found = ending.empty() ? "has no ending" : fmt::format("has the unknown ending '{}'", ending);
  throw InputError(fmt::format("{}: {}, expected {}{}", argument, found, kKnown, gallery_hint(argument)));
}

}  // namespace rollfix
