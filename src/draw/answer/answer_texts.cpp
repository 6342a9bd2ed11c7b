#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "draw/answer/answer_plan.hpp"
#include "draw/answer/densities.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostPairs = 4;  // pairs with their probability in the legend
constexpr double kLeastRest = 1e-3;    // less than this is not worth a line

std::string equals(double value) { return " = " + pretty(value); }

/// One finger's reading; `index` is that of its letters, if any.
Text reading_text(const Reading& reading, const std::string& index) {
  Text text = symbol("L", index);
  text.push_back({equals(reading.length[0]) + ", "});
  append(text, symbol("\u03b8", index));
  if (reading.is_exact()) {
    text.push_back({" = " + pretty_degrees(reading.turn)});
  } else {  // on a corner of the finger
    text.push_back({" = " + pretty_degrees(reading.turn - reading.pivot) + " ... " +
                    pretty_degrees(reading.turn + reading.pivot)});
  }
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

/// With noise: where it started, give or take, and how probable that is.
Text weighed_text(const AnswerPlan& plan, const Way& way) {
  const Placement& placement = plan.placement(way);
  const double sd = placement.sd[0];
  Text text = contact_name(plan, way, 0);
  text.push_back({": " + percent(placement.probability), false, true, false});
  if (plan.is_anywhere(way.placement, 0)) {
    text.push_back({", anywhere"});
    return text;
  }
  text.push_back({fmt::format(", likeliest {}, 95 % in {} to {}", as_sure_as(placement.start[0], sd),
                              as_sure_as(placement.interval[0].lo, sd),
                              as_sure_as(plan.part().boundary().base(placement.interval[0].hi), sd))});
  const std::size_t last = plan.roll(way).contacts.size();
  if (last > 0) {
    text.push_back({"; "});
    append(text, contact_name(plan, way, last));
    text.push_back({" " + with_sd(placement.end_mean[0], placement.end_sd[0])});
  }
  if (placement.kind == Kind::corner) text.push_back({"; corner"});
  return text;
}

Text placement_text(const AnswerPlan& plan, const Way& way) {
  if (plan.has_noise()) return weighed_text(plan, way);
  const Placement& placement = plan.placement(way);
  const std::size_t last = plan.roll(way).contacts.size();
  Text text = contact_name(plan, way, 0);
  if (placement.kind == Kind::stretch) {
    text.push_back({fmt::format(" in [{}, {}]", pretty_on(plan.part(), placement.extent[0].lo),
                                pretty_on(plan.part(), placement.extent[0].hi))});
  } else {
    text.push_back({" " + pretty_on(plan.part(), placement.start[0])});
  }
  if (last > 0) {
    text.push_back({" \u2192 "});
    append(text, contact_name(plan, way, last));
    text.push_back({" " + pretty_on(plan.part(), placement.end[0])});
  }
  if (placement.kind == Kind::touching) text.push_back({" touching"});
  if (placement.kind == Kind::corner) text.push_back({" corner"});
  return text;
}

/// With noise: how probable a pair is, and where each finger started.
Text pair_text(const AnswerPlan& plan, std::size_t k) {
  const Placement& placement = plan.placements()[k];
  Text text{{fmt::format("{}: {}", k, percent(placement.probability)), false, true, false}};
  text.push_back({", 95 %: "});
  for (const std::size_t finger : {0U, 1U}) {
    const Interval& held = placement.interval[finger];
    const double sd = placement.sd[finger];
    if (finger == 1) text.push_back({", "});
    append(text, contact_name(plan, {k, finger}, 0));
    text.push_back({plan.is_anywhere(k, finger) ? " anywhere"
                                                : fmt::format(" {} to {}", as_sure_as(held.lo, sd),
                                                              as_sure_as(plan.part().boundary().base(held.hi), sd))});
  }
  return text;
}

Text finger_text(const AnswerPlan& plan, std::size_t finger) {
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

Text line_text(const AnswerPlan& plan, const PairLine& line) {
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

Text contact_name(const AnswerPlan& plan, const Way& way, std::size_t k) {
  if (plan.has_pairs()) return symbol(way.finger == 0 ? "s" : "t", std::to_string(k));
  const char letter = static_cast<char>('a' + std::min<std::size_t>(k, 25));
  return symbol(std::string(1, letter), std::to_string(plan.number(way.placement)));
}

Text start_name(const AnswerPlan& plan, const Way& way) {
  Text text = contact_name(plan, way, 0);
  const bool is_one_of_many = plan.has_noise() && !plan.has_pairs() && plan.placements().size() > 1;
  if (is_one_of_many) text.push_back({" " + percent(plan.placement(way).probability)});
  return text;
}

Text small_print(const AnswerPlan& plan) {
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

Legend legend_of(const AnswerPlan& plan) {
  std::vector<LegendEntry> entries;
  if (plan.has_pairs()) {
    for (std::size_t finger = 0; finger < 2 && !plan.ways.empty(); ++finger) {
      entries.push_back({Sign::line, kFingerColours[finger], finger_text(plan, finger)});
    }
    for (std::size_t k = 0; plan.has_noise() && k < std::min(plan.placements().size(), kMostPairs); ++k) {
      entries.push_back({Sign::area, kEllipseFill, pair_text(plan, k)});
    }
    for (const PairLine& line : plan.lines) {
      entries.push_back({Sign::line, line.colour, line_text(plan, line), line.dash});
    }
  } else if (plan.has_list()) {
    for (const Way& way : plan.ways) {
      entries.push_back({Sign::line, plan.colour_of(way), placement_text(plan, way)});
    }
  }
  if (plan.has_noise() && plan.figure->answer->weighing->rest >= kLeastRest) {
    entries.push_back({Sign::line, kSoftInk, {{"elsewhere: " + percent(plan.figure->answer->weighing->rest)}}});
  }
  return {std::move(entries), plan.width()};
}

}  // namespace rollfix::draw
