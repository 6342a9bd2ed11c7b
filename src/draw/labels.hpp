#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "outline/box.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/draw.hpp"
#include "trace.hpp"

namespace rollfix::draw {

/// What labels should keep clear of, as a raster of the page.
class Obstacles {
 public:
  Obstacles(double width, double height);

  void add(const std::vector<Vec2>& polyline);
  void add_box(const Vec2& lo, const Vec2& hi);
  void add_circle(const Vec2& centre, double radius);

  /// To be called between the last `add` and the first `covered`.
  void finish();

  /// How many of the raster's cells in this box are taken; those beyond the page are.
  double covered(const Box& box) const;

  /// Where no label may stand at all, not even for want of a better place: other texts.
  void forbid(const Vec2& lo, const Vec2& hi);
  /// On the page, and nowhere forbidden.
  bool allows(const Box& box) const;

 private:
  void mark(double x, double y);

  std::ptrdiff_t columns_;
  std::ptrdiff_t rows_;
  std::vector<int> taken_;  // then the sums over all cells above and to the left
  std::vector<Box> forbidden_;
};

/// A label to be placed near one of its anchors, best straight along `normal` or against it.
struct LabelRequest {
  std::vector<Vec2> anchors;
  Vec2 normal;
  Vec2 size;
};

/// Where a label goes, and the anchor it is nearest to.
struct LabelPlace {
  Vec2 centre;
  Vec2 anchor;
};

/// Places for the labels: close to their anchors, clear of the obstacles and of one another as far as that goes.
std::vector<LabelPlace> place_labels(const std::vector<LabelRequest>& requests, const Obstacles& obstacles);

/// Labels that wait until everything they have to keep clear of is drawn.
class LabelSet {
 public:
  /// `anchors`: the places the label may stand at; `normal`: a direction away from the lines there.
  void add(std::vector<Vec2> anchors, const Vec2& normal, Text text, std::string_view colour, double size);

  /// Draws all that there is room for, those that were added first before others, with a thin line to the anchor where
  /// one had to stand off.
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
