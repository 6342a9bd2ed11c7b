#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/outline/outline.hpp"
#include "rollfix/outline/spline.hpp"

namespace rollfix {

/// How to make an outline of points.
struct OutlineOptions {
  bool open = false;                   // a curve with two ends
  double corner_angle = kCornerAngle;  // radians, in [0, pi]: chords that turn by at least this make a corner
  std::optional<double> smooth = {};   // a length: points of a scan, to be met within this and not exactly
};

/// Points closer together than this share of the bounding box's diagonal are the same point.
inline constexpr double kSamePoint = 1e-9;

/// The points of a text, one per line: "x y" or "x,y" (also tabs or semicolons), further columns ignored. Blank lines,
/// # comments, a byte order mark, both kinds of line ends, and one title line before the first point are allowed.
/// Where a closed outline's last point is the same as its first, it is dropped. Airfoils in Lednicer's order (numbers
/// of points, then both surfaces from the nose on) are brought into Selig's: from the trailing edge over the top and
/// back. `notes`, where given, is told which order an airfoil was in. `name` is what errors call the text: a file's
/// name. Throws InputError naming the line: not two numbers, not finite, the same point twice in a row (which a scan
/// that is smoothed may hold), an airfoil with other numbers of points than it says; or too few points (closed: 3,
/// open: 2), no size, or a closed outline with all points on one line.
std::vector<Vec2> parse_points(std::string_view text, const std::string& name, const OutlineOptions& options = {},
                               std::vector<std::string>* notes = nullptr);

/// The same from a file, "-" for standard input. Throws InputError also when it can't be read.
std::vector<Vec2> read_points(const std::string& path, const OutlineOptions& options = {},
                              std::vector<std::string>* notes = nullptr);

/// The spline through points (see spline_through) or, where they are to be smoothed, near them (see smooth_spline);
/// `notes`, where given, is told how near, and how many corners there are.
Outline outline_through(const std::vector<Vec2>& points, const std::string& name, const OutlineOptions& options = {},
                        std::vector<std::string>* notes = nullptr);

}  // namespace rollfix
