#include "rollfix/dropped.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rollfix/locate_outcome.hpp"
#include "rollfix/table.hpp"

namespace rollfix::app {
namespace {

constexpr std::size_t kMostLines = 40;

std::string place_text(const Part& part, double s, const Vec2& point) {
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("s = {}, ({}, {})", fixed(s, decimals), fixed(point.x(), decimals), fixed(point.y(), decimals));
}

std::size_t overlaps(const Dropped<PairImpossible>& dropped) {
  return static_cast<std::size_t>(
      std::count_if(dropped.items.begin(), dropped.items.end(),
                    [](const PairImpossible& item) { return item.cause == PairImpossible::Cause::overlap; }));
}

std::string line(const std::string& what) { return fmt::format("dropped    {}\n", what); }

std::string hint(bool explain) { return explain ? "" : " (--explain lists them)"; }

template <class Items, class About>
std::string list(const Items& items, About about_item) {
  std::string text;
  for (std::size_t k = 0; k < std::min(items.size(), kMostLines); ++k) text += "  " + about_item(items[k]) + '\n';
  if (items.size() > kMostLines)
    text += fmt::format("  ... and {} more; --json lists them all\n", items.size() - kMostLines);
  return text;
}

Json obstruction_json(const Obstruction& obstruction) {
  const Json point = Json::array({json_number(obstruction.hit.point.x()), json_number(obstruction.hit.point.y())});
  if (obstruction.concave_corner)
    return {{"at", json_number(obstruction.s)}, {"cause", "concave corner"}, {"point", point}};
  return {{"at", json_number(obstruction.s)},
          {"cause", "hit"},
          {"hits", json_number(obstruction.hit.s)},
          {"point", point},
          {"depth", json_number(obstruction.hit.depth)}};
}

}  // namespace

Reach reach_of(const Part& part, const Finger& finger) {
  return finger.is_disk() ? reach_of_disk(part, finger.disk()->radius) : reach_of_jaw(part);
}

Json dropped_json(const Dropped<Impossible>& dropped) {
  if (!dropped.has_finger) return Json::object();
  return {{"reach", dropped.items.size()}};
}

Json dropped_json(const Dropped<PairImpossible>& dropped) {
  if (!dropped.has_finger) return Json::object();
  const std::size_t overlapping = overlaps(dropped);
  return {{"reach", dropped.items.size() - overlapping}, {"overlap", overlapping}};
}

Json impossible_json(const Dropped<Impossible>& dropped) {
  Json list = Json::array();
  for (const Impossible& item : dropped.items) {
    list.push_back({{"kind", name_of(item.placement.kind)},
                    {"start", Json::array({json_number(item.placement.start)})},
                    {"end", Json::array({json_number(item.placement.end)})},
                    {"extent", Json::array({json_interval(item.placement.extent)})},
                    {"reason", "reach"},
                    {"finger", 0},
                    {"obstruction", obstruction_json(item.obstruction)}});
  }
  return list;
}

Json impossible_json(const Dropped<PairImpossible>& dropped) {
  Json list = Json::array();
  for (const PairImpossible& item : dropped.items) {
    const PairPlacement& placement = item.placement;
    Json entry = {{"kind", name_of(placement.kind)},
                  {"start", json_numbers(placement.start)},
                  {"end", json_numbers(placement.end)},
                  {"extent", Json::array({json_interval(placement.extent[0]), json_interval(placement.extent[1])})}};
    if (item.cause == PairImpossible::Cause::reach) {
      entry["reason"] = "reach";
      entry["finger"] = item.finger;
      entry["obstruction"] = obstruction_json(item.obstruction);
    } else {
      entry["reason"] = "overlap";
      entry["instant"] = item.instant;
      entry["depth"] = json_number(item.depth);
    }
    list.push_back(entry);
  }
  return list;
}

std::string about(const Obstruction& obstruction, const Part& part) {
  if (obstruction.concave_corner) {
    return "the finger would roll over the concave corner at " + place_text(part, obstruction.s, obstruction.hit.point);
  }
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("touching at s = {} the finger would hit the part at {}, {} deep", fixed(obstruction.s, decimals),
                     place_text(part, obstruction.hit.s, obstruction.hit.point), rough(obstruction.hit.depth));
}

std::string dropped_text(const Dropped<Impossible>& dropped, const Part& part) {
  if (dropped.items.empty()) return "";
  const int decimals = decimals_for(part.perimeter());
  std::string text = line(fmt::format("{} that the finger can't reach{}", dropped.items.size(), hint(dropped.explain)));
  if (!dropped.explain) return text;
  return text + list(dropped.items, [&](const Impossible& item) {
           return fmt::format("start {} ({}): {}", fixed(item.placement.start, decimals), name_of(item.placement.kind),
                              about(item.obstruction, part));
         });
}

std::string dropped_text(const Dropped<PairImpossible>& dropped, const Part& part) {
  if (dropped.items.empty()) return "";
  const int decimals = decimals_for(part.perimeter());
  const std::size_t overlapping = overlaps(dropped);
  const std::size_t beyond = dropped.items.size() - overlapping;
  std::string text;
  if (beyond > 0) text += line(fmt::format("{} that a finger can't reach{}", beyond, hint(dropped.explain)));
  if (overlapping > 0) {
    text += line(fmt::format("{} whose fingers would overlap{}", overlapping, hint(dropped.explain)));
  }
  if (!dropped.explain) return text;
  return text + list(dropped.items, [&](const PairImpossible& item) {
           const std::string starts =
               fmt::format("starts {} and {} ({}): ", fixed(item.placement.start[0], decimals),
                           fixed(item.placement.start[1], decimals), name_of(item.placement.kind));
           if (item.cause == PairImpossible::Cause::reach) {
             return starts + (item.finger == 0 ? "finger a: " : "finger b: ") + about(item.obstruction, part);
           }
           const std::string when =
               item.instant == 0 ? "at the first contacts" : fmt::format("at instant {}", item.instant);
           return starts + fmt::format("the fingers would overlap by {} {}", rough(item.depth), when);
         });
}

std::string all_dropped_advice(std::size_t count) {
  return fmt::format("{} would fit, but the finger can't get there; check the finger's size, or see --explain",
                     count == 1 ? "1 placement" : fmt::format("{} placements", count));
}

}  // namespace rollfix::app
