#include "outline_numbers.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include "rollfix/part/samples.hpp"

namespace rollfix {
namespace {

/// A column's name and its value of a sample.
using Column = std::pair<const char*, double (*)(const BoundarySample&)>;
constexpr std::array<Column, 5> kColumns = {{{"s", [](const BoundarySample& at) { return at.s; }},
                                             {"x", [](const BoundarySample& at) { return at.point.x(); }},
                                             {"y", [](const BoundarySample& at) { return at.point.y(); }},
                                             {"tangent", [](const BoundarySample& at) { return at.tangent; }},
                                             {"curvature", [](const BoundarySample& at) { return at.curvature; }}}};

}  // namespace

std::string outline_table(const Part& part) {
  std::string text;
  for (const auto& [name, value] : kColumns) {
    const std::string_view title = name;
    const bool is_length = title == "s" || title == "x" || title == "y";
    const std::string unit = is_length && !part.unit().empty() ? fmt::format(" [{}]", part.unit()) : "";
    text += fmt::format("{}{}{}", text.empty() ? "" : ",", title, unit);
  }
  text += '\n';
  for (const BoundarySample& sample : samples_of(part)) {
    const char* separator = "";
    for (const auto& [name, value] : kColumns) {
      fmt::format_to(std::back_inserter(text), "{}{}", separator, value(sample));
      separator = ",";
    }
    text += '\n';
  }
  return text;
}

Json outline_json(const Part& part) {
  Json lists = Json::object();
  const std::vector<BoundarySample> samples = samples_of(part);
  for (const auto& [name, value] : kColumns) {
    Json list = Json::array();
    for (const BoundarySample& sample : samples) list.push_back(json_number(value(sample)));
    lists[name] = std::move(list);
  }
  return lists;
}

}  // namespace rollfix
