#include "arcs_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "plot.hpp"

namespace rollfix::draw {
namespace {

Text reading_text(const Reading& reading, const std::string& index) {
  Text text;
  const auto symbol = [&](const std::string& letter) {
    text.push_back({letter, true, false, false});
    if (!index.empty()) text.push_back({index, false, false, true});
  };
  symbol("L");
  text.push_back({" = " + pretty(reading.length[0]) + ", "});
  symbol("\u03b8");
  text.push_back({" = " + pretty_degrees(reading.turn)});
  return text;
}

Text legend_text(const Plan& plan, std::size_t i) {
  const Placement& placement = plan.placements()[i];
  Text text = contact_name(0, plan.number(i));
  if (placement.kind == Kind::stretch) {
    text.push_back({fmt::format(" in [{}, {}]", pretty(placement.extent[0].lo), pretty(placement.extent[0].hi))});
  } else {
    text.push_back({" " + pretty(placement.start[0])});
  }
  if (!plan.roll.contacts.empty()) {
    text.push_back({" \u2192 "});
    append(text, contact_name(plan.roll.contacts.size(), plan.number(i)));
    text.push_back({" " + pretty(placement.end[0])});
  }
  if (placement.kind == Kind::touching) text.push_back({" touching"});
  if (placement.kind == Kind::corner) text.push_back({" corner"});
  return text;
}

}  // namespace

Text contact_name(std::size_t k, std::size_t number) {
  const char letter = static_cast<char>('a' + std::min<std::size_t>(k, 25));
  return {{std::string(1, letter), true, false, false}, {std::to_string(number), false, false, true}};
}

Text readings_text(const std::vector<Reading>& readings) {
  const std::size_t most = 3;
  Text text;
  if (readings.size() > most) {
    text.push_back({fmt::format("{} readings, the last ", readings.size())});
    append(text, reading_text(readings.back(), ""));
    return text;
  }
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (k > 0) text.push_back({";  "});
    append(text, reading_text(readings[k], readings.size() > 1 ? std::to_string(k + 1) : ""));
  }
  return text;
}

Legend legend_of(const Plan& plan) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; plan.has_legend() && i < plan.placements().size(); ++i) {
    entries.push_back({Sign::line, plan.colour_of(i), legend_text(plan, i)});
  }
  return {std::move(entries), width_of(*plan.figure)};
}

}  // namespace rollfix::draw
