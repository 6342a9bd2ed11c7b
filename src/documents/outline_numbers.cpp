#include "documents/outline_numbers.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <utility>

#include "rollfix/part.hpp"

namespace rollfix {
namespace {

/// A column: its value of a sample, and whether that is a length.
struct Column {
  const char* name;
  double (*value)(const BoundarySample&);
  bool is_length;
};
constexpr std::array<Column, 5> kColumns = {
    {{"s", [](const BoundarySample& at) { return at.s; }, true},
     {"x", [](const BoundarySample& at) { return at.point.x(); }, true},
     {"y", [](const BoundarySample& at) { return at.point.y(); }, true},
     {"tangent", [](const BoundarySample& at) { return at.tangent; }, false},
     {"curvature", [](const BoundarySample& at) { return at.curvature; }, false}}};

}  // namespace

std::string outline_table(const Part& part) {
  std::string text;
  for (const Column& column : kColumns) {
    const std::string unit = column.is_length && !part.unit().empty() ? fmt::format(" [{}]", part.unit()) : "";
    text += fmt::format("{}{}{}", text.empty() ? "" : ",", column.name, unit);
  }
  text += '\n';
  for (const BoundarySample& sample : samples_of(part)) {
    const char* separator = "";
    for (const Column& column : kColumns) {
      fmt::format_to(std::back_inserter(text), "{}{}", separator, column.value(sample));
      separator = ",";
    }
    text += '\n';
  }
  return text;
}

Json outline_json(const Part& part) {
  Json lists = Json::object();
  const std::vector<BoundarySample> samples = samples_of(part);
  for (const Column& column : kColumns) {
    Json list = Json::array();
    for (const BoundarySample& sample : samples) list.push_back(json_number(column.value(sample)));
    lists[column.name] = std::move(list);
  }
  return lists;
}

}  // namespace rollfix
