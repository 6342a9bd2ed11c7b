#include "files/svg/shapes.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "files/svg/document.hpp"
#include "outline/box.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "text/text.hpp"

// What SVG's transformations and viewports are, and the curves that segments become under them.
// Notation:
//   x -> A x + b    an affine map, matrix(a b c d e f) in SVG's own words: Affine
//   segment         line, arc of an ellipse or Bezier curve, as it comes out of a path: Segment
// Follows docs/files.md, "SVG"; SVG 1.1, "Coordinate systems, transformations and units".
namespace rollfix::svg {
namespace {

/// Half axes of one length and at right angles, but for rounding, are a circle's.
constexpr double kRound = 1e-14;

/// The box around a drawing, and whether its numbers can be worked with.
class Bounds {
 public:
  void add(const Vec2& point) {
    box_.extend(point);
    valid_ = valid_ && point.cwiseAbs().maxCoeff() <= kMostCoordinate && !point.hasNaN();
  }

  /// The points that a segment stays among.
  void add(const Segment& segment) {
    add(segment.from);
    add(segment.to);
    const auto& shape = segment.shape;
    if (segment.kind == SegmentKind::quadratic || segment.kind == SegmentKind::cubic) add(shape[0]);
    if (segment.kind == SegmentKind::cubic) add(shape[1]);
    if (segment.kind == SegmentKind::arc) {
      const Vec2 reach = shape[1].cwiseAbs() + shape[2].cwiseAbs();
      add(shape[0] + reach);
      add(shape[0] - reach);
    }
  }

  bool valid() const { return valid_; }
  double diagonal() const { return box_.isEmpty() ? 0 : box_.diagonal().norm(); }

 private:
  Box box_;
  bool valid_ = true;
};

/// No longer than this, by the polygon around it.
bool is_within(const Segment& segment, double length) {
  const auto is_near = [&](const Vec2& point) { return (point - segment.from).norm() <= length; };
  switch (segment.kind) {
    case SegmentKind::line:
      return is_near(segment.to);
    case SegmentKind::quadratic:
      return is_near(segment.to) && is_near(segment.shape[0]);
    case SegmentKind::cubic:
      return is_near(segment.to) && is_near(segment.shape[0]) && is_near(segment.shape[1]);
    default:
      return std::abs(segment.sweep) * (segment.shape[1].norm() + segment.shape[2].norm()) <= length;
  }
}

Curve arc(const Segment& segment) {
  const auto& [centre, major, minor] = segment.shape;
  const double radius = major.norm();
  const bool is_circle =
      std::abs(major.dot(minor)) <= kRound * radius * radius && std::abs(minor.norm() - radius) <= kRound * radius;
  if (!is_circle) return EllipticArc(centre, major, minor, segment.angle, segment.sweep);
  const double direction = cross(major, minor) > 0 ? 1 : -1;
  const double from =
      std::remainder(std::atan2(major.y(), major.x()) + direction * segment.angle, 2 * std::numbers::pi);
  return Arc(centre, radius, from, direction * segment.sweep);
}

std::vector<Curve> curves_of(const Segment& segment) {
  switch (segment.kind) {
    case SegmentKind::line:
      return {Line(segment.from, segment.to)};
    case SegmentKind::quadratic:
      return bezier_curves({segment.from, segment.shape[0], segment.to});
    case SegmentKind::cubic:
      return bezier_curves({segment.from, segment.shape[0], segment.shape[1], segment.to});
    default:
      return {arc(segment)};
  }
}

/// The segments that have a length, each starting where the one before ends, and back at the start if closed.
std::vector<Segment> chained(Subpath path, double same_point, std::size_t& without_length) {
  std::vector<Segment> kept;
  for (Segment& segment : path.segments) {
    if (is_within(segment, same_point)) {
      ++without_length;
      continue;
    }
    segment.from = kept.empty() ? path.start : kept.back().to;
    kept.push_back(segment);
  }
  if (!path.closed || kept.empty()) return kept;
  if ((kept.back().to - path.start).norm() > same_point) {
    kept.push_back(line(kept.back().to, path.start));
  } else {
    kept.back().to = path.start;
  }
  return kept;
}

}  // namespace

Curves to_curves(std::vector<PlacedSubpath> subpaths, const Text& file) {
  Bounds box;
  for (const PlacedSubpath& subpath : subpaths) {
    for (const Segment& segment : subpath.path.segments) box.add(segment);
    if (!box.valid()) {
      file.refuse(subpath.offset, fmt::format("the {} has a coordinate beyond {}, expected smaller numbers",
                                              subpath.origin.entity, kMostCoordinate));
    }
  }
  const double same_point = kSamePoint * box.diagonal();
  Curves result;
  for (PlacedSubpath& subpath : subpaths) {
    try {
      for (const Segment& segment : chained(std::move(subpath.path), same_point, result.without_length)) {
        for (Curve& curve : curves_of(segment)) result.curves.push_back({std::move(curve), subpath.origin});
      }
    } catch (const InputError& error) {
      file.refuse(subpath.offset, error.what());
    }
  }
  return result;
}

namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

Eigen::Matrix2d matrix(double a, double b, double c, double d) {
  Eigen::Matrix2d result;
  result << a, c, b, d;  // SVG goes down the columns
  return result;
}

/// The numbers of one function, for those who take a few.
struct Arguments {
  std::array<double, 6> value{};
  std::size_t count = 0;
};

Arguments read_arguments(Scanner& scan) {
  Arguments arguments;
  scan.skip_spaces();
  if (scan.at_end() || scan.peek() != '(') scan.refuse("expected '('");
  scan.advance();
  scan.skip_spaces();
  bool comma = false;
  while (scan.at_end() || scan.peek() != ')' || comma) {
    if (arguments.count == arguments.value.size()) scan.refuse("expected ')'");
    arguments.value[arguments.count++] = scan.number("a number");
    comma = scan.skip_separator();
  }
  scan.advance();
  return arguments;
}

Affine from_function(std::string_view name, const Arguments& arguments, const Value& value, const char* place) {
  const auto& [v, count] = arguments;
  const auto expect = [&, given = count](bool right, const char* numbers) {
    if (!right) value.refuse(place, fmt::format("{} takes {}, found {}", name, numbers, given));
  };
  if (name == "matrix") {
    expect(count == 6, "6 numbers");
    return {matrix(v[0], v[1], v[2], v[3]), {v[4], v[5]}};
  }
  if (name == "translate") {
    expect(count == 1 || count == 2, "1 or 2 numbers");
    return {Eigen::Matrix2d::Identity(), {v[0], v[1]}};
  }
  if (name == "scale") {
    expect(count == 1 || count == 2, "1 or 2 numbers");
    return {matrix(v[0], 0, 0, count == 1 ? v[0] : v[1]), Vec2::Zero()};
  }
  if (name == "rotate") {
    expect(count == 1 || count == 3, "1 or 3 numbers");
    const Vec2 centre(v[1], v[2]);
    const Eigen::Matrix2d turn = rotation(v[0]);
    return {turn, centre - turn * centre};
  }
  if (name == "skewX" || name == "skewY") {
    expect(count == 1, "1 number");
    const double slope = std::tan(radians(v[0]));
    return {name == "skewX" ? matrix(1, 0, slope, 1) : matrix(1, slope, 0, 1), Vec2::Zero()};
  }
  value.refuse(place,
               fmt::format("expected matrix, translate, scale, rotate, skewX or skewY, found '{}'", shown(name)));
}

/// "xMidYMax" as the shares of what is left over that go to the left and above.
bool read_alignment(std::string_view word, Vec2& share) {
  const auto one = [](std::string_view name, double& value) {
    value = name == "Min" ? 0 : name == "Mid" ? 0.5 : 1;
    return name == "Min" || name == "Mid" || name == "Max";
  };
  return word.size() == 8 && word[0] == 'x' && word[4] == 'Y' && one(word.substr(1, 3), share.x()) &&
         one(word.substr(5, 3), share.y());
}

}  // namespace

