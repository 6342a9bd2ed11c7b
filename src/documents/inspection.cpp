#include <fmt/format.h>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "documents/documents.hpp"
#include "rollfix/files.hpp"
#include "rollfix/part.hpp"

namespace rollfix {
namespace {

/// A column: its value of a sample, and whether that is a length.
struct FactColumn {
  const char* name;
  double (*value)(const BoundarySample&);
  bool is_length;
};
constexpr std::array<FactColumn, 5> kColumns = {
    {{"s", [](const BoundarySample& at) { return at.s; }, true},
     {"x", [](const BoundarySample& at) { return at.point.x(); }, true},
     {"y", [](const BoundarySample& at) { return at.point.y(); }, true},
     {"tangent", [](const BoundarySample& at) { return at.tangent; }, false},
     {"curvature", [](const BoundarySample& at) { return at.curvature; }, false}}};

Json corners_json(const Part& part) {
  Json list = Json::array();
  for (const Corner& corner : part.corners()) {
    list.push_back({{"s", json_number(corner.s)},
                    {"turn", json_number(corner.turn)},
                    {"joint", std::abs(corner.turn) < kJointTurn}});
  }
  return list;
}

Json ambiguity_json(const Inspection& inspection) {
  Json list = Json::array();
  for (const Ambiguity& entry : inspection.ambiguity) {
    list.push_back({{"length", json_number(inspection.part.perimeter() / entry.share)},
                    {"rolls", entry.rolls},
                    {"rolls_with_stretch", entry.with_stretch},
                    {"mean_placements", json_number(entry.mean_placements)},
                    {"most_placements", entry.most_placements}});
  }
  return list;
}

/// Where a pivot is not possible all the way, the angles that are.
Json pivots_json(const Reach& reach) {
  Json list = Json::array();
  for (const PivotReach& pivot : reach.pivots) {
    list.push_back({{"s", json_number(pivot.s)},
                    {"whole", json_interval(pivot.whole)},
                    {"angles", json_list(pivot.angles, json_interval)}});
  }
  return list;
}

Json reach_json(const Inspection& inspection) {
  if (!inspection.reach) return nullptr;
  return {{"finger", name_of(*inspection.finger)},
          {"share", json_number(inspection.reach->share())},
          {"arcs", json_list(inspection.reach->arcs, json_interval)},
          {"pivots", pivots_json(*inspection.reach)},
          {"slack", json_number(inspection.reach->slack)},
          {"decided", inspection.reach->decided}};
}

}  // namespace

std::string outline_table(const Part& part) {
  std::string text;
  for (const FactColumn& column : kColumns) {
    const std::string unit = column.is_length && !part.unit().empty() ? fmt::format(" [{}]", part.unit()) : "";
    text += fmt::format("{}{}{}", text.empty() ? "" : ",", column.name, unit);
  }
  text += '\n';
  for (const BoundarySample& sample : samples_of(part)) {
    const char* separator = "";
    for (const FactColumn& column : kColumns) {
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
  for (const FactColumn& column : kColumns) {
    lists[column.name] =
        json_list(samples, [&](const BoundarySample& sample) { return json_number(column.value(sample)); });
  }
  return lists;
}

std::string name_of(const Finger& finger) {
  const std::optional<DiskFinger> disk = finger.disk();
  return disk ? fmt::format("disk,r={}", disk->radius) : finger.name();
}

Json loops_json(const LoadedPart& loaded) {
  Json list = Json::array();
  for (std::size_t k = 0; k < loaded.loops.size(); ++k) {
    const Loop& loop = loaded.loops[k];
    list.push_back({{"number", k + 1},
                    {"taken", k + 1 == loaded.loop},
                    {"closed", loop.outline.closed},
                    {"hole", loop.outline.hole},
                    {"depth", loop.depth},
                    {"curves", loop.outline.curves.size()},
                    {"length", json_number(loop.length)},
                    {"area", loop.outline.closed ? json_number(loop.area) : Json(nullptr)},
                    {"gap", json_number(loop.gap)},
                    {"start", point_json(loop.outline.curves.front().front())}});
  }
  return list;
}

Json inspection_json(const Inspection& inspection) {
  const Part& part = inspection.part;
  return {{"schema", "rollfix/inspect/1"},
          {"part", part_json(part)},
          {"unit", part.unit().empty() ? Json(nullptr) : Json(part.unit())},
          {"accuracy", accuracy_json(part.outline().accuracy)},
          {"loops", Json::array()},
          {"area", part.closed() ? json_number(enclosed_area(part.outline())) : Json(nullptr)},
          {"total_turn", json_number(part.total_turn())},
          {"box", Json::array({point_json(inspection.box.lo), point_json(inspection.box.hi)})},
          {"start", {{"point", point_json(part.point(0))}, {"tangent", json_number(part.tangent(0))}}},
          {"spirals", part.turning().spirals().size()},
          {"curvature", Json::array({json_number(inspection.curvature.lo), json_number(inspection.curvature.hi)})},
          {"largest_disk", json_number(inspection.largest_disk)},
          {"symmetry", inspection.symmetry == 0 ? Json(nullptr) : Json(inspection.symmetry)},
          {"inflections", json_numbers(part.inflections())},
          {"vertices", json_numbers(part.vertices())},
          {"corners", corners_json(part)},
          {"ambiguity", ambiguity_json(inspection)},
          {"reach", reach_json(inspection)},
          {"outline", outline_json(part)}};
}

const char* name_of(Closing closing) {
  switch (closing) {
    case Closing::spread:
      return "spread";
    case Closing::bridged:
      return "bridged";
    case Closing::kept_open:
      return "kept_open";
    case Closing::not_asked:
      break;
  }
  return "open";
}

Json taught_json(const Taught& taught) {
  return {{"closing", name_of(taught.closing)},
          {"rolled", taught.rolled},
          {"lap", taught.lap},
          {"overlap", taught.overlap},
          {"turns", taught.turns},
          {"turn_gap", taught.turn_gap},
          {"turn_allowed", taught.turn_allowed},
          {"gap", taught.gap},
          {"gap_allowed", taught.gap_allowed},
          {"bridge", taught.bridge},
          {"correction", taught.correction},
          {"deviation", taught.deviation},
          {"row_sd", taught.row_sd}};
}

std::string format_inspection(const Inspection& inspection, const LoadedPart& loaded, Layout layout) {
  Json document = inspection_json(inspection);
  document["loops"] = loops_json(loaded);
  return formatted(document, layout);
}

std::string format_taught(const Inspection& inspection, const Taught& taught, Layout layout) {
  Json document = inspection_json(inspection);
  document["schema"] = "rollfix/teach/1";
  document["taught"] = taught_json(taught);
  return formatted(document, layout);
}

}  // namespace rollfix
