#include "draw/answer/answer_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostArcPoints = 100000;     // of all arcs of one finger together
constexpr std::size_t kMostPairArcPoints = 20000;  // of each arc of two
constexpr double kStartSize = 3.1;                 // pixels
constexpr double kPairArcWidth = 2.6;
constexpr double kDotNumberSize = 10;
constexpr double kSameDot = 3;          // dots that are closer together get one label
constexpr std::size_t kMostListed = 4;  // numbers in a label
constexpr double kFaintestInk = 0.25;   // of an improbable place's colour, the rest is paper

std::string listed(const std::vector<std::size_t>& numbers) {
  const std::size_t count = std::min(numbers.size(), kMostListed);
  std::string text = fmt::format("{}", fmt::join(numbers.begin(), numbers.begin() + static_cast<long>(count), ","));
  return numbers.size() > count ? text + "\u2026" : text;
}

/// "#rrggbb" with so much of it left on white paper. A mixed colour rather than a translucent one: where arcs and their
/// heads overlap nothing shows through.
std::string on_paper(std::string_view colour, double strength) {
  std::string mixed = "#";
  for (const std::size_t at : {1U, 3U, 5U}) {
    int channel = 0;
    std::from_chars(colour.data() + at, colour.data() + at + 2, channel, 16);
    mixed += fmt::format("{:02x}", std::lround(std::lerp(255.0, static_cast<double>(channel), strength)));
  }
  return mixed;
}

}  // namespace

void PlacementPen::draw() {
  if (plan_.has_pairs()) {
    dots();
    rolls_of_both();
  } else if (plan_.has_arcs()) {
    rolls_of_all();
  } else {
    ticks();
  }
}

std::string PlacementPen::ink(const Way& way) const { return ink(way, plan_.colour_of(way)); }

std::string PlacementPen::ink(const Way& way, std::string_view colour) const {
  if (!plan_.fades || !plan_.has_noise()) return std::string(colour);
  return on_paper(colour, std::lerp(kFaintestInk, 1, plan_.strength(way.placement)));
}

// ---- the rolls

void PlacementPen::add_arcs(std::size_t way, std::size_t most_points, std::vector<Arc>& arcs) const {
  for (const Run& run : plan_.roll(plan_.ways[way]).runs) {
    const auto offset = [&](double travelled) { return plan_.offset(way, run, travelled); };
    arcs.push_back({way, &run, pen_.path(plan_.start(plan_.ways[way]), run, offset, most_points)});
  }
}

void PlacementPen::stems(const std::vector<Arc>& arcs) {
  for (const Arc& arc : arcs) {
    const Way& way = plan_.ways[arc.way];
    pen_.stems(plan_.start(way), *arc.run, arc.path, ink(way));
  }
}

void PlacementPen::lines(const std::vector<Arc>& arcs) {
  for (const Arc& arc : arcs) {
    const Way& way = plan_.ways[arc.way];
    const double width = plan_.has_pairs() ? kPairArcWidth : plan_.line_width(way);
    pen_.arc(arc.path, ink(way), width, !plan_.roll(way).tangled);
  }
}

void PlacementPen::rolls_of_all() {
  std::vector<Arc> arcs;
  for (std::size_t i = 0; i < plan_.ways.size(); ++i) add_arcs(i, kMostArcPoints / plan_.ways.size(), arcs);
  svg_.open_group("stems");
  stems(arcs);
  svg_.close_group();
  lines(arcs);
  // The starts lie on the ends, and are smaller: both can be seen where they meet.
  for (const Way& way : plan_.ways) {
    for (std::size_t k = 1; k <= plan_.roll(way).contacts.size(); ++k) marker(way, k);
  }
  for (const Way& way : plan_.ways) marker(way, 0);
  for (std::size_t i = 0; plan_.has_labels() && i < plan_.ways.size(); ++i) {
    for (std::size_t k = 0; k <= plan_.roll(plan_.ways[i]).contacts.size(); ++k) label(i, k, arcs);
  }
}

