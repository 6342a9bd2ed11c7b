#include "places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "outline/shapes/shapes.hpp"
#include "part/part_data.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "text/text.hpp"

// Notation:
//   s, u            arc length, and the parameter of the outline's curve there, by its formula: CurvePlace
//   joint           where two curves meet: rows keep `kClear` P away from it, `least_step`
//   rest            an end of a curve at which its velocity is 0
// Follows docs/certificates.md, "What is in it".
namespace rollfix::certifying {
namespace {

using Records = std::vector<CurveRecord>;

/// |x / a|^n + |y / b|^n = 1. For even n the formula needs no absolute values: one curve. For odd n one curve a
/// quarter; each quarter is the first one turned by 90 degrees times its number, so that a and b swap in every other
/// one.
Records superellipse(double a, double b, double n) {
  // Even: smooth all around.
  if (std::fmod(n, 2) == 0) return {{"superellipse", {a, b, n}}};
  Records records;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const bool swapped = quarter % 2 == 1;
    records.push_back({"superellipse-quarter", {swapped ? b : a, swapped ? a : b, n, static_cast<double>(quarter)}});
  }
  return records;
}

/// A four-digit NACA section: largest camber in % of the chord, its place in tenths, thickness in %. Along the outline
/// v runs from -1 (upper side, trailing edge) over 0 (nose) to 1; the place along the chord is v^2.
Records naca(const std::string& digits, double chord) {
  const double height = (digits[0] - '0') / 100.0;
  const double place = (digits[1] - '0') / 10.0;
  const double thickness = ((digits[2] - '0') * 10 + (digits[3] - '0')) / 100.0;
  // Without camber each side is one curve; with it the camber line is two parabolas, which meet at v = +-sqrt(place).
  if (height == 0) return {{"naca-upper", {chord, thickness}}, {"naca-lower", {chord, thickness}}};
  const double top = std::sqrt(place);
  const auto piece = [&](const char* kind, double from, double to) {
    return CurveRecord{kind, {chord, thickness, height, place, from, to}};
  };
  return {piece("naca-upper-aft", -1, -top), piece("naca-upper-fore", -top, 0), piece("naca-lower-fore", 0, top),
          piece("naca-lower-aft", top, 1)};
}

/// The gallery's shapes with formulas of their own; none of those that are made of other curves.
Records of_shape(const std::string& name, const Parameters& is) {
  // The shape's parameters by name, in the order in which the verifier reads them.
  const auto listed = [&](const auto&... names) { return Records{{name, {is.number(names)...}}}; };
  if (name == "limacon") return listed("a", "b");
  if (name == "cam") return listed("base", "lift");
  if (name == "gear") return listed("r", "depth", "teeth");
  if (name == "log-spiral") return listed("a", "b", "turns");
  if (name == "exponential") return listed("scale", "from", "to");
  if (name == "superellipse") return superellipse(is.number("a"), is.number("b"), is.number("n"));
  if (name == "naca") return naca(is.text("digits"), is.number("chord"));
  return {};
}

/// Of a gallery's specification, "gallery:ellipse,a=2,b=1".
Records of_gallery(const std::string& specification) {
  const std::string_view text(specification);
  // "ellipse", "a=2", "b=1"
  const std::vector<std::string_view> parts = split(text.substr(text.find(':') + 1), ',');
  ParameterList parameters;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const std::size_t equals = parts[k].find('=');
    parameters.emplace_back(trimmed(parts[k].substr(0, equals)), trimmed(parts[k].substr(equals + 1)));
  }
  // A name that the gallery does not have, and a shape made of other curves, give an empty list.
  const std::string name(parts.front());
  const auto& shapes = gallery_shapes();
  const auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const auto& one) { return one.name == name; });
  return shape == shapes.end() ? Records{} : of_shape(name, Parameters(*shape, parameters));
}

/// The formulas of an outline's curves by name and numbers, those of the gallery included. Throws InputError: a curve
/// that has none.
std::vector<CurveRecord> formulas_of(const Outline& outline) {
  // A reversed gallery outline has other curves than its specification: there each curve states its own formula.
  const bool is_as_given = !outline.gallery.empty() && !outline.reversed;
  Records records = is_as_given ? of_gallery(outline.gallery) : Records{};
  // One formula per curve is needed, because places are stated as (curve, parameter).
  if (records.size() == outline.curves.size()) return records;
  records.clear();
  for (const Curve& curve : outline.curves) {
    const std::optional<CurveRecord> record = curve.formula();
    if (!record) {
      throw InputError(fmt::format("{}: curve {} is of a kind that certificates have no formula for", outline.name,
                                   records.size() + 1));
    }
    records.push_back(*record);
  }
  return records;
}

// Rows keep this share of the perimeter from joints: there is no doubt on which curve a roll ends.
constexpr double kClear = 4e-12;
constexpr int kMostSteps = 8;
// A curve's speed at one end is below this share of that at the other one: it is at rest there.
constexpr double kResting = 1e-6;

