#pragma once

#include <string_view>
#include <vector>

#include "labels.hpp"
#include "outline/box.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/part.hpp"
#include "trace.hpp"

namespace rollfix::draw {

/// From the part's coordinates to the page's: the same scale both ways, and y turned round so that it points up.
struct View {
  double scale = 1;  // pixels per unit of the outline
  Vec2 origin = Vec2::Zero();

  Vec2 operator()(const Vec2& point) const { return {origin.x() + scale * point.x(), origin.y() - scale * point.y()}; }
};

inline constexpr double kStripHeight = 24;  // below the drawing, for the scale bar, pixels

/// What has to be seen, and how much room to leave around it.
struct Framing {
  Box part;           // in the outline's unit
  double margin = 0;  // around the part, pixels: for what is drawn beside it at a fixed size
  Box extras;         // more that has to be seen, such as a finger; with only a small margin
  double width = 0;   // of the drawing, pixels
  double least_height = 0;
  double most_height = 0;
};

/// A part on the page.
struct Scene {
  View view;
  Box area;        // of the drawing on the page
  Trace boundary;  // on the page; its s is the part's

  double pixels(double length) const { return length * view.scale; }
  Vec2 at(double s) const { return point_at(boundary, s); }
  /// Outward unit normal; at a corner the middle one.
  Vec2 normal(double s) const;
};

/// The scale at which that just fits, pixels for each unit of the outline; and the room it takes at a scale, pixels.
double fitting_scale(const Framing& framing, double width, double height);
Vec2 size_at(const Framing& framing, double scale);

/// Height that the drawing takes: as much as the content needs at full width, within the limits.
double drawing_height(const Framing& framing);

/// The part drawn as large as the framing allows in an area with its upper left corner at `corner`.
Scene make_scene(const Part& part, const Framing& framing, const Vec2& corner);

/// The part at a scale that is given, in the middle of an area; the framing's width and heights don't count.
Scene scene_at(const Part& part, const Framing& framing, double scale, const Box& area);

/// The part's extent, from a coarse drawing.
Box part_bounds(const Part& part);

/// More corners than this are left unmarked.
constexpr std::size_t kMostCorners = 100;

void draw_material(Svg& svg, const Scene& scene, const Part& part);
void draw_boundary(Svg& svg, const Scene& scene, const Part& part);
void draw_corners(Svg& svg, const Scene& scene, const Part& part, Obstacles& obstacles);

/// A tick across the boundary at s = 0 with an arrow in the direction of growing s. The label is the caller's.
void draw_origin(Svg& svg, const Scene& scene, Obstacles& obstacles);

/// A length in the outline's unit, with its name, at the lower left of the area.
void draw_scale_bar(Svg& svg, const Scene& scene, const Part& part);

/// An outline's points, near enough to be drawn thin.
std::vector<Vec2> polyline_of(const Outline& outline);

/// What else a drawing holds, thin.
void draw_others(Svg& svg, const Scene& scene, const std::vector<Outline>& others);
/// As much room as that takes, unless it reaches too far beyond the part (of these bounds).
Box bounds_of(const std::vector<Outline>& others, const Box& bounds);

/// A filled triangle with its tip at the end of the path. The line itself should end before it, see without_tip.
void draw_arrowhead(Svg& svg, const std::vector<Vec2>& path, double size, std::string_view colour);

/// The path without its last stretch of `length`, so that its line does not blunt the arrowhead; a path that is not
/// longer stays as it is.
std::vector<Vec2> without_tip(const std::vector<Vec2>& path, double length);

}  // namespace rollfix::draw
