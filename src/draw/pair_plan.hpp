#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "answer_figure.hpp"
#include "legend.hpp"
#include "plot.hpp"
#include "rolls.hpp"
#include "scene.hpp"

namespace rollfix::draw {

/// One equation f(s, t) = 0 of a figure of pairs: a reading's, or the facing.
struct PairLine {
  std::optional<std::size_t> reading;  // none: the facing
  std::string_view colour;
  std::string dash;
  Text name;
};

/// Everything about a figure of pairs that is decided before it is drawn.
struct PairPlan {
  const AnswerFigure* figure = nullptr;
  std::optional<std::size_t> shown;  // the placement whose rolls are drawn
  std::array<Roll, 2> rolls;         // of either finger
  Lanes lanes;                       // of the shown placement's two rolls
  Framing framing;                   // of the part, at the left
  Axes plane;                        // of the pairs, at the right
  std::vector<PairLine> lines;       // what the plane shows

  const Part& part() const { return figure->answer->part; }
  const std::vector<Placement>& placements() const { return figure->answer->placements; }
  bool has_numbers() const;

  /// Distance in pixels from the boundary of a run of the shown placement, `travelled` along the run.
  double offset(std::size_t finger, const Run& run, double travelled) const;
  /// Whether contact k = 0, 1, 2, ... has a name of its own (the first and the last have in any case).
  bool is_named(std::size_t k) const;
};

/// Throws InputError: no part, or a highlight that is out of range. The figure has to outlive the plan.
PairPlan pair_plan_of(const AnswerFigure& figure);

/// The figure of two fingers.
Svg draw_pairs(const AnswerFigure& figure);

inline constexpr std::array<std::string_view, 2> kFingerColours = {kPalette[0], kPalette[1]};

/// The name of contact k of a finger: s_0, t_2.
Text pair_contact(std::size_t finger, std::size_t k);

/// What lies below the drawing: both fingers' contacts and the equations.
Legend pair_legend(const PairPlan& plan);

/// The square of all pairs with its lines and placements.
void draw_pair_plane(Svg& svg, const PairPlan& plan);

}  // namespace rollfix::draw