void PlacementPen::rolls_of_both() {
  for (std::size_t i = 0; i < plan_.ways.size(); ++i) {
    std::vector<Arc> arcs;
    add_arcs(i, kMostPairArcPoints, arcs);
    stems(arcs);
    lines(arcs);
    for (std::size_t k = plan_.roll(plan_.ways[i]).contacts.size() + 1; k-- > 0;) {
      marker(plan_.ways[i], k);
      label(i, k, arcs);
    }
  }
}

/// At contact k of a way, if it has a name.
void PlacementPen::marker(const Way& way, std::size_t k) {
  if (!plan_.is_named(k)) return;
  const double s = plan_.place(way, k);
  if (k == 0) {
    pen_.start(s, ink(way), marker_size(way, k));
  } else {
    pen_.contact(s, ink(way), marker_size(way, k));
  }
}

double PlacementPen::marker_size(const Way& way, std::size_t k) const {
  if (plan_.has_pairs() && k == 0) return way.finger == 0 ? 4.8 : 3.2;
  if (plan_.has_pairs()) return way.finger == 0 ? 4.2 : 2.4;
  const double size = k == 0 ? kStartSize : k == plan_.roll(way).contacts.size() ? 3.9 : 2.6;
  return std::min(size, (1.2 + 0.35 * plan_.spacing) * size / kStartSize);  // smaller where lanes are close together
}

/// The name of contact k, at the boundary or at the end of an arc that meets it there.
void PlacementPen::label(std::size_t i, std::size_t k, const std::vector<Arc>& arcs) {
  if (!plan_.is_named(k)) return;
  const Way& way = plan_.ways[i];
  const double s = plan_.place(way, k), travelled = plan_.travelled(way, k);
  std::vector<Vec2> anchors = {scene_.at(s)};
  for (const Arc& arc : arcs) {
    if (arc.way != i) continue;
    if (arc.run->from == travelled) anchors.push_back(arc.path.front());
    if (arc.run->to == travelled) anchors.push_back(arc.path.back());
  }
  const Text name = k == 0 && !plan_.fades ? start_name(plan_, way) : contact_name(plan_, way, k);
  labels_.add(std::move(anchors), scene_.normal(s), name, plan_.colour_of(way), plan_.label_size);
}

// ---- without rolls

void PlacementPen::ticks() {
  std::map<std::string, std::vector<Vec2>> all;  // by their ink: a path each
  for (const Way& way : plan_.ways) {
    std::vector<Vec2>& ends = all[ink(way, colour(0))];
    const Vec2 at = scene_.at(plan_.start(way)), normal = scene_.normal(plan_.start(way));
    ends.emplace_back(at + 2 * normal);
    ends.emplace_back(at + 9 * normal);
  }
  svg_.open_group("starts");
  for (const auto& [shade, ends] : all) svg_.segments(ends, stroke(shade, 1));
  svg_.close_group();
}

/// First contacts of those whose rolls are not shown.
void PlacementPen::dots() {
  svg_.open_group("starts");
  for (std::size_t finger = 0; finger < 2; ++finger) dots_of(finger);
  svg_.close_group();
}

/// Numbers of dots on top of each other share a label.
void PlacementPen::dots_of(std::size_t finger) {
  std::vector<std::pair<double, std::vector<std::size_t>>> places;
  for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
    if (plan_.shown == i) continue;
    const double s = plan_.placements()[i].start[finger];
    const auto same = std::find_if(places.begin(), places.end(), [&](const auto& place) {
      return (scene_.at(place.first) - scene_.at(s)).norm() < kSameDot;
    });
    if (same != places.end()) {
      same->second.push_back(i);
    } else {
      places.push_back({s, {i}});
    }
  }
  for (const auto& [s, numbers] : places) {
    const std::string colour = ink({numbers.front(), finger});
    if (finger == 0) {
      pen_.start(s, colour, 3.6);
    } else {
      pen_.contact(s, colour, 2.4);
    }
    if (!plan_.has_labels()) continue;
    labels_.add({scene_.at(s)}, scene_.normal(s), {{listed(numbers)}}, kFingerColours[finger], kDotNumberSize);
  }
}

}  // namespace rollfix::draw
