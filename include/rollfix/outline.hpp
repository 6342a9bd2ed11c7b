#pragma once

// What bounds a part: curves in order, from points, formulas, the gallery or drawings.
//
//     const Outline outline = outline_through({{0, 0}, {2, 0}, {2, 1}, {0, 1}}, "mine", {.corner_angle = 0.5});
//     outline.curves.size();      // 4
//     check(outline).empty();     // true
//
// Degenerate cases: repeated points, two points of a closed outline, curves that don't meet: an InputError or a
// line of `check` that says where.

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/units.hpp"

namespace rollfix {

/// How far an outline that was measured may be off the part, as standard deviations: what `teach` says of its outline.
/// All 0: exact. Of the angle between the tangents at two places `length` apart the variance is 2 turn^2, less where
/// they are nearer together than `alike`, and walk^2 length more.
struct Accuracy {
  double length = 0;  // of a length along the outline, per length: all lengths are off by one factor
  double turn = 0;    // of a tangent's direction, radians
  double alike = 0;   // length: tangents nearer together than this are off alike
  double walk = 0;    // of what tangents' errors gather along the outline, radians per square root of length

  bool is_exact() const { return length == 0 && turn == 0 && walk == 0; }
};

/// The boundary as drawn: smooth curves, each starting where the one before ends.
/// A closed outline's last curve ends where the first begins. s = 0 is the start of the first curve.
struct Outline {
  std::string name;           // what the user called it: "gallery:ellipse", "wing.dat"
  std::vector<Curve> curves;  // each analytic on its domain; where two meet is a joint or a corner
  bool closed = true;         // false: an open curve with two ends
  bool reversed = false;      // true: the user gave it in the opposite direction
  bool hole = false;          // closed, and the material is outside: stored clockwise
  std::string gallery{};      // the gallery's specification that gives these curves again; empty: not from there
  std::string unit{};         // of its lengths: "mm", "in", ...; empty where nobody said
  double gap = 0;             // curves may start this far from where the one before ends: a drawing's rounded digits
  Accuracy accuracy{};        // of an outline that was measured, by a roll around it; else exact
};

/// The same boundary in the opposite direction with the same first point; `reversed` is toggled.
Outline reversed(const Outline& outline);

/// The same outline with all lengths so many times as long, in another unit.
Outline scaled(const Outline& outline, double factor, const std::string& unit);

/// What is wrong with an outline, in words that a user can act on; empty when nothing is.
///  * derivatives: each order against differences of the order below it, at `samples` points per curve
///  * closure: each curve starts where the one before ends
///  * regularity: the first derivative vanishes nowhere on the samples
/// For the author of a curve type of their own; the library's curves pass it in the tests.
std::vector<std::string> check(const Outline& outline, int samples = 64);

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

/// Where in its file a curve of a drawing stands.
struct Origin {
  std::string entity;    // what the file calls it: "ARC", "path"
  std::string layer;     // of a DXF; the id of an SVG element; empty where there is none
  std::size_t line = 0;  // counted from 1; of a binary file the byte
};

/// A smooth curve of a drawing. A circle or another closed smooth curve is one curve that ends where it starts.
struct DrawnCurve {
  Curve curve;
  Origin origin;
};

/// What a file draws: curves in the file's order, each in the file's direction, not yet joined (see loops). The curves
/// of one polyline, spline or path stand next to each other.
struct Drawing {
  std::string name;                // what the user calls the file
  std::string unit;                // "mm", "in", ...; empty where the file does not say
  std::vector<DrawnCurve> curves;  // in the file's own unit
  std::vector<std::string> notes;  // all that was left out or flattened, with counts: for the user to read
};

/// Ends of curves closer together than this share of the drawing's diagonal meet, unless the user says otherwise.
inline constexpr double kGapShare = 1e-6;

struct LoopOptions {
  std::optional<double> gap;  // a length: ends this close together meet; default: kGapShare of the diagonal
  bool outer = false;         // where more than two ends meet: take what is around the outside
};

/// Curves of a drawing joined end to end.
struct Loop {
  Outline outline;        // starts with its first curve in the file, in that curve's direction
  std::size_t first = 0;  // that curve's number in the drawing
  double length = 0;      // of all its curves, to kLengthAccuracy or so
  double area = 0;        // closed: enclosed, above 0 whichever way it runs
  int depth = 0;          // closed: inside how many other closed loops it lies; odd: a hole
  double gap = 0;         // the largest between neighbouring curves; open: not the one between its two ends

  /// Whether the gap is more than rounding.
  bool has_gap() const { return gap > 1e-9 * length; }
};

struct Loops {
  std::vector<Loop> closed;        // by falling area: the first is the outer one
  std::vector<Loop> open;          // by falling length
  std::vector<std::string> notes;  // what was left out: curves drawn twice, curves without length, chains that branch
  std::string doubt;               // why the first of them may not be the outer one: a chain around it branches
};

/// Joins a drawing's curves, whatever their order and direction, where ends meet within the gap. Where more than two
/// ends meet, the curves that hang together there are left out, and a note says where that is; with `outer` those of
/// them that are around the outside are a loop, and leaders and construction lines are left out. Throws InputError: no
/// curves, or none but such as branch (with the place).
Loops loops(const Drawing& drawing, const LoopOptions& options = {});

/// The area that a closed outline encloses, above 0 whichever way it runs; relative error 1e-11 or so.
double enclosed_area(const Outline& outline);

/// What a parameter of a gallery shape may be.
enum class ParameterKind {
  length,  // a number above 0, within what squares and cubes of it can hold
  number,  // a number from least to most
  whole,   // a whole number from least to most
  text
};

struct GalleryParameter {
  std::string name;
  std::string default_value;  // as a user would write it
  std::string meaning;
  ParameterKind kind = ParameterKind::length;
  double least = 0;
  double most = 0;
};

/// The values that a parameter takes, in words: "a whole number from 3 to 1000".
std::string allowed_values(const GalleryParameter& parameter);

/// A named shape. Everything that help, documentation and error messages say of it comes from here.
struct GalleryShape {
  std::string name;
  std::string formula;
  std::string start;   // where s = 0 is
  std::string remark;  // what is special about it, above all what makes it hard
  bool closed = true;
  bool smooth = true;  // false: it has corners
  std::vector<GalleryParameter> parameters;
};

const std::vector<GalleryShape>& gallery_shapes();

/// Parameters as the user wrote them: name and value.
using ParameterList = std::vector<std::pair<std::string, std::string>>;

/// The shape with these parameters, the rest at their defaults. Counter-clockwise when closed, s = 0 where the
/// usual formula's parameter is 0, no velocity of 0 anywhere. Named "gallery:ellipse,a=2,b=1", which gives it again.
/// Throws InputError: unknown shape or parameter (with the valid ones and the nearest), a parameter given
/// twice, or a value that is not allowed.
Outline gallery(const std::string& shape, const ParameterList& parameters);

/// The same from one text: "ellipse", "ellipse,a=2,b=1", with or without "gallery:" before it.
Outline gallery(const std::string& specification);

/// An outline from what a user calls it, which becomes its name: "gallery:NAME,key=value,..." (see gallery), a points
/// file ending in .csv, .dat or .txt, or "-" for points from standard input (see read_points). The options are for
/// points; `notes`, where given, is told what was found and done to them. Throws InputError: what the parts throw, and
/// an ending that is not known. Drawings and saved parts need rollfix::files: see rollfix/files.hpp.
Outline load_outline(const std::string& argument, const OutlineOptions& options = {},
                     std::vector<std::string>* notes = nullptr);

}  // namespace rollfix