/// Of a place to where curves meet, on either side.
double distance_to_joint(const Part& part, double s) {
  const TurningFunction& turning = part.turning();
  const auto& pieces = PartAccess::data(part).parametrization.pieces;
  const auto& panels = turning.panels();
  const double base = part.boundary().base(s);
  // A curve consists of several panels: their borders inside of one curve are not joints. The panels that begin or end
  // within one step of s are merged with their neighbours of the same curve, which is enough to compare with a step.
  const double step = least_step(part);
  const Spiral& spiral = turning.spirals()[turning.spiral_at(base)];
  std::size_t first = turning.panel_index(spiral, base);
  std::size_t last = first;
  while (first > 0 && pieces[first - 1].curve == pieces[first].curve && base - panels[first].lo < step) --first;
  while (last + 1 < pieces.size() && pieces[last + 1].curve == pieces[last].curve && panels[last].hi - base < step) {
    ++last;
  }
  return std::min(base - panels[first].lo, panels[last].hi - base);
}

/// The largest distance between the end of a curve and the start of the next one, in the part's unit. A closed outline
/// includes the last and the first curve.
double largest_gap(const Outline& outline) {
  double largest = 0;
  const std::size_t count = outline.curves.size();
  // With one closed curve this is the distance of its own ends.
  for (std::size_t k = 0; k + (outline.closed ? 0 : 1) < count; ++k) {
    largest = std::max(largest, (outline.curves[k].back() - outline.curves[(k + 1) % count].front()).norm());
  }
  return largest;
}

}  // namespace

double least_step(const Part& part) { return kClear * part.perimeter(); }

/// O(log n) in the number of spirals and panels. The clamp takes off what rounding adds beyond the curve's domain.
CurvePlace place_of(const Part& part, double s) {
  const TurningFunction& turning = part.turning();
  const PartAccess::Data& data = PartAccess::data(part);
  const double base = part.boundary().base(s);
  const Spiral& spiral = turning.spirals()[turning.spiral_at(base)];
  const std::uint32_t index = turning.panel_index(spiral, base);
  const Panel& panel = turning.panels()[index];
  const std::size_t curve = data.parametrization.pieces[index].curve;
  const Curve& here = data.outline.curves[curve];
  const Interval domain = here.domain();
  // Local coordinate of the panel, -1 to 1, to the curve's own parameter; then to the parameter of the stated formula.
  const double u = data.parametrization.parameter(index, (base - panel.middle) * panel.inverse_half);
  return {curve, here.formula_parameter(std::clamp(u, domain.lo, domain.hi))};
}

/// s of all curve ends where the speed |alpha'(u)| is below `kResting` of that at the curve's other end: Bezier curves
/// whose first or last control points coincide. The curvature may be infinite there.
std::vector<double> places_at_rest(const Part& part) {
  const PartAccess::Data& data = PartAccess::data(part);
  const auto& pieces = data.parametrization.pieces;
  const auto& panels = part.turning().panels();
  std::vector<double> result;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    // A panel of another curve stands before this one, or behind it: here the curve starts, or ends.
    const bool begins = k == 0 || pieces[k - 1].curve != pieces[k].curve;
    const bool ends = k + 1 == panels.size() || pieces[k + 1].curve != pieces[k].curve;
    if (!begins && !ends) continue;
    const Curve& curve = data.outline.curves[pieces[k].curve];
    const double first = curve.velocity(curve.domain().lo).norm();
    const double last = curve.velocity(curve.domain().hi).norm();
    if (begins && first < kResting * last) result.push_back(panels[k].lo);
    if (ends && last < kResting * first) result.push_back(panels[k].hi);
  }
  return result;
}

/// `lengths`: of the contacts beside the first one, measured from s. Stops after `kMostSteps` steps also where some
/// contact is still near a joint.
double clear_of_joints(const Part& part, const std::vector<double>& lengths, double s, int way) {
  const double step = least_step(part);
  // Of the contact that is nearest to a joint: all contacts move by the same step.
  const auto distance = [&] {
    double least = distance_to_joint(part, s);
    for (const double length : lengths) least = std::min(least, distance_to_joint(part, s + length));
    return least;
  };
  for (int k = 0; k < kMostSteps; ++k) {
    if (distance() >= 0.5 * step) break;
    s += way * step;
  }
  return s;
}

Interval clear_starts(const Part& part, const std::vector<double>& lengths) {
  Interval range{0, part.perimeter()};
  if (part.closed()) return range;
  const double step = least_step(part);
  for (const double length : lengths) {
    // 0 <= s + L <= P, for a roll forwards and for one backwards.
    range.lo = std::max(range.lo, -length);
    range.hi = std::min(range.hi, part.perimeter() - length);
  }
  // Less than the steps that rows need on both sides.
  if (!(range.width() > 8 * step)) {
    throw InputError(part.name() + ": a roll as long as an open outline leaves one start: nothing to certify");
  }
  return {clear_of_joints(part, lengths, range.lo + step, 1), clear_of_joints(part, lengths, range.hi - step, -1)};
}

CertifiedOutline certified_outline(const Part& part) {
  CertifiedOutline result;
  result.part = part.name();
  result.closed = part.closed();
  result.perimeter = part.perimeter();
  result.curves = formulas_of(part.outline());
  result.origin = part.outline().curves.front().front();
  result.gap = largest_gap(part.outline());
  return result;
}

}  // namespace rollfix::certifying
