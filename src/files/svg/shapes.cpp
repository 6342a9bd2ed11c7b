#include "files/svg/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "files/svg/document.hpp"
#include "outline/turn.hpp"
#include "text/text.hpp"

// SVG's path grammar, and its basic shapes as subpaths.
// Notation:
//   pen             `last_`, where the last command ended; where Z ends is the start of the subpath
//   reflected       the control point that S and T continue with: `control_` seen from the pen, 2 `last_` - `control_`
//   radii, degrees  of an elliptical arc, and how its first axis is turned; scaled up where they don't reach
// Follows docs/files.md, "SVG"; SVG 1.1, "Paths", "Basic shapes" and its appendix F.6 on elliptical arcs.
namespace rollfix::svg {
namespace {

/// The arc of an ellipse with these radii, the first one turned by this angle against the x axis, that joins two
/// points: the longer way or the shorter one, with rising or falling angle. Radii too small to reach are scaled up
/// until they do, and where one is 0 it is a line (SVG, appendix on elliptical arcs). Where the points are the same it
/// is a line without length.
Segment arc_between(const Vec2& from, const Vec2& to, const Vec2& radii, double degrees, bool large, bool positive) {
  if (from == to || !(radii.minCoeff() > 0)) return line(from, to);
  const Eigen::Matrix2d turn = rotation(degrees);
  // In the frame in which the ellipse is a circle of radius 1, `half` is half of the chord.
  Vec2 axes = radii;
  Vec2 half = (turn.transpose() * (0.5 * (to - from))).cwiseQuotient(axes);
  double length = half.norm();
  double to_chord = 0;  // from the centre
  if (length >= 1) {
    axes *= length;
    half /= length;
    length = 1;
  } else {
    to_chord = std::sqrt((1 - length) * (1 + length));
  }
  const double side = large == positive ? -1 : 1;  // on which side of the chord the centre lies
  const Vec2 left(-half.y(), half.x());
  const Vec2 centre = side * to_chord / length * left;  // from the chord's middle
  const Vec2 spoke = -half - centre;
  const double shorter = 2 * std::atan2(length, to_chord);
  const double size = large ? 2 * std::numbers::pi - shorter : shorter;
  Segment segment{SegmentKind::arc, from, to};
  segment.shape = {0.5 * (from + to) + turn * centre.cwiseProduct(axes), axes.x() * turn.col(0),
                   axes.y() * turn.col(1)};
  segment.angle = std::atan2(spoke.y(), spoke.x());
  segment.sweep = positive ? size : -size;
  return segment;
}

/// Builds subpaths from commands. `last_` is where the pen is, `control_` what S and T reflect.
class PathReader {
 public:
  explicit PathReader(const Value& data) : scan_(data) {}

  std::vector<Subpath> run() {
    scan_.skip_spaces();
    while (!scan_.at_end()) {
      read_command();
      scan_.skip_spaces();
    }
    finish();
    return std::move(subpaths_);
  }

 private:
  void read_command() {
    const char letter = scan_.peek();
    const bool moves = letter == 'M' || letter == 'm';
    if (!is_letter(letter) || std::string_view("MmLlHhVvCcSsQqTtAaZz").find(letter) == std::string_view::npos) {
      scan_.refuse("expected a path command, one of MmLlHhVvCcSsQqTtAaZz");
    }
    if (!started_ && !moves) scan_.refuse("expected a path that begins with M or m");
    scan_.advance();
    if (letter == 'Z' || letter == 'z') {
      close();
      return;
    }
    scan_.skip_spaces();
    char command = letter;
    do {
      read_arguments(command);
      if (command == 'M') command = 'L';  // further points after "move to" are lines
      if (command == 'm') command = 'l';
    } while (more_arguments());
  }

  /// The same command goes on with the next number; a comma promises one.
  bool more_arguments() {
    const bool comma = scan_.skip_separator();
    if (scan_.at_number()) return true;
    if (comma) scan_.refuse("expected a number after the comma");
    return false;
  }

  void read_arguments(char command) {
    relative_ = command >= 'a';
    switch (relative_ ? static_cast<char>(command - 'a' + 'A') : command) {
      case 'M':
        move(point());
        break;
      case 'L':
        add(line(last_, point()));
        break;
      case 'H':
        add(line(last_, {number() + (relative_ ? last_.x() : 0), last_.y()}));
        break;
      case 'V':
        add(line(last_, {last_.x(), number() + (relative_ ? last_.y() : 0)}));
        break;
      case 'C': {
        const Vec2 first = point();
        separate();
        const Vec2 second = point();
        separate();
        add_cubic(first, second, point());
        break;
      }
      case 'S': {
        const Vec2 first = after_cubic_ ? Vec2(2 * last_ - control_) : last_;
        const Vec2 second = point();
        separate();
        add_cubic(first, second, point());
        break;
      }
      case 'Q': {
        const Vec2 control = point();
        separate();
        add_quadratic(control, point());
        break;
      }
      case 'T':
        add_quadratic(after_quadratic_ ? Vec2(2 * last_ - control_) : last_, point());
        break;
      default:
        read_arc();
    }
  }

