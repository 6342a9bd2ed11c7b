#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "answer_figure.hpp"
#include "legend.hpp"
#include "rolls.hpp"
#include "scene.hpp"

namespace rollfix::draw {

/// Everything about a figure of placements that is decided before its scale is: what is shown, and on which lane.
struct Plan {
  const AnswerFigure* figure = nullptr;
  Roll roll;
  Lanes lanes;
  double spacing = 0;  // between lanes, pixels
  Framing framing;

  const Part& part() const { return figure->answer->part; }
  const std::vector<Placement>& placements() const { return figure->answer->placements; }

  bool has_arcs() const;
  bool has_labels() const;
  bool has_legend() const;
  bool has_finger(std::size_t i) const;
  /// Whether the contact at reading k has a letter of its own (the last one has in any case).
  bool is_lettered(std::size_t k) const;

  std::size_t number(std::size_t i) const { return figure->numbers.empty() ? i : figure->numbers[i]; }
  std::string_view colour_of(std::size_t i) const { return colour(number(i)); }
  double line_width(std::size_t i) const;

  /// Distance in pixels from the boundary of a run of placement i, `travelled` along the run.
  double offset(std::size_t i, const Run& run, double travelled) const;
};

/// Throws InputError: no part, or an index that is out of range. The figure has to outlive the plan.
Plan arcs_plan_of(const AnswerFigure& figure);

/// The figure of one finger.
Svg draw_arcs(const AnswerFigure& figure);

}  // namespace rollfix::draw
