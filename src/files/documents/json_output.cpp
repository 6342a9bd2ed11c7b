#include "json_output.hpp"

#include <cmath>

namespace rollfix {
namespace {

/// On one line. File names may hold bytes that are no text; JSON can't.
std::string compact(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

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
