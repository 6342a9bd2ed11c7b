#include "rollfix/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "outline/box.hpp"
#include "outline/corners.hpp"
#include "outline/point_table.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"
#include "text/units.hpp"

// From a table of points to an outline.
// Notation:
//   p_k             points, with the lines of the file that they came from: NumberedPoints
//   above, below    an airfoil's surfaces: Selig's order is one loop from the trailing edge over the top to the nose
//                   and back below, Lednicer's the two surfaces, each from the nose on
//   chord           of an airfoil, from nose to tail: 1, the tail being at x = 1
// Follows docs/files.md, "Points and scans" and "Airfoils".
namespace rollfix {

namespace {

/// A closed outline flatter than this share of its size has all its points on one line, but for rounding.
constexpr double kFlat = 1e-12;

/// Airfoils are drawn with a chord of 1. Within this of the origin everything of them lies, flaps included.
constexpr double kMostChordCoordinate = 1.5;
/// A chord this near to 1 is 1, and a trailing edge this near to its end is at its end.
constexpr double kChordSlack = 0.02;
/// Fewer points are not taken for an airfoil's.
constexpr std::size_t kLeastAirfoilPoints = 6;

// ---- airfoils

/// Whether a coordinate can be a number of points.
bool is_count(double value) { return value > 1 && value == std::floor(value); }

/// Whether a blank line (or a comment) stands before this point.
bool starts_a_block(const NumberedPoints& data, std::size_t index) {
  return data.lines[index] > data.lines[index - 1] + 1;
}

/// Whether all points but the first are within 1.5 chords of the origin, as an airfoil's are. The first one, two whole
/// numbers above 1, then is none of them.
bool is_far_from_the_rest(const NumberedPoints& data) {
  return data.points.size() > kLeastAirfoilPoints &&
         std::all_of(data.points.begin() + 1, data.points.end(),
                     [](const Vec2& point) { return point.cwiseAbs().maxCoeff() <= kMostChordCoordinate; });
}

/// Throws InputError: looks like Lednicer's order, but `found` contradicts it.
[[noreturn]] void refuse(const NumberedPoints& data, const std::string& name, const std::string& found) {
  const Vec2& counts = data.points.front();
  throw InputError(fmt::format(
      "{}:{}: '{} {}' looks like the numbers of points above and below an airfoil (Lednicer's order), {}; expected as "
      "many points as it says, each surface from the nose on, or the points of one loop without it (Selig's order)",
      name, data.lines.front(), counts.x(), counts.y(), found));
}

/// The number of points above, or 0 when this is not Lednicer's order.
std::size_t lednicer_count(const NumberedPoints& data, const std::string& name) {
  const Vec2& counts = data.points.front();
  if (!is_count(counts.x()) || !is_count(counts.y())) return 0;
  const std::size_t rest = data.points.size() - 1;
  // Another number of points than stated: an error only if the line stands apart from the rest in place and in value.
  if (counts.sum() != static_cast<double>(rest)) {
    if (is_far_from_the_rest(data) && starts_a_block(data, 1)) {
      refuse(data, name, fmt::format("and {} points follow", rest));
    }
    return 0;
  }
  const auto above = static_cast<std::size_t>(counts.x());
  // The proof of Lednicer's order: both surfaces start at the same point, the nose.
  const Vec2& nose = data.points[1];
  const Vec2& second_nose = data.points[1 + above];
  double size = 0;
  for (std::size_t i = 1; i < data.points.size(); ++i) size = std::max(size, (data.points[i] - nose).norm());
  if ((second_nose - nose).norm() <= kSamePoint * size) return above;
  // Two blocks, but two noses: neither order.
  if (starts_a_block(data, 1) && starts_a_block(data, 1 + above)) {
    refuse(data, name,
           fmt::format("and the two blocks start at different points, ({}, {}) and ({}, {})", nose.x(), nose.y(),
                       second_nose.x(), second_nose.y()));
  }
  return 0;
}

/// From the trailing edge over the top to the nose, and on below; the nose once.
void reorder(NumberedPoints& data, std::size_t above) {
  NumberedPoints loop;
  loop.has_title = data.has_title;
  loop.unit = data.unit;
  loop.notes = data.notes;
  const auto take = [&](std::size_t i) {
    loop.points.push_back(data.points[i]);
    loop.lines.push_back(data.lines[i]);
  };
  // Points 1 ... above from the last one back to the nose, then the second block without its nose.
  for (std::size_t i = above; i >= 1; --i) take(i);
  for (std::size_t i = above + 2; i < data.points.size(); ++i) take(i);
  data = std::move(loop);
}

/// Whether the points look like an airfoil in Selig's order: a title, a chord from 0 to 1, start and end at the tail, x
/// that falls up to the nose and rises after it, and counter-clockwise.
bool is_selig(const NumberedPoints& data) {
  const std::vector<Vec2>& points = data.points;
  if (!data.has_title || points.size() < kLeastAirfoilPoints) return false;
  const auto by_x = [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); };
  const auto nose = std::min_element(points.begin(), points.end(), by_x);
  const auto tail = std::max_element(points.begin(), points.end(), by_x);
  const bool has_unit_chord = std::abs(tail->x() - nose->x() - 1) <= kChordSlack && std::abs(nose->x()) <= kChordSlack;
  const bool starts_and_ends_at_tail =
      tail->x() - points.front().x() <= kChordSlack && tail->x() - points.back().x() <= kChordSlack;
  if (!has_unit_chord || !starts_and_ends_at_tail) return false;
  const bool goes_there_and_back =
      std::is_sorted(nose, points.end(), by_x) && std::is_sorted(std::make_reverse_iterator(nose), points.rend(), by_x);
  // Twice the area, above 0 where it runs over the top first.
  double area = 0;
  for (std::size_t i = 0; i < points.size(); ++i) area += cross(points[i], points[(i + 1) % points.size()]);
  return goes_there_and_back && area > 0;
}

/// Airfoil files come in two orders. Selig's is the points of one loop, from the trailing edge over the top to the nose
/// and back below. Lednicer's has a line with the numbers of points above and below, then both surfaces from the nose
/// to the trailing edge.
///
/// Brings Lednicer's order into Selig's and returns a note that says which order was found; empty when the points are
/// none of both. Lednicer's is what starts with two whole numbers above 1 that are the numbers of points in the two
/// blocks that follow, whose first points are the same; Selig's (for the note only: nothing is changed) what has a
/// title, a chord of 1, and x that falls and then rises.
/// Throws InputError naming the line: what looks like Lednicer's order, with counts that do not match or blocks that do
/// not start at the same point.
std::string order_airfoil(NumberedPoints& data, const std::string& name) {
  if (data.points.empty()) return {};
  const std::size_t above = lednicer_count(data, name);
  if (above > 0) {
    // What is left of the points after the line of counts and those above.
    const std::size_t below = data.points.size() - 1 - above;
    reorder(data, above);
    return fmt::format(
        "an airfoil in Lednicer's order, {} points above and {} below; taken from the trailing edge over the top",
        above, below);
  }
  return is_selig(data) ? "an airfoil in Selig's order, from the trailing edge over the top" : "";
}

// ---- what points must be

/// Throws InputError: fewer than 3 points, of an open outline fewer than 2.
void require_enough(const NumberedPoints& data, const std::string& name, const OutlineOptions& options) {
  const std::size_t count = data.points.size();
  const std::size_t needed = options.open ? 2 : 3;
  if (count >= needed) return;
  const std::string kind = options.open ? "an open" : "a closed";
  const std::string cure = !options.open && count == 2 ? "; of an open one say so with `open`" : "";
  throw InputError(
      fmt::format("{}: holds {} different points, {} outline needs at least {}{}", name, count, kind, needed, cure));
}

/// Throws InputError: neighbours closer together than kSamePoint of the size. A chord so short has no direction; of a
/// closed outline the last point and the first are neighbours.
void refuse_repeated(const NumberedPoints& data, double size, const std::string& name, bool open) {
  const std::vector<Vec2>& points = data.points;
  const double least = kSamePoint * size;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_last = i + 1 == points.size();
    if (is_last && open) break;
    const std::size_t next = is_last ? 0 : i + 1;
    if ((points[next] - points[i]).squaredNorm() > least * least) continue;
    const double distance = (points[next] - points[i]).norm();
    const std::string how_near =
        distance > 0 ? fmt::format(" but for {:.2g}, too little for a size of {:.4g}", distance, size) : "";
    throw InputError(fmt::format("{}: lines {} and {} hold the same point ({}, {}){}; remove one of them", name,
                                 data.lines[i], data.lines[next], points[next].x(), points[next].y(), how_near));
  }
}

