#pragma once

// What must hold of every search, whatever the outline, of one finger and of two alike: random questions, ways to ask
// the same in other words, and what it means that two answers are the same.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "oracle/shapes.hpp"
#include "rollfix/locate.hpp"

namespace laws {

using namespace rollfix;

/// An outline and readings of a roll on it.
struct Asked {
  std::string name;  // of the outline, with what draws it again
  Outline outline;
  std::vector<Reading> readings;
  LocateOptions options;
  PerFinger<double> start;  // where they were taken

  Part part() const {
    PartOptions crossing;
    crossing.allow_crossing = true;
    return Part(outline, crossing);
  }
  Search search() const { return locate(part(), readings, options); }
  bool has_corners() const { return !part().corners().empty(); }
};

inline double turn(const Part& part, double s, double length) {
  return part.turning().angle(s + length) - part.turning().angle(s);
}

/// Readings from random starts, of any lengths that the part allows.
inline Asked asked(std::size_t kind, std::uint64_t seed, std::size_t fingers, std::size_t readings, bool faces) {
  std::mt19937_64 generator(seed);
  oracle::RandomShapes random(generator);
  const oracle::Shape shape = random.shape(kind);
  Asked asked{fmt::format("{} (kind {}, seed {})", shape.name, kind, seed),
              shape.asked,
              {},
              {},
              PerFinger<double>::of(fingers)};
  asked.outline.gallery.clear();  // it will be another one
  const Part part = asked.part();
  const double P = part.perimeter();
  for (double& start : asked.start) start = random.uniform(0, 1) * P;
  const auto length = [&](double start) {
    return part.closed() ? random.uniform(-1.2, 1.2) * P : random.uniform(0.01, 0.99) * P - start;
  };
  for (std::size_t k = 0; k < readings; ++k) {
    Reading reading;
    reading.length = PerFinger<double>::of(fingers);
    for (std::size_t finger = 0; finger < fingers; ++finger) {
      reading.length[finger] = length(asked.start[finger]);
      reading.turn += (finger == 0 ? 1 : -1) * turn(part, asked.start[finger], reading.length[finger]);
    }
    asked.readings.push_back(reading);
  }
  if (fingers == 2 && faces) {
    asked.options.facing = part.turning().angle(asked.start[0]) - part.turning().angle(asked.start[1]);
  }
  return asked;
}

/// Of all kinds of outlines.
inline rc::Gen<Asked> any_asked(std::size_t fingers, std::size_t readings, bool faces) {
  const auto kinds = rc::gen::inRange<std::size_t>(0, oracle::RandomShapes::kKindCount);
  const auto seeds = rc::gen::inRange<std::uint64_t>(0, 1000000);
  return rc::gen::resize(
      rc::kNominalSize,
      rc::gen::apply([=](std::size_t kind, std::uint64_t seed) { return asked(kind, seed, fingers, readings, faces); },
                     kinds, seeds));
}

/// With as many readings as are needed, or one more.
inline rc::Gen<Asked> any_asked_of(std::size_t fingers) {
  if (fingers == 1) return rc::gen::oneOf(any_asked(1, 1, false), any_asked(1, 2, false));
  return rc::gen::oneOf(any_asked(2, 2, false), any_asked(2, 3, false), any_asked(2, 1, true), any_asked(2, 2, true));
}
inline rc::Gen<Asked> any_asked() { return rc::gen::oneOf(any_asked_of(1), any_asked_of(2)); }

inline void showValue(const Asked& asked, std::ostream& out) {
  out << asked.name << (asked.outline.closed ? "" : ", open");
  for (const Reading& reading : asked.readings) {
    out << " {";
    for (const double length : reading.length) out << fmt::format("{:.17g}, ", length);
    out << fmt::format("{:.17g}}}", reading.turn);
  }
  if (asked.options.facing) out << fmt::format(" facing {:.17g}", *asked.options.facing);
}

// ---- other words ----

/// The same curve, seen by f: what it does to points, without a shift, is linear, and bends no parameter.
struct Moved {
  Curve curve;
  Eigen::Matrix2d turned;
  Vec2 shift;

  Interval domain() const { return curve.domain(); }
  Jet jet(double u) const {
    const Jet jet = curve.jet(u);
    return {turned * jet.position + shift, turned * jet.first, turned * jet.second, turned * jet.third};
  }
};

/// The parameter runs faster at one end than at the other, within a part of the curve's domain.
struct Paced {
  Curve curve;
  Interval part;
  double bend;  // in (-1, 1)

