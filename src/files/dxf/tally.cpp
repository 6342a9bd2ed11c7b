#include "files/dxf/tally.hpp"

#include <fmt/format.h>

#include "files/dxf/text.hpp"
#include "text/text.hpp"

namespace rollfix::dxf {

namespace {

/// As many kinds of entities are named; a file can make up any number.
constexpr std::size_t kMostNamed = 20;

std::string others_of(const Tally& tally) {
  std::string text;
  std::size_t named = 0;
  for (const auto& [kind, count] : tally.others) {
    if (named == kMostNamed) {
      text += fmt::format(" and {} more kinds", tally.others.size() - named);
      break;
    }
    text += fmt::format("{}{} {}", named == 0 ? "" : ", ", count, shown(kind));
    ++named;
  }
  return text;
}

}  // namespace

std::vector<std::string> notes_of(const Tally& tally, const std::string& layer) {
  std::vector<std::string> notes;
  const auto left_out = [&notes](std::size_t count, const std::string& what) {
    if (count > 0) notes.push_back(fmt::format("left out: {} {}", counted(count, "entity", "entities"), what));
  };
  if (!tally.others.empty()) notes.push_back("left out: " + others_of(tally));
  left_out(tally.hidden, "on layers that are off or frozen");
  left_out(tally.invisible, "marked as invisible");
  left_out(tally.paper, "in paper space");
  left_out(tally.other_layers, fmt::format("on other layers than '{}'", shown(layer)));
  if (tally.without_length > 0) {
    notes.push_back(fmt::format("left out: {} without length (between equal points or of radius 0)",
                                counted(tally.without_length, "curve", "curves")));
  }
  if (tally.wide > 0) {
    notes.push_back(fmt::format("left out: the widths of {}; their centre lines are taken",
                                counted(tally.wide, "polyline", "polylines")));
  }
  if (tally.spline_fit > 0) {
    notes.push_back(fmt::format("{} for a spline: the chords in the file are taken",
                                counted(tally.spline_fit, "polyline stands", "polylines stand")));
  }
  if (tally.fit_points > 0) {
    notes.push_back(
        fmt::format("{} fit points only: a cubic spline in chord length through them is taken, "
                    "which another program may draw differently between them",
                    counted(tally.fit_points, "spline has", "splines have")));
  }
  if (tally.repeated > 0) {
    notes.push_back(fmt::format("left out: {} of splines that repeat the one before",
                                counted(tally.repeated, "fit point", "fit points")));
  }
  return notes;
}

}  // namespace rollfix::dxf
