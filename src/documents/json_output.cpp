#include "documents/json_output.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "text/text.hpp"

namespace rollfix {
namespace {

/// The number of a character below U+10000 in UTF-8.
unsigned code_point(std::string_view character) {
  constexpr unsigned kLeadBits[] = {0, 0x7F, 0x1F, 0x0F};
  unsigned code = static_cast<unsigned char>(character.front()) & kLeadBits[character.size()];
  for (const char c : character.substr(1)) code = code << 6U | (static_cast<unsigned char>(c) & 0x3FU);
  return code;
}

/// On one line. File names may hold bytes that are no text; JSON can't. What JSON lets pass and a terminal obeys is
/// escaped.
std::string compact(const Json& value) {
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string result;
  result.reserve(text.size());
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view character = rest.substr(0, std::max<std::size_t>(utf8_length(rest), 1));
    is_control(character) ? result += fmt::format("\\u{:04x}", code_point(character)) : result += character;
    rest.remove_prefix(character.size());
  }
  return result;
}

std::string value_text(const Json& value) {
  if (!value.is_array() || value.empty() || !value.front().is_object()) return compact(value);
  std::string text = "[";
  for (const Json& entry : value) {
    if (&entry != &value.front()) text += ',';
    text += "\n    " + compact(entry);
  }
  return text + "\n  ]";
}

}  // namespace

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_interval(const Interval& interval) {
  return Json::array({json_number(interval.lo), json_number(interval.hi)});
}

std::string json_line(const Json& document) { return compact(document) + '\n'; }

std::string json_text(const Json& document) {
  std::string text = "{";
  bool is_first = true;
  for (const auto& [key, value] : document.items()) {
    if (!is_first) text += ',';
    is_first = false;
    text += "\n  " + compact(Json(key)) + ": " + value_text(value);
  }
  return text + "\n}\n";
}

}  // namespace rollfix
