#pragma once

// What the tests of figures share: parts with known shape, hand-made searches, and a reader for the SVG that we write.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/draw.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace draw_test {

inline rollfix::Part gallery_part(const std::string& name) { return rollfix::Part(rollfix::gallery(name)); }

/// A circle with small bumps: a spline through `count` points with many corners, inflections and vertices.
inline rollfix::Part bumpy_part(int count) {
  std::vector<rollfix::Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, radius = 1 + 2.0 / count * std::sin(2.3 * i);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return rollfix::Part({"bumpy", rollfix::spline_through(points, true), true, false});
}

/// Crossings at these starts.
inline std::vector<rollfix::Placement> found_at(const rollfix::Part& part, const std::vector<double>& starts,
                                                double length) {
  std::vector<rollfix::Placement> placements;
  for (const double start : starts) {
    rollfix::Placement placement;
    placement.start = start;
    placement.end = rollfix::Boundary{part.perimeter(), true}.base(start + length);
    placement.extent = rollfix::Interval{start, start};
    placement.roots.push_back(start);
    placement.point = part.point(start);
    placement.tangent = part.tangent(start);
    placements.push_back(placement);
  }
  return placements;
}

/// A figure with the answer that it shows.
struct Figure {
  rollfix::Answer answer;
  std::optional<std::size_t> highlight{};
  std::vector<std::size_t> numbers{};

  rollfix::AnswerFigure figure() const { return {&answer, highlight, numbers}; }
  std::string str() const {
    Figure with_verdict = *this;
    rollfix::Search search;
    search.placements = answer.placements;
    with_verdict.answer.verdict = search.verdict();
    return rollfix::draw_answer(with_verdict.figure()).str();
  }
};

/// A figure of `count` evenly spread placements that all rolled the same fraction of the perimeter.
inline Figure figure_with(const rollfix::Part& part, int count, double fraction) {
  Figure figure{{part}};
  std::vector<double> starts;
  for (int i = 0; i < count; ++i) starts.push_back(part.perimeter() * i / count);
  figure.answer.readings = {{fraction * part.perimeter(), 1.0}};
  figure.answer.placements = found_at(part, starts, fraction * part.perimeter());
  return figure;
}

inline int count_of(const std::string& text, const std::string& piece) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(piece, at)) != std::string::npos; at += piece.size()) ++count;
  return count;
}

/// What is wrong with a document's tags, or "" where they nest as XML wants. Text may hold no bare < or &.
inline std::string nesting_error(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '&') {
      const std::size_t end = text.find(';', at);
      const std::string name = text.substr(at + 1, end - at - 1);
      if (name != "amp" && name != "lt" && name != "gt" && name != "quot") return "bare ampersand before " + name;
      at = end + 1;
    } else if (text[at] != '<') {
      ++at;
    } else {
      const std::size_t end = text.find('>', at);
      if (end == std::string::npos) return "tag without an end";
      const std::string tag = text.substr(at + 1, end - at - 1);
      if (tag.empty() || tag.find('<') != std::string::npos) return "bare < before " + tag;
      if (count_of(tag, "\"") % 2 != 0) return "open quote in " + tag;
      if (tag[0] == '/') {
        if (open.empty() || open.back() != tag.substr(1)) return "unexpected " + tag;
        open.pop_back();
      } else if (tag[0] != '?' && tag.back() != '/') {
        open.push_back(tag.substr(0, tag.find(' ')));
      }
      at = end + 1;
    }
  }
  return open.empty() ? "" : "never closed: " + open.back();
}

/// The points of the first path in each group of this class.
inline std::vector<std::vector<rollfix::Vec2>> paths_in(const std::string& svg, const std::string& group) {
  std::vector<std::vector<rollfix::Vec2>> paths;
  const std::string start = "<g class=\"" + group + "\">";
  for (std::size_t at = 0; (at = svg.find(start, at)) != std::string::npos; ++at) {
    const std::size_t begin = svg.find(" d=\"", at) + 4;
    std::vector<rollfix::Vec2> points;
    const char* text = svg.c_str() + begin;
    while (*text == 'M' || *text == 'L' || *text == 'Z') {
      if (*text++ == 'Z') continue;
      char* rest = nullptr;
      const double x = std::strtod(text, &rest), y = std::strtod(rest, &rest);
      points.emplace_back(x, y);
      text = rest;
    }
    paths.push_back(points);
  }
  return paths;
}

}  // namespace draw_test
