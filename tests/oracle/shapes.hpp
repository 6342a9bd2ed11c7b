#pragma once

// Random outlines, each made twice from the same numbers: by the library and by the oracle's own formulas.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "oracle/boundary.hpp"
#include "oracle/formulas.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace oracle {

struct Shape {
  std::string name;
  rollfix::Outline asked;
  Curves formulas;
  int fold = 1;

  Boundary boundary() const { return {formulas, asked.closed, fold}; }
  rollfix::Part part() const {
    rollfix::PartOptions options;
    options.allow_crossing = true;  // it makes no difference here
    return rollfix::Part(asked, options);
  }
};

class RandomShapes {
 public:
  explicit RandomShapes(std::mt19937_64& generator) : generator_(generator) {}

  /// All kinds in turn.
  Shape shape(std::size_t k) {
    static constexpr std::array<Shape (RandomShapes::*)(), 16> kKinds = {
        &RandomShapes::ellipse,         &RandomShapes::spline,
        &RandomShapes::rounded_polygon, &RandomShapes::limacon,
        &RandomShapes::beziers,         &RandomShapes::gear,
        &RandomShapes::corners,         &RandomShapes::cam,
        &RandomShapes::open_path,       &RandomShapes::wing,
        &RandomShapes::symmetric_path,  &RandomShapes::superellipse,
        &RandomShapes::regular,         &RandomShapes::open_formula,
        &RandomShapes::drafted,         &RandomShapes::circle};
    return (this->*kKinds[k % kKinds.size()])();
  }
  static constexpr std::size_t kKindCount = 16;

  /// Those whose curvature varies, and two of lines and arcs, the last ones.
  Shape curved_shape(std::size_t k) {
    static constexpr std::array<std::size_t, 12> kCurved = {0, 1, 3, 4, 5, 7, 8, 9, 11, 13, 2, 10};
    return shape(kCurved[k % kCurved.size()]);
  }
  static bool is_drafted(std::size_t k) { return k % 12 >= 10; }

