#include "outline/naming.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "rollfix/outline/gallery.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

/// "ellipse,a=2" without "gallery:", or a slip of the pen in it.
std::string gallery_hint(const std::string& argument) {
  std::vector<std::string> names;
  for (const GalleryShape& shape : gallery_shapes()) names.push_back(shape.name);
  const std::string nearest = nearest_name(argument.substr(0, argument.find(',')), names);
  return nearest.empty() ? "" : fmt::format("; did you mean gallery:{}?", nearest);
}

}  // namespace

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

std::string unknown_ending(const std::string& path, const std::string& known) {
  const std::string ending = ending_of(path);
  const std::string found = ending.empty() ? "has no ending" : fmt::format("has the unknown ending '{}'", ending);
  return fmt::format("{}: {}, expected {}{}", path, found, known, gallery_hint(path));
}

}  // namespace rollfix