/// Throws InputError: all points of a closed outline on one line, which encloses nothing.
void refuse_flat(const std::vector<Vec2>& points, double size, const std::string& name) {
  const Vec2& first = points.front();
  const auto is_nearer = [&](const Vec2& a, const Vec2& b) {
    return (a - first).squaredNorm() < (b - first).squaredNorm();
  };
  // The line through the first point and the one furthest from it.
  const Vec2 reach = *std::max_element(points.begin(), points.end(), is_nearer) - first;
  const double limit = kFlat * size * reach.norm();
  const auto is_on_line = [&](const Vec2& point) { return std::abs(cross(reach, point - first)) <= limit; };
  if (!std::all_of(points.begin(), points.end(), is_on_line)) return;
  throw InputError(fmt::format(
      "{}: all {} points lie on one line, a closed outline encloses an area; of an open one say so with `open`", name,
      points.size()));
}

/// Brings points whose header states a unit to the one that is wanted; without it they are taken to be in that.
void convert(NumberedPoints& data, const std::string& name, const std::string& wanted) {
  if (wanted.empty() || data.unit == wanted) return;
  if (!data.unit.empty()) {
    // By the exact ratio of the two units.
    const Conversion to = length_conversion(data.unit, wanted, name);
    for (Vec2& point : data.points) point = {to(point.x()), to(point.y())};
    data.notes.push_back(fmt::format("converted from {} to {}", data.unit, wanted));
  }
  data.unit = wanted;
}

