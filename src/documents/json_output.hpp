#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "rollfix/curve.hpp"

namespace rollfix {

using Json = nlohmann::ordered_json;

/// A number that reads back as the same double; null for what is infinite or not a number.
Json json_number(double value);

/// A list of numbers.
template <class Numbers>
Json json_numbers(const Numbers& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(json_number(value));
  return list;
}

/// [lo, hi].
Json json_interval(const Interval& interval);

/// The text of a document: a field per line, and of a list of objects an object per line.
std::string json_text(const Json& document);

/// The same on one line.
std::string json_line(const Json& document);

}  // namespace rollfix