  void read_arc() {
    const double rx = number();
    separate();
    const double ry = number();
    separate();
    const double degrees = number();
    separate();
    const bool large = scan_.flag();
    separate();
    const bool positive = scan_.flag();
    separate();
    const Vec2 to = point();
    add(arc_between(last_, to, {std::abs(rx), std::abs(ry)}, degrees, large, positive));
  }

  double number() { return scan_.number("a number"); }
  void separate() { scan_.skip_separator(); }
  Vec2 point() {
    const double x = number();
    separate();
    const double y = number();
    return relative_ ? Vec2(last_ + Vec2(x, y)) : Vec2(x, y);
  }

  void move(const Vec2& to) {
    finish();
    started_ = true;
    open_.start = last_ = to;
    after_cubic_ = after_quadratic_ = false;
  }

  void add(const Segment& segment) {
    open_.segments.push_back(segment);
    last_ = segment.to;
    after_cubic_ = after_quadratic_ = false;
  }

  void add_cubic(const Vec2& first, const Vec2& second, const Vec2& to) {
    add({SegmentKind::cubic, last_, to, {first, second, Vec2::Zero()}});
    control_ = second;
    after_cubic_ = true;
  }

  void add_quadratic(const Vec2& control, const Vec2& to) {
    add({SegmentKind::quadratic, last_, to, {control, Vec2::Zero(), Vec2::Zero()}});
    control_ = control;
    after_quadratic_ = true;
  }

  void close() {
    open_.closed = true;
    last_ = open_.start;
    after_cubic_ = after_quadratic_ = false;
    finish();
  }

  /// What follows a closed subpath without "move to" starts where that one did.
  void finish() {
    const Vec2 start = open_.start;
    if (!open_.segments.empty()) subpaths_.push_back(std::move(open_));
    open_ = Subpath{start, {}, false};
  }

  Scanner scan_;
  bool started_ = false;
  bool relative_ = false;
  bool after_cubic_ = false;
  bool after_quadratic_ = false;
  Vec2 last_ = Vec2::Zero();
  Vec2 control_ = Vec2::Zero();
  Subpath open_;
  std::vector<Subpath> subpaths_;
};

}  // namespace

std::vector<Subpath> parse_path(const Value& data) {
  // "none" is what SVG calls an empty path.
  return data.text == "none" ? std::vector<Subpath>() : PathReader(data).run();
}

std::vector<Vec2> parse_point_list(const Value& points) {
  Scanner scan(points);
  std::vector<Vec2> result;
  scan.skip_spaces();
  while (!scan.at_end()) {
    const double x = scan.number("a number");
    scan.skip_separator();
    const double y = scan.number("the second number of a point");
    result.emplace_back(x, y);
    if (scan.skip_separator() && scan.at_end()) scan.refuse("expected a point after the comma");
  }
  return result;
}

namespace {

constexpr double kQuarter = std::numbers::pi / 2;

/// An element's lengths.
class Lengths {
 public:
  Lengths(const Document& document, pugi::xml_node node, const Vec2& viewport)
      : document_(document), node_(node), viewport_(viewport) {}

  double x(const char* name) const { return read(name, viewport_.x()).value_or(0); }
  double y(const char* name) const { return read(name, viewport_.y()).value_or(0); }
  double radius(const char* name) const { return size(name, viewport_.norm() / std::numbers::sqrt2).value_or(0); }
  Vec2 point(const char* first, const char* second) const { return {x(first), y(second)}; }
  Vec2 extent() const {
    const double width = size("width", viewport_.x()).value_or(0);
    return {width, size("height", viewport_.y()).value_or(0)};
  }
  /// rx and ry, one of which stands for both where the other is missing or "auto".
  Vec2 radii() const {
    const std::optional<double> rx = size("rx", viewport_.x());
    const std::optional<double> ry = size("ry", viewport_.y());
    return {rx ? *rx : ry.value_or(0), ry ? *ry : rx.value_or(0)};
  }
  /// Whether a size that was read is one that nothing can have.
  bool below_zero() const { return below_zero_; }

 private:
  std::optional<double> read(const char* name, double whole) const { return length_of(document_, node_, name, whole); }

  std::optional<double> size(const char* name, double whole) const {
    const std::optional<double> result = read(name, whole);
    below_zero_ = below_zero_ || (result && *result < 0);
    return result;
  }