  double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(generator_); }
  int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(generator_); }
  /// Every order of magnitude alike.
  double scaled(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
  bool chance(double share) { return uniform(0, 1) < share; }

 private:
  static Shape from_gallery(const std::string& name, Curves curves, int fold = 1) {
    return {name, rollfix::gallery(name), std::move(curves), fold};
  }

  Shape circle() {
    const double r = scaled(1e-3, 1e3);
    return from_gallery(fmt::format("circle,r={}", r), oracle::circle(r), 0);
  }
  Shape ellipse() {
    const double a = scaled(0.1, 10), b = a * scaled(0.05, 20);
    return from_gallery(fmt::format("ellipse,a={},b={}", a, b), oracle::ellipse(a, b), 2);
  }
  Shape superellipse() {
    const double a = scaled(0.5, 2), b = scaled(0.5, 2);
    const int n = 2 * whole(2, 3);
    return from_gallery(fmt::format("superellipse,a={},b={},n={}", a, b, n), oracle::superellipse(a, b, n), 2);
  }
  Shape limacon() {
    const double b = uniform(-1, 1), a = std::abs(b) * scaled(1.03, 8);
    return from_gallery(fmt::format("limacon,a={},b={}", a, b), oracle::limacon(a, b));
  }
  Shape cam() {
    const double base = scaled(0.2, 5), lift = scaled(0.1, 3);
    return from_gallery(fmt::format("cam,base={},lift={}", base, lift), oracle::cam(base, lift));
  }
  Shape gear() {
    const int teeth = whole(2, 7);
    const double r = scaled(0.5, 2), depth = r * uniform(0.02, 1.2 / teeth);
    return from_gallery(fmt::format("gear,teeth={},r={},depth={}", teeth, r, depth), oracle::gear(teeth, r, depth),
                        teeth);
  }
  Shape spline() {
    const int n = whole(4, 30), seed = whole(1, 1000000);
    const double wobble = uniform(0.05, 0.4);
    return from_gallery(fmt::format("spline,n={},seed={},wobble={}", n, seed, wobble),
                        random_spline(n, static_cast<std::uint64_t>(seed), wobble));
  }
  Shape wing() {
    const int camber = whole(0, 6), place = camber == 0 ? 0 : whole(2, 6), thickness = whole(8, 24);
    const int digits = 1000 * camber + 100 * place + thickness;
    return from_gallery(fmt::format("naca,digits={:04}", digits), naca(digits));
  }
  Shape regular() {
    if (chance(0.3)) {
      const double width = scaled(0.1, 10);
      return from_gallery(fmt::format("reuleaux,width={}", width), reuleaux(width), 3);
    }
    const int n = whole(3, 12);
    const double r = scaled(0.1, 10);
    return from_gallery(fmt::format("polygon,n={},r={}", n, r), regular_polygon(n, r), n);
  }
  Shape drafted() {
    if (chance(0.5)) {
      const double length = scaled(0.1, 10), r = scaled(0.1, 10);
      return from_gallery(fmt::format("stadium,length={},r={}", length, r), stadium(length, r), 2);
    }
    const double width = scaled(0.5, 3), height = scaled(0.5, 3), r = 0.5 * std::min(width, height) * scaled(0.01, 0.9);
    return from_gallery(fmt::format("rounded-rectangle,width={},height={},r={}", width, height, r),
                        rounded_rectangle(width, height, r), 2);
  }
  Shape open_formula() {
    if (chance(0.5)) {
      const double a = scaled(0.1, 10), b = uniform(0.02, 0.5), turns = uniform(0.3, 3);
      return from_gallery(fmt::format("log-spiral,a={},b={},turns={}", a, b, turns), log_spiral(a, b, turns));
    }
    const double from = uniform(-4, 0), to = from + uniform(0.5, 4), scale = scaled(0.1, 10);
    return from_gallery(fmt::format("exponential,from={},to={},scale={}", from, to, scale),
                        exponential(from, to, scale));
  }

  // ---- drawings: the same numbers twice ----

  struct Drawing {
    std::vector<rollfix::Curve> asked;
    Curves known;

    void line(const rollfix::Vec2& from, const rollfix::Vec2& to) {
      asked.emplace_back(rollfix::Line(from, to));
      known.push_back(oracle::line({from.x(), from.y()}, {to.x(), to.y()}));
    }
    void arc(const rollfix::Vec2& centre, double radius, double from, double sweep) {
      asked.emplace_back(rollfix::Arc(centre, radius, from, sweep));
      known.push_back(oracle::arc(radius, from, sweep));
    }
    void bezier(const std::vector<rollfix::Vec2>& points) {
      asked.emplace_back(rollfix::Bezier(points));
      std::vector<Vector> same;
      for (const rollfix::Vec2& point : points) same.push_back({point.x(), point.y()});
      known.push_back(oracle::bezier(same));
    }
    Shape shape(const std::string& name, bool closed) {
      rollfix::Outline outline;
      outline.name = name;
      outline.curves = std::move(asked);
      outline.closed = closed;
      outline.gap = 1e-12;  // ends of arcs are rounded
      return {name, std::move(outline), std::move(known), 1};
    }
  };

  /// Around the origin, counter-clockwise.
  std::vector<rollfix::Vec2> star(int n, double least) {
    std::vector<rollfix::Vec2> points;
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * (k + uniform(-0.3, 0.3)) / n, radius = uniform(least, 1);
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return points;
  }

  /// A polygon whose corners are rounded with one radius, but for those that stay sharp.
  void round_off(Drawing& drawing, const std::vector<rollfix::Vec2>& points, double radius, double share_sharp) {
    const std::size_t n = points.size();
    struct Rounding {
      rollfix::Vec2 from, to, centre;
      double start = 0, sweep = 0;
    };
    std::vector<Rounding> roundings;
    for (std::size_t k = 0; k < n; ++k) {
      const rollfix::Vec2 here = points[k];
      const rollfix::Vec2 in = (here - points[(k + n - 1) % n]).normalized(),
                          out = (points[(k + 1) % n] - here).normalized();
      const double turn = std::atan2(rollfix::cross(in, out), in.dot(out));
      Rounding rounding{here, here, here};
      if (!chance(share_sharp)) {
        const double side = turn > 0 ? 1 : -1, cut = radius * std::tan(0.5 * std::abs(turn));
        const rollfix::Vec2 normal(-side * in.y(), side * in.x());
        rounding = {here - cut * in, here + cut * out, here - cut * in + radius * normal,
                    std::atan2(-normal.y(), -normal.x()), turn};
      }
      roundings.push_back(rounding);
    }
    for (std::size_t k = 0; k < n; ++k) {
      if (roundings[k].sweep != 0) drawing.arc(roundings[k].centre, radius, roundings[k].start, roundings[k].sweep);
      drawing.line(roundings[k].to, roundings[(k + 1) % n].from);
    }
  }

  Shape rounded_polygon() {
    Drawing drawing;
    round_off(drawing, star(whole(3, 9), 0.6), scaled(1e-4, 0.05), chance(0.5) ? 0 : 0.4);
    return drawing.shape("rounded polygon", true);
  }
  Shape corners() {
    Drawing drawing;
    round_off(drawing, star(whole(3, 9), 0.4), 1, 1);
    return drawing.shape("polygon", true);
  }
  Shape symmetric_path() {
    const int fold = whole(2, 5);
    const std::vector<rollfix::Vec2> sector = star(3 * fold, 0.7);
    std::vector<rollfix::Vec2> points;
    for (int k = 0; k < 3 * fold; ++k) {
      const double angle = 2 * std::numbers::pi * (k / 3) / fold, c = std::cos(angle), s = std::sin(angle);
      const rollfix::Vec2& point = sector[static_cast<std::size_t>(k % 3)];
      points.emplace_back(c * point.x() - s * point.y(), s * point.x() + c * point.y());
    }
    Drawing drawing;
    round_off(drawing, points, scaled(1e-3, 0.03), 0);
    return drawing.shape("symmetric path", true);  // to rounding: the oracle is not told
  }

  /// Cubic Bezier curves through points, smooth at most of them.
  void through(Drawing& drawing, const std::vector<rollfix::Vec2>& points, bool closed, double share_sharp) {
    const std::size_t n = points.size();
    std::vector<rollfix::Vec2> before, after;
    for (std::size_t k = 0; k < n; ++k) {
      const rollfix::Vec2 along = (points[(k + 1) % n] - points[(k + n - 1) % n]) * uniform(0.1, 0.22);
      before.push_back(points[k] - along);
      after.push_back(points[k] + along * uniform(0.7, 1.3));
      if (chance(share_sharp)) after.back() = points[k] + 0.3 * (points[(k + 1) % n] - points[k]);
    }
    for (std::size_t k = 0; k + (closed ? 0 : 1) < n; ++k) {
      drawing.bezier({points[k], after[k], before[(k + 1) % n], points[(k + 1) % n]});
    }
  }
  Shape beziers() {
    Drawing drawing;
    through(drawing, star(whole(4, 12), 0.7), true, chance(0.5) ? 0 : 0.3);
    return drawing.shape("Bezier curves", true);
  }
  Shape open_path() {
    Drawing drawing;
    if (chance(0.5)) {
      through(drawing, star(whole(4, 8), 0.7), false, 0.2);
      return drawing.shape("open Bezier curves", false);
    }
    round_off(drawing, star(whole(4, 8), 0.6), scaled(1e-3, 0.04), 0.3);
    drawing.asked.pop_back();
    drawing.known.pop_back();
    return drawing.shape("open path", false);
  }

  std::mt19937_64& generator_;
};

}  // namespace oracle
