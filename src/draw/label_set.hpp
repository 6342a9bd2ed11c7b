#pragma once

#include <string_view>
#include <vector>

#include "labels.hpp"
#include "rollfix/draw/svg.hpp"

namespace rollfix::draw {

/// Labels that wait until everything they have to keep clear of is drawn.
class LabelSet {
 public:
  /// `anchors`: the places the label may stand at; `normal`: a direction away from the lines there.
  void add(std::vector<Vec2> anchors, const Vec2& normal, Text text, std::string_view colour, double size);

  /// Draws them all, with a thin line to the anchor where one had to stand off.
  void draw(Svg& svg, Obstacles& obstacles) const;

 private:
  struct Label {
    Text text;
    std::string_view colour;
    double size;
  };
  std::vector<Label> labels_;
  std::vector<LabelRequest> requests_;
};

}  // namespace rollfix::draw