  const Document& document_;
  pugi::xml_node node_;
  Vec2 viewport_;
  mutable bool below_zero_ = false;
};

using Subpaths = std::vector<Subpath>;

Subpaths ellipse(const Vec2& centre, const Vec2& radii) {
  if (!(radii.minCoeff() > 0)) return {};
  const Segment whole = elliptic(centre, radii, 0, kFullTurn);
  return {{whole.from, {whole}, true}};
}

/// From the end of the upper left rounding to the right, and around.
Subpaths rectangle(const Vec2& corner, const Vec2& extent, Vec2 radii) {
  if (!(extent.minCoeff() > 0)) return {};
  radii = radii.cwiseMin(0.5 * extent);
  const bool is_round = radii.minCoeff() > 0;
  if (!is_round) radii = Vec2::Zero();
  const Vec2 far = corner + extent;
  const Vec2 inner_near = corner + radii;
  const Vec2 inner_far = far - radii;
  const std::array<Vec2, 8> at = {{{inner_near.x(), corner.y()},
                                   {inner_far.x(), corner.y()},
                                   {far.x(), inner_near.y()},
                                   {far.x(), inner_far.y()},
                                   {inner_far.x(), far.y()},
                                   {inner_near.x(), far.y()},
                                   {corner.x(), inner_far.y()},
                                   {corner.x(), inner_near.y()}}};
  const std::array<Vec2, 4> centres = {
      {{inner_far.x(), inner_near.y()}, inner_far, {inner_near.x(), inner_far.y()}, inner_near}};
  Subpath path{at[0], {}, true};
  for (std::size_t side = 0; side < 4; ++side) {
    const bool horizontal = side % 2 == 0;
    const bool is_used_up = is_round && (horizontal ? 2 * radii.x() >= extent.x() : 2 * radii.y() >= extent.y());
    if (!is_used_up) path.segments.push_back(line(at[2 * side], at[2 * side + 1]));
    if (!is_round) continue;
    Segment rounding = elliptic(centres[side], radii, (static_cast<double>(side) - 1) * kQuarter, kQuarter);
    rounding.from = at[2 * side + 1];
    rounding.to = at[(2 * side + 2) % 8];
    path.segments.push_back(rounding);
  }
  return {path};
}

Subpaths chain(const std::vector<Vec2>& points, bool closed) {
  if (points.size() < 2) return {};
  Subpath path{points.front(), {}, closed};
  for (std::size_t k = 1; k < points.size(); ++k) path.segments.push_back(line(points[k - 1], points[k]));
  return {path};
}

}  // namespace

std::optional<double> length_of(const Document& document, pugi::xml_node node, const char* name, double whole) {
  const std::optional<Value> value = document.attribute(node, name);
  const std::optional<Length> length = value && !value->text.empty() ? parse_length(*value) : std::nullopt;
  if (!length) return std::nullopt;
  const auto refuse = [&](const char* message) {
    value->refuse(value->text.data(), fmt::format(fmt::runtime(message), shown(value->text)));
  };
  const std::optional<double> result = length->in_user_units(whole);
  if (!result) refuse("expected a length in px, mm, cm, in, pt, pc or without a unit, found '{}'");
  if (!std::isfinite(*result)) refuse("'{}' is a share of a page whose size the file does not say: write a length");
  return result;
}

bool is_shape(std::string_view kind) {
  constexpr std::array<std::string_view, 7> kShapes = {"path", "rect",     "circle", "ellipse",
                                                       "line", "polyline", "polygon"};
  return std::find(kShapes.begin(), kShapes.end(), kind) != kShapes.end();
}

namespace {

Subpaths drawn(const Document& document, pugi::xml_node node, const Lengths& lengths) {
  const std::string_view kind = document.kind(node);
  if (kind == "path") {
    const std::optional<Value> data = document.attribute(node, "d");
    return data ? parse_path(*data) : Subpaths();
  }
  if (kind == "rect") return rectangle(lengths.point("x", "y"), lengths.extent(), lengths.radii());
  if (kind == "circle") return ellipse(lengths.point("cx", "cy"), Vec2::Constant(lengths.radius("r")));
  if (kind == "ellipse") return ellipse(lengths.point("cx", "cy"), lengths.radii());
  if (kind == "line") return chain({lengths.point("x1", "y1"), lengths.point("x2", "y2")}, false);
  const std::optional<Value> points = document.attribute(node, "points");
  return points ? chain(parse_point_list(*points), kind == "polygon") : Subpaths();
}

}  // namespace

std::optional<std::vector<Subpath>> shape(const Document& document, pugi::xml_node node, const Vec2& viewport) {
  const Lengths lengths(document, node, viewport);
  Subpaths result = drawn(document, node, lengths);
  if (lengths.below_zero()) return std::nullopt;
  return result;
}

}  // namespace rollfix::svg
