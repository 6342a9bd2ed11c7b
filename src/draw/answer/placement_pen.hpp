#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "draw/answer/answer_plan.hpp"
#include "draw/labels.hpp"
#include "draw/rolls.hpp"

namespace rollfix::draw {

/// Draws an answer's placements at the boundary: each roll as an arc beside it with its marks and their names, of two
/// fingers those of the shown pair and dots for the others. Where there are too many for arcs, a tick at each start.
class PlacementPen {
 public:
  /// All of them have to outlive the pen.
  PlacementPen(Svg& svg, const Plan& plan, const Scene& scene, RollPen& pen, LabelSet& labels)
      : svg_(svg), plan_(plan), scene_(scene), pen_(pen), labels_(labels) {}

  void draw();

 private:
  /// The path of one run on the page, in the direction of the roll.
  struct Arc {
    std::size_t way;
    const Run* run;
    std::vector<Vec2> path;
  };

  void rolls_of_all();
  void rolls_of_both();
  void ticks();
  void dots();
  void dots_of(std::size_t finger);
  void add_arcs(std::size_t way, std::size_t most_points, std::vector<Arc>& arcs) const;
  void stems(const std::vector<Arc>& arcs);
  void lines(const std::vector<Arc>& arcs);
  void marker(const Way& way, std::size_t k);
  double marker_size(const Way& way, std::size_t k) const;
  void label(std::size_t i, std::size_t k, const std::vector<Arc>& arcs);
  /// The colour that a way is drawn in: its own, or this one; as strong as the plan says.
  std::string ink(const Way& way) const;
  std::string ink(const Way& way, std::string_view colour) const;

  Svg& svg_;
  const Plan& plan_;
  const Scene& scene_;
  RollPen& pen_;
  LabelSet& labels_;
};

}  // namespace rollfix::draw
