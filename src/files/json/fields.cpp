#include "files/json/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "outline/box.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

constexpr const char* kPoint = "a point as in [1.5, 2]";

/// A value as it would stand in a file, cut short.
std::string found_text(const Json& value) {
  constexpr std::size_t kMost = 40;
  if (value.is_object()) return "an object";
  if (value.is_array() && value.size() > 4) return fmt::format("an array of {}", value.size());
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() > kMost ? text.substr(0, kMost) + "..." : text;
}

[[noreturn]] void refuse_from(std::size_t place, std::string_view text, const std::string& name,
                              const std::string& expected) {
  const std::size_t before = std::min(place, text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(before), '\n');
  const std::size_t newline = before == 0 ? std::string_view::npos : text.rfind('\n', before - 1);
  const std::size_t column = newline == std::string_view::npos ? before + 1 : before - newline;
  throw InputError(fmt::format("{}:{}:{}: is not JSON from here on, {}", name, line, column, expected));
}

}  // namespace

std::string quoted(const std::string& text) {
  constexpr std::size_t kMost = 40;
  std::string result = text.substr(0, kMost);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return fmt::format("'{}{}'", result, text.size() > kMost ? "..." : "");
}

Json parse_json(std::string_view text, const std::string& name, const std::string& expected) {
  // A parser would take the last of two fields of one name, and say nothing.
  std::vector<std::set<std::string>> open;
  const auto watch = [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > kMostNesting) {
      throw InputError(fmt::format("{}: its values are nested more than {} deep, {}", name, kMostNesting, expected));
    }
    if (event == Json::parse_event_t::object_start) open.emplace_back();
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event == Json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second) {
      throw InputError(fmt::format("{}: has the field {} twice in one object", name, quoted(value.get<std::string>())));
    }
    return true;
  };
  // The parser takes a byte of 0 for the end, whatever follows.
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) refuse_from(zero, text, name, expected);
  try {
    return Json::parse(text.begin(), text.end(), watch);
  } catch (const Json::parse_error& error) {
    // `byte` counts from 1 and may point behind the end.
    refuse_from(error.byte == 0 ? 0 : error.byte - 1, text, name, expected);
  } catch (const Json::exception&) {
    throw InputError(fmt::format("{}: holds a number that is out of range, {}", name, expected));
  }
}

JsonFields::JsonFields(const Json& object, std::string place) : object_(object), place_(std::move(place)) {
  if (!object_.is_object()) refuse(fmt::format("expected an object as in {{...}}, found {}", found_text(object_)));
}

void JsonFields::refuse(const std::string& message) const { throw InputError(fmt::format("{}: {}", place_, message)); }

void JsonFields::allow_only(const std::vector<std::string>& names) const {
  for (const auto& [key, value] : object_.items()) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    refuse(fmt::format("has a field {}: {}", quoted(key), known_names(key, names)));
  }
}

const Json& JsonFields::get(const char* name, const char* expected) const {
  const auto found = object_.find(name);
  if (found == object_.end()) refuse(fmt::format("expected {} as '{}', found no such field", expected, name));
  return *found;
}

std::string JsonFields::text(const char* name) const {
  const Json& value = get(name, "a text");
  if (!value.is_string()) refuse(fmt::format("{}: expected a text in quotes, found {}", name, found_text(value)));
  return value.get<std::string>();
}

bool JsonFields::flag(const char* name, bool otherwise) const {
  if (!has(name)) return otherwise;
  const Json& value = object_[name];
  if (!value.is_boolean()) refuse(fmt::format("{}: expected true or false, found {}", name, found_text(value)));
  return value.get<bool>();
}

double JsonFields::number(const char* name) const { return number_of(get(name, "a number"), name); }

int JsonFields::whole(const char* name) const {
  const double value = number(name);
  constexpr double kMost = 1e9;
  if (value != std::floor(value) || std::abs(value) > kMost) {
    refuse(fmt::format("{}: expected a whole number, found {}", name, value));
  }
  return static_cast<int>(value);
}

double JsonFields::angle(const char* name, double otherwise) const {
  if (!has(name)) return otherwise;
  const Json& value = object_[name];
  if (!value.is_string()) return number_of(value, name);
  const std::optional<double> result = parse_angle(value.get<std::string>());
  if (!result || !std::isfinite(*result)) {
    refuse(fmt::format("{}: expected an angle as in 1.27 or \"73deg\", found {}", name, found_text(value)));
  }
  return *result;
}

Vec2 JsonFields::point(const char* name) const { return point_of(get(name, kPoint), name); }

std::vector<Vec2> JsonFields::points(const char* name) const {
  std::vector<Vec2> result;
  for (const Json& value : array(name, "points as in [[0, 0], [1.5, 2]]")) {
    result.push_back(point_of(value, fmt::format("{}[{}]", name, result.size())));
  }
  return result;
}

std::vector<double> JsonFields::numbers(const char* name) const {
  std::vector<double> result;
  for (const Json& value : array(name, "numbers as in [1, 2.5]")) {
    result.push_back(number_of(value, fmt::format("{}[{}]", name, result.size())));
  }
  return result;
}

const Json& JsonFields::array(const char* name, const char* expected) const {
  const Json& value = get(name, expected);
  if (!value.is_array()) refuse(fmt::format("{}: expected {}, found {}", name, expected, found_text(value)));
  return value;
}

double JsonFields::number_of(const Json& value, const std::string& name) const {
  if (!value.is_number()) refuse(fmt::format("{}: expected a number, found {}", name, found_text(value)));
  const auto number = value.get<double>();
  if (!(std::abs(number) <= kMostCoordinate)) {
    refuse(fmt::format("{}: expected a number of at most {}, found {}", name, kMostCoordinate, found_text(value)));
  }
  return number;
}

Vec2 JsonFields::point_of(const Json& value, const std::string& name) const {
  if (!value.is_array() || value.size() != 2) {
    refuse(fmt::format("{}: expected {}, found {}", name, kPoint, found_text(value)));
  }
  const double x = number_of(value[0], name);
  return {x, number_of(value[1], name)};
}

}  // namespace rollfix