// Points that are to be closed by a chord so many times as long as any other may lack a piece. (Those of an arc alone
// may be meant to be closed by its chord, which is that long where they are dense.)
constexpr double kWideGap = 20;

/// Notes that the chord which closes the outline is far longer than any other: points may be missing.
void note_wide_gap(const std::vector<Vec2>& points, const std::string& name, std::vector<std::string>& notes) {
  double longest = 0;
  for (std::size_t k = 1; k < points.size(); ++k) longest = std::max(longest, (points[k] - points[k - 1]).norm());
  const double gap = (points.front() - points.back()).norm();
  if (gap <= kWideGap * longest) return;
  notes.push_back(fmt::format(
      "{}: the last point is {:.4g} from the first, which closes the outline, and no other two neighbours are "
      "more than {:.4g} apart; `open` leaves it open",
      name, gap, longest));
}

}  // namespace

/// In this order: read the table, bring an airfoil into Selig's order, convert the unit, drop a last point that repeats
/// the first, and refuse what can't be an outline.
std::vector<Vec2> parse_points(std::string_view text, const std::string& name, const OutlineOptions& options,
                               std::vector<std::string>* notes, std::string* unit, bool* airfoil) {
  NumberedPoints data = read_point_table(text, name, options.decimal_comma);
  const std::string order = order_airfoil(data, name);
  if (!order.empty()) data.notes.push_back(order);
  if (airfoil != nullptr) *airfoil = !order.empty();
  convert(data, name, options.unit);
  if (unit != nullptr) *unit = data.unit;
  for (std::size_t k = 0; notes != nullptr && k < data.notes.size(); ++k) {
    notes->push_back(fmt::format("{}: {}", name, data.notes[k]));
  }
  // Before the size is taken, which needs two points.
  if (data.points.size() < 2) require_enough(data, name, options);
  const double size = box_around(data.points).diagonal().norm();
  if (!(size > 0)) {
    throw InputError(fmt::format("{}: all {} points are the same, ({}, {})", name, data.points.size(),
                                 data.points.front().x(), data.points.front().y()));
  }
  // The outline closes itself: a last point that repeats the first would be a chord without length.
  const bool ends_meet = (data.points.back() - data.points.front()).norm() <= kSamePoint * size;
  if (!options.open && ends_meet) {
    data.points.pop_back();
    data.lines.pop_back();
  }
  require_enough(data, name, options);
  if (notes != nullptr && !options.open && !ends_meet) note_wide_gap(data.points, name, *notes);
  // A scan that is smoothed may hold a point twice: a scanner at rest.
  if (!options.smooth) refuse_repeated(data, size, name, options.open);
  if (!options.open) refuse_flat(data.points, size, name);
  return std::move(data.points);
}

std::vector<Vec2> read_points(const std::string& path, const OutlineOptions& options, std::vector<std::string>* notes,
                              std::string* unit, bool* airfoil) {
  return parse_points(read_text(path), path == "-" ? "standard input" : path, options, notes, unit, airfoil);
}

Outline outline_through(const std::vector<Vec2>& points, const std::string& name, const OutlineOptions& options,
                        std::vector<std::string>* notes) {
  Outline outline;
  outline.name = name;
  outline.closed = !options.open;
  outline.unit = options.unit;
  // A corner angle that the user gives is obeyed; without one the neighbours decide between a corner and a nose.
  const double corner_angle = options.corner_angle.value_or(kCornerAngle);
  if (!options.smooth) {
    const bool is_usable = points.size() > 2;  // what is not is refused there
    outline.curves =
        options.corner_angle || !is_usable
            ? spline_through(points, outline.closed, corner_angle)
            : spline_with_corners(points, outline.closed, corners_of_points(points, outline.closed, options.airfoil));
    return outline;
  }
  // The tolerance may have a unit of its own: brought to that of the points.
  const double within = in_unit(*options.smooth, options.unit, "`smooth`");
  Smoothing smoothing = smooth_spline(points, outline.closed, within, corner_angle);
  if (notes != nullptr) {
    notes->push_back(fmt::format("smoothed: within {:.6g} of all {} points (largest deviation {:.4g}), {} curves, {}",
                                 within, points.size(), smoothing.deviation, smoothing.curves.size(),
                                 counted(smoothing.corners.size(), "corner", "corners")));
  }
  outline.curves = std::move(smoothing.curves);
  return outline;
}

}  // namespace rollfix
