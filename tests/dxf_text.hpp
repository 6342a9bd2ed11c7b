#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "files/formats.hpp"
#include "rollfix/error.hpp"

/// Small DXF files, written by hand.
namespace dxf_text {

/// One group: code and value, a line each.
template <class Value>
std::string group(int code, const Value& value) {
  return fmt::format("{:>3}\n{}\n", code, value);
}

using Numbers = std::vector<std::pair<int, double>>;

/// A record: its name, its layer and its numbers.
inline std::string record(const std::string& name, const Numbers& numbers, const std::string& layer = "0") {
  std::string text = group(0, name) + group(8, layer);
  for (const auto& [code, number] : numbers) {
    const bool is_whole = (60 <= code && code < 100) || (270 <= code && code < 290);
    text += is_whole ? group(code, static_cast<long long>(number)) : group(code, number);
  }
  return text;
}

inline std::string line(double x0, double y0, double x1, double y1, const std::string& layer = "0") {
  return record("LINE", {{10, x0}, {20, y0}, {11, x1}, {21, y1}}, layer);
}

inline std::string circle(double x, double y, double radius, const std::string& layer = "0") {
  return record("CIRCLE", {{10, x}, {20, y}, {40, radius}}, layer);
}

inline std::string arc(double x, double y, double radius, double start, double end, const Numbers& more = {}) {
  Numbers numbers = {{10, x}, {20, y}, {40, radius}, {50, start}, {51, end}};
  numbers.insert(numbers.end(), more.begin(), more.end());
  return record("ARC", numbers);
}

struct Corner {
  double x;
  double y;
  double bulge = 0;
};

inline std::string light_polyline(const std::vector<Corner>& corners, bool closed, const Numbers& more = {}) {
  Numbers numbers = {{90, static_cast<double>(corners.size())}, {70, closed ? 1 : 0}};
  numbers.insert(numbers.end(), more.begin(), more.end());
  for (const Corner& corner : corners) {
    numbers.insert(numbers.end(), {{10, corner.x}, {20, corner.y}});
    if (corner.bulge != 0) numbers.emplace_back(42, corner.bulge);
  }
  return record("LWPOLYLINE", numbers);
}

inline std::string polyline(const std::vector<Corner>& corners, int flags, double z = 0) {
  std::string text = record("POLYLINE", {{66, 1}, {70, flags}, {10, 0}, {20, 0}, {30, z}});
  for (const Corner& corner : corners) {
    text += record("VERTEX", {{10, corner.x}, {20, corner.y}, {30, z}, {42, corner.bulge}});
  }
  return text + record("SEQEND", {});
}

/// more: scales 41 42 43, rotation 50, columns 70, rows 71, spacings 44 45
inline std::string insert(const std::string& block, double x, double y, const Numbers& more = {},
                          const std::string& layer = "0") {
  Numbers numbers = {{10, x}, {20, y}};
  numbers.insert(numbers.end(), more.begin(), more.end());
  const std::string text = record("INSERT", numbers, layer);
  const std::size_t after_name = text.find('\n', text.find('\n') + 1) + 1;
  return text.substr(0, after_name) + group(2, block) + text.substr(after_name);
}

inline std::string block(const std::string& name, const std::string& entities, double x = 0, double y = 0) {
  return group(0, "BLOCK") + group(8, "0") + group(2, name) + group(70, 0) + group(10, x) + group(20, y) + entities +
         group(0, "ENDBLK");
}

inline std::string section(const std::string& name, const std::string& content) {
  return group(0, "SECTION") + group(2, name) + content + group(0, "ENDSEC");
}

inline std::string layer(const std::string& name, int flags = 0, int colour = 7) {
  return group(0, "LAYER") + group(2, name) + group(70, flags) + group(62, colour);
}

inline std::string layers(const std::string& records) {
  return section("TABLES", group(0, "TABLE") + group(2, "LAYER") + group(70, 9) + records + group(0, "ENDTAB"));
}

inline std::string header(const std::string& variable, int value) {
  return section("HEADER", group(9, variable) + group(70, value));
}

/// A file of these entities; `before`: sections that come before them.
inline std::string file(const std::string& entities, const std::string& before = "") {
  return before + section("ENTITIES", entities) + group(0, "EOF");
}

inline std::string with_blocks(const std::string& blocks, const std::string& entities) {
  return file(entities, section("BLOCKS", blocks));
}

inline rollfix::Drawing parsed(const std::string& text, const rollfix::files::DxfOptions& options = {}) {
  return rollfix::files::parse_dxf(text, "part.dxf", options);
}

/// What an InputError says.
inline std::string message_of(const std::string& text, const rollfix::files::DxfOptions& options = {}) {
  try {
    parsed(text, options);
  } catch (const rollfix::InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace dxf_text
