#include "files/file_kind.hpp"

#include <cstddef>

#include "outline/naming.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files/saved_part.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

constexpr const char* kKnown =
    "points in .csv, .dat or .txt, a drawing in .dxf or .svg, a shape or a saved part in .json, or gallery:NAME as in "
    "gallery:ellipse,a=2,b=1";

constexpr std::string_view kBinaryDxf = "AutoCAD Binary DXF";

FileKind kind_by_beginning(std::string_view text) {
  if (text.substr(0, kBinaryDxf.size()) == kBinaryDxf) return FileKind::dxf;
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return FileKind::points;
  if (text[first] == '<') return FileKind::svg;
  if (text[first] == '{') return FileKind::json;
  // An ASCII DXF begins with a group code, alone on its line, and SECTION; or with a 999 comment.
  const std::size_t line_end = text.find_first_of("\r\n", first);
  const std::string_view code = text.substr(first, line_end == std::string_view::npos ? line_end : line_end - first);
  const std::string_view head = text.substr(0, 4096);
  const bool is_code = code == "0" || code == "999";
  return is_code && head.find("SECTION") != std::string_view::npos ? FileKind::dxf : FileKind::points;
}

}  // namespace

FileKind kind_by_name(const std::string& argument) {
  if (argument.rfind("gallery:", 0) == 0) return FileKind::gallery;
  if (argument == "-") return FileKind::points;
  const std::string ending = ending_of(argument);
  if (ending == ".csv" || ending == ".dat" || ending == ".txt") return FileKind::points;
  if (ending == ".dxf") return FileKind::dxf;
  if (ending == ".svg") return FileKind::svg;
  if (ending == ".json") return FileKind::json;
  throw InputError(unknown_ending(argument, kKnown));
}

FileKind kind_by_content(FileKind by_name, bool is_standard_input, std::string_view text) {
  const FileKind kind = is_standard_input ? kind_by_beginning(text) : by_name;
  return kind == FileKind::json && is_saved_part(text) ? FileKind::saved_part : kind;
}

}  // namespace rollfix
