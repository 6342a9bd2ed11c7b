#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "draw/answer/answer_plan.hpp"
#include "draw/labels.hpp"
#include "rollfix/draw.hpp"

// What is decided about a figure of parts before it is drawn, and what is written in it.
namespace rollfix::draw {

/// What is decided about one part's panel before it is drawn.
struct PanelPlan {
  const PartsFigure::Entry* entry = nullptr;
  std::unique_ptr<AnswerFigure> figure;  // of the plan
  AnswerPlan plan;
  double scale = 1;  // pixels for each unit of the outline
  bool is_likeliest = false;
  Legend legend;  // its placements

  double legend_height() const;  // pixels, at the bottom
};

/// A row of panels of the same height, pixels.
struct RowPlan {
  double header = 0;  // the name and what is said of the part
  double body = 0;    // the part, and its placements below it
  double height() const { return header + body; }
};

/// A page of panels, filled row by row.
struct PartsPlan {
  const PartsFigure* figure = nullptr;
  double width = 0;
  std::size_t columns = 1;
  double panel_width = 0;
  bool one_scale = true;
  std::vector<PanelPlan> panels;
  std::vector<RowPlan> rows;
  std::vector<std::string> footer;  // lines

  bool has_noise() const;
  const RowPlan& row_of(std::size_t panel) const { return rows[panel / columns]; }
  /// Upper left corner of a panel on the page, pixels.
  Vec2 corner_of(std::size_t panel) const;
  /// Where the panels end.
  double grid_end() const;
};

inline constexpr double kScaleBarHeight = 22;  // below a part that has one of its own, pixels

/// Throws what draw_parts does. The figure has to outlive the plan.
PartsPlan plan_of(const PartsFigure& figure);

inline constexpr double kNoteSize = 10;  // of all but names, pixels

/// The first placements, each with its start and its end.
Legend panel_legend(const AnswerPlan& plan, double width);

/// "2 places", "any place", and what is wrong with them.
std::string places_text(const AnswerPlan& plan);

/// "can't be told from a, b and 3 more", as many names as there is room for.
std::string congruent_text(const std::vector<std::string>& names, double width);

/// "2 of 1802 parts fit"; empty: it is not known of how many.
std::string fit_text(const PartsFigure& figure);

/// The readings, which are those of all parts; of two fingers what is whose.
Text roll_text(const PartsPlan& plan);

/// What the drawings leave unsaid, as lines that fit on the page.
std::vector<std::string> footer_of(const PartsPlan& plan);

}  // namespace rollfix::draw