  Interval domain() const { return {0, 1}; }
  Jet jet(double x) const {
    const double u = part.lo + part.width() * (x + bend * x * (1 - x));
    const double first = part.width() * (1 + bend * (1 - 2 * x)), second = -2 * bend * part.width();
    const Jet jet = curve.jet(u);
    return {jet.position, first * jet.first, first * first * jet.second + second * jet.first,
            first * first * first * jet.third + 3 * first * second * jet.second};
  }
};

inline void move(Asked& asked, const Eigen::Matrix2d& turned, const Vec2& shift) {
  for (Curve& curve : asked.outline.curves) curve = Moved{curve, turned, shift};
}

inline Eigen::Matrix2d turned_by(double angle) {
  Eigen::Matrix2d turned;
  turned << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return turned;
}

/// Every curve in two, at this share of its parameter.
inline void cut(Asked& asked, double share) {
  std::vector<Curve> pieces;
  for (const Curve& curve : asked.outline.curves) {
    const Interval domain = curve.domain();
    const double at = domain.lo + share * domain.width();
    pieces.emplace_back(Paced{curve, {domain.lo, at}, 0});
    pieces.emplace_back(Paced{curve, {at, domain.hi}, 0});
  }
  asked.outline.curves = std::move(pieces);
}

/// A closed outline starts with another curve: by how much further on.
inline double start_at(Asked& asked, std::size_t curve) {
  std::vector<Curve>& curves = asked.outline.curves;
  Asked before = asked;
  before.outline.closed = false;
  before.outline.curves.assign(curves.begin(), curves.begin() + static_cast<std::ptrdiff_t>(curve));
  std::rotate(curves.begin(), curves.begin() + static_cast<std::ptrdiff_t>(curve), curves.end());
  return before.part().perimeter();
}

inline void turn_round(std::vector<Reading>& readings) {
  for (Reading& reading : readings) {
    for (double& length : reading.length) length = -length;
    reading.turn = -reading.turn;
  }
}

// ---- the same answer ----

/// Where a place is in other words: from the other end, then shifted, then scaled.
struct Map {
  bool backwards = false;
  PerFinger<double> shift{0, 0};
  double factor = 1;
  bool swapped = false;
  bool starts_only = false;  // the tolerance is that of other differences: extents may be others

  Interval extent(const Part& part, const Placement& placement, std::size_t finger) const {
    Interval arc = placement.extent[finger];
    if (backwards) arc = {part.perimeter() - arc.hi, part.perimeter() - arc.lo};
    return {factor * (arc.lo + shift[finger]), factor * (arc.hi + shift[finger])};
  }
};

/// Of the perimeter, by which places may differ; and of an extent's width, which is good to so much, and where it is
/// the set around a double root, whose width is a square root of what is rounded, to so much.
inline constexpr double kPlace = 1e-7, kWidth = 0.02, kWidthOfTouching = 0.15;

inline bool is_same(const Part& part, const Placement& placement, const Map& map, const Part& other_part,
                    const Placement& other) {
  if (placement.kind != other.kind) return false;
  if (map.starts_only && placement.kind == Kind::stretch) return true;
  for (std::size_t finger = 0; finger < placement.extent.size(); ++finger) {
    const std::size_t same = map.swapped ? 1 - finger : finger;
    if (placement.whole_loop[finger] != other.whole_loop[same]) return false;
    if (placement.whole_loop[finger]) continue;
    const Interval arc = map.extent(part, placement, finger), found = other.extent[same];
    const double share = placement.kind == Kind::touching ? kWidthOfTouching : kWidth;
    const double slack = kPlace * other_part.perimeter() + share * arc.width();
    if (map.starts_only) {
      const double off = placement.start[finger] + map.shift[finger] - other.start[same];
      if (std::abs(std::remainder(off, other_part.closed() ? other_part.perimeter() : 1e300)) > slack) return false;
      continue;
    }
    if (std::abs(arc.width() - found.width()) > slack) return false;
    if (other_part.boundary().distance(arc.middle(), found.middle()) > slack) return false;
  }
  return true;
}

/// Whether an answer to the question in other words is the same answer, there.
inline void expect_same(const Asked& asked, const Asked& in_other_words, const Map& map) {
  const Part part = asked.part(), other_part = in_other_words.part();
  const Search search = asked.search(), other = in_other_words.search();
  RC_ASSERT(search.status == other.status);
  RC_ASSERT(search.placements.size() == other.placements.size());
  for (const Placement& placement : search.placements) {
    const bool found = std::any_of(other.placements.begin(), other.placements.end(), [&](const Placement& candidate) {
      return is_same(part, placement, map, other_part, candidate);
    });
    if (!found) RC_FAIL(fmt::format("{} at {:.12g} is not there", name_of(placement.kind), placement.start[0]));
  }
}

}  // namespace laws