Eigen::Matrix2d rotation(double degrees) {
  constexpr double kRight = 90;
  const double quarters = std::nearbyint(std::remainder(degrees, 4 * kRight) / kRight);
  const double rest = radians(std::remainder(degrees, 4 * kRight) - quarters * kRight);
  const double cosine = std::cos(rest);
  const double sine = std::sin(rest);
  switch (static_cast<int>(quarters)) {
    case 0:
      return matrix(cosine, sine, -sine, cosine);
    case 1:
      return matrix(-sine, cosine, -cosine, -sine);
    case -1:
      return matrix(sine, -cosine, cosine, sine);
    default:
      return matrix(-cosine, -sine, sine, -cosine);
  }
}

Affine parse_transform(const Value& value) {
  Scanner scan(value);
  Affine result;
  scan.skip_spaces();
  while (!scan.at_end()) {
    const char* const place = scan.cursor();
    const std::string_view name = scan.word();
    if (name.empty()) scan.refuse("expected a transformation such as translate(1 2)");
    const Arguments arguments = read_arguments(scan);
    result = result * from_function(name, arguments, value, place);
    scan.skip_separator();
  }
  return result;
}

ViewBox parse_view_box(const Value& value) {
  Scanner scan(value);
  std::array<double, 4> numbers{};
  scan.skip_spaces();
  for (double& number : numbers) {
    number = scan.number("four numbers in a viewBox");
    scan.skip_separator();
  }
  if (!scan.at_end()) scan.refuse("expected four numbers in a viewBox");
  if (!(numbers[2] > 0) || !(numbers[3] > 0)) {
    value.refuse(value.text.data(), fmt::format("expected a viewBox of a size above 0, found '{}'", shown(value.text)));
  }
  return {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

Affine fit(const ViewBox& box, const Vec2& viewport, const Value& aspect_ratio) {
  Vec2 scale = viewport.cwiseQuotient(box.size);
  Scanner scan(aspect_ratio);
  scan.skip_spaces();
  Vec2 share(0.5, 0.5);
  bool keep = true;
  if (!scan.at_end()) {
    const char* const place = scan.cursor();
    const std::string_view alignment = scan.word();
    keep = alignment != "none";
    scan.skip_spaces();
    const std::string_view how = scan.word();
    scan.skip_spaces();
    const bool known = (!keep || read_alignment(alignment, share)) && (how.empty() || how == "meet" || how == "slice");
    if (!known || !scan.at_end()) {
      aspect_ratio.refuse(place, fmt::format("expected a preserveAspectRatio such as 'xMidYMid meet', found '{}'",
                                             shown(aspect_ratio.text)));
    }
    if (keep) scale.setConstant(how == "slice" ? scale.maxCoeff() : scale.minCoeff());
  } else {
    scale.setConstant(scale.minCoeff());
  }
  const Vec2 left_over = keep ? Vec2(viewport - scale.cwiseProduct(box.size)) : Vec2::Zero();
  return {scale.asDiagonal(), left_over.cwiseProduct(share) - scale.cwiseProduct(box.corner)};
}

}  // namespace rollfix::svg
