#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/outline/curve.hpp"
#include "rollfix/outline/outline.hpp"
#include "rollfix/units.hpp"

namespace rollfix {

/// Neighbouring chords that turn by at least this make a corner. Below 60 degrees, so that a hexagon has corners.
inline constexpr double kCornerAngle = 59 * std::numbers::pi / 180;

/// The curve through points, as drawn by hand: a cubic spline with continuous second derivative in cumulative
/// chord length, one Curve per chord; the curve number i starts at points[i] exactly.
///  * closed: periodic; open: second derivative zero at both ends ("natural")
///  * where two neighbouring chords turn by at least corner_angle (radians, in [0, pi]; 0 makes a polygon)
///    there is a corner: a new spline starts, natural at both ends. On a closed curve the first point is no exception,
///    and where it is not a corner the spline runs across it
///  * a stretch between corners that is straight to rounding is made of lines
/// Linear in the number of points.
/// Throws InputError: fewer than 3 points (open: 2), a point that is not finite, two equal neighbours, or a
/// corner angle outside [0, pi].
std::vector<Curve> spline_through(const std::vector<Vec2>& points, bool closed, double corner_angle = kCornerAngle);

/// How to make an outline of points.
struct OutlineOptions {
  bool open = false;                        // a curve with two ends
  std::optional<double> corner_angle = {};  // radians, in [0, pi], as for spline_through; default kCornerAngle, and a
                                            // sparsely sampled nose is no corner
  std::optional<Length> smooth = {};        // points of a scan, to be met within this and not exactly
  std::string unit = {};  // that all lengths are to be in; what the file states is converted; empty: what it states
  std::optional<bool> decimal_comma{};  // as in 0,5 1,25; none: there may be between semicolons
  bool airfoil = false;  // from the trailing edge over the top and back: corners are at the trailing edge only
};

/// Points closer together than this share of the bounding box's diagonal are the same point.
inline constexpr double kSamePoint = 1e-9;

/// The points of a text, one per line: "x y" or "x,y" (also tabs or semicolons), further columns ignored. A header that
/// names x and y, in any order and among others ("name,y,x", "x [mm],y [mm]"), says which columns they are. Blank
/// lines, # comments, a byte order mark, both kinds of line ends, and title lines before the first point are allowed.
/// Where a closed outline's last point is the same as its first, it is dropped. Airfoils in Lednicer's order (numbers
/// of points, then both surfaces from the nose on) are brought into Selig's: from the trailing edge over the top and
/// back; `airfoil`, where given, is told whether the points are one. `notes`, where given, is told which order an
/// airfoil was in, and what was passed over; `unit` the unit that the points come in: the options', to which a header's
/// is converted, else the header's. `name` is what errors call the text: a file's name. Throws InputError naming the
/// line: the header of a log, not two numbers, not finite, the same point twice in a row (which a scan that is smoothed
/// may hold), an airfoil with other numbers of points than it says; or too few points (closed: 3, open: 2), no size, or
/// a closed outline with all points on one line.
std::vector<Vec2> parse_points(std::string_view text, const std::string& name, const OutlineOptions& options = {},
                               std::vector<std::string>* notes = nullptr, std::string* unit = nullptr,
                               bool* airfoil = nullptr);

/// The same from a file, "-" for standard input. Throws InputError also when it can't be read.
std::vector<Vec2> read_points(const std::string& path, const OutlineOptions& options = {},
                              std::vector<std::string>* notes = nullptr, std::string* unit = nullptr,
                              bool* airfoil = nullptr);

/// The spline through points (see spline_through; without a corner angle of the options a point whose neighbours show
/// that it is a sparsely sampled nose, by turning the same way and more and more towards it, is no corner) or, where
/// they are to be smoothed, near them (see smooth_spline); `notes`, where given, is told how near, and how many corners
/// there are. The points are in the unit of the options.
Outline outline_through(const std::vector<Vec2>& points, const std::string& name, const OutlineOptions& options = {},
                        std::vector<std::string>* notes = nullptr);

/// The tolerance may be at most this share of the bounding box's diagonal: corners are looked for at a few tolerances'
/// length, and little else would be left of the outline.
inline constexpr double kMostSmoothing = 0.05;
/// A rounded corner that turns by the corner angle within this many tolerances is a corner: below a radius of about
/// this many tolerances, noise of the tolerance's size hides the rounding.
inline constexpr double kCornerReach = 5;

/// A smooth curve near points.
struct Smoothing {
  std::vector<Curve> curves;         // cubic spans, C2 but for the corners; lines between corners where lines will do
  double deviation = 0;              // the largest distance of a point from the curves, never above the tolerance
  std::vector<std::size_t> corners;  // the curves that start at a corner
};

/// The curve with few spans that stays within `tolerance` (a length) of every point of a scan: a least-squares cubic
/// spline whose knots are added only where a point is farther away, so that the noise on either side averages out. (A
/// spline that is pulled straight until it just keeps the tolerance would shrink every circle by it.) Knots are spaced
/// by a length that pixel stairs and noise do not add to, and each point is compared with its own nearest place.
///  * a corner is where the lines through the points within kCornerReach tolerances on either side turn by at least
///    corner_angle; where points are sparser than that, the chords, as in spline_through
///  * closed: the curve starts near the first point: within about the tolerance, or at a corner within that reach
///  * a point given several times counts once
///  * where the tolerance is finer than the noise, the curve follows the noise; where knots would get nearly as many
///    as points, spline_through is returned, with deviation 0
/// About linear in the number of points.
/// Throws InputError: what spline_through throws, and a tolerance that is not finite, not above 0 or too large.
Smoothing smooth_spline(const std::vector<Vec2>& points, bool closed, double tolerance,
                        double corner_angle = kCornerAngle);

}  // namespace rollfix
