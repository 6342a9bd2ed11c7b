#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "answer_plan.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostLegend = 12;  // placements of one finger with a legend

std::string equals(double value) { return " = " + pretty(value); }

/// One finger's reading; `index` is that of its letters, if any.
Text reading_text(const Reading& reading, const std::string& index) {
  Text text = symbol("L", index);
  text.push_back({equals(reading.length[0]) + ", "});
  append(text, symbol("\u03b8", index));
  text.push_back({" = " + pretty_degrees(reading.turn)});
  return text;
}

/// Up to three readings in full, of more the last.
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

Text placement_text(const Plan& plan, const Way& way) {
  const Placement& placement = plan.placement(way);
  const std::size_t last = plan.roll(way).contacts.size();
  Text text = contact_name(plan, way, 0);
  if (placement.kind == Kind::stretch) {
    text.push_back({fmt::format(" in [{}, {}]", pretty(placement.extent[0].lo), pretty(placement.extent[0].hi))});
  } else {
    text.push_back({" " + pretty(placement.start[0])});
  }
  if (last > 0) {
    text.push_back({" \u2192 "});
    append(text, contact_name(plan, way, last));
    text.push_back({" " + pretty(placement.end[0])});
  }
  if (placement.kind == Kind::touching) text.push_back({" touching"});
  if (placement.kind == Kind::corner) text.push_back({" corner"});
  return text;
}

Text finger_text(const Plan& plan, std::size_t finger) {
  Text text{{finger == 0 ? "finger a" : "finger b"}};
  for (const Way& way : plan.ways) {
    if (way.finger != finger) continue;
    for (std::size_t k = 0; k <= plan.roll(way).contacts.size(); ++k) {
      if (!plan.is_named(k)) continue;
      text.push_back({k == 0 ? ": " : ", "});
      append(text, contact_name(plan, way, k));
      text.push_back({equals(plan.part().boundary().base(plan.place(way, k)))});
    }
  }
  return text;
}

Text line_text(const Plan& plan, const PairLine& line) {
  const Answer& answer = *plan.figure->answer;
  Text text = line.name;
  text.push_back({" = 0: "});
  if (!line.reading) {
    text.push_back({"facing " + pretty_degrees(*answer.facing)});
    return text;
  }
  const Reading& reading = answer.readings[*line.reading];
  append(text, symbol("L", "a"));
  text.push_back({equals(reading.length[0]) + ", "});
  append(text, symbol("L", "b"));
  text.push_back({equals(reading.length[1]) + ", "});
  append(text, symbol("\u03b8"));
  text.push_back({" = " + pretty_degrees(std::abs(reading.turn) < kTurnAccuracy ? 0 : reading.turn)});
  return text;
}

}  // namespace

Text contact_name(const Plan& plan, const Way& way, std::size_t k) {
  if (plan.has_pairs()) return symbol(way.finger == 0 ? "s" : "t", std::to_string(k));
  const char letter = static_cast<char>('a' + std::min<std::size_t>(k, 25));
  return symbol(std::string(1, letter), std::to_string(plan.number(way.placement)));
}

Text small_print(const Plan& plan) {
  if (!plan.has_pairs()) return readings_text(plan.figure->answer->readings);
  if (!plan.shown) return {};
  const std::size_t count = plan.placements().size();
  const bool stretch = plan.placements()[*plan.shown].kind == Kind::stretch;
  std::string text = stretch ? "the rolls of one pair of a stretch" : "the rolls of both fingers";
  if (count > 1) {
    text += fmt::format(", placement {} of 0 to {}; dots: first contacts of the others", *plan.shown, count - 1);
  }
  return {{text}};
}

Legend legend_of(const Plan& plan) {
  std::vector<LegendEntry> entries;
  if (plan.has_pairs()) {
    for (std::size_t finger = 0; finger < 2; ++finger) {
      entries.push_back({Sign::line, kFingerColours[finger], finger_text(plan, finger)});
    }
    for (const PairLine& line : plan.lines) entries.push_back({Sign::line, line.colour, line_text(plan, line)});
  } else if (plan.ways.size() <= kMostLegend) {
    for (const Way& way : plan.ways) {
      entries.push_back({Sign::line, plan.colour_of(way), placement_text(plan, way)});
    }
  }
  return {std::move(entries), plan.width()};
}

}  // namespace rollfix::draw
