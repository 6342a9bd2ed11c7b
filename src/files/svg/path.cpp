#include "files/svg/shapes.hpp"

#include <cmath>
#include <numbers>

#include "files/svg/segment.hpp"
#include "files/svg/value.hpp"

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

/// Builds subpaths from commands. `last_` is where the pen is, `reflected_` what S and T continue with.
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

}  // namespace rollfix::svg
