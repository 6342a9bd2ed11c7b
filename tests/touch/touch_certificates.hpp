#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include "outline/turn.hpp"
#include "paths.hpp"
#include "random_outlines.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/files.hpp"
#include "touch/touch_cases.hpp"
#include "verified.hpp"

// Certificates of touches, and random questions for them.
namespace touch_certificates {

using namespace verified;
using namespace touch_cases;

inline Json certificate(const TouchAnswer& answer) {
  return Json::parse(rollfix::format_certificate(rollfix::certify_touches(answer)));
}
inline Json certificate(TouchProblem problem) {
  problem.diagnose = false;
  return certificate(rollfix::solve(problem));
}

/// Touches that are within a tolerance of length, and of angle.
inline TouchProblem within(const Part& part, std::vector<MeasuredTouch> touches, double length, double angle = 0.02) {
  TouchProblem problem{part, std::move(touches)};
  problem.tolerance = rollfix::TouchTolerance{length, angle};
  return problem;
}

/// Splines, an airfoil, polygons with corners both ways, lines and arcs, open ones among them.
inline Part random_part(int kind, std::mt19937_64& generator) {
  const int seed = std::uniform_int_distribution<int>(1, 1000)(generator);
  switch (kind % 7) {
    case 0:
      return rollfix::load_part("gallery:spline,n=9,wobble=0.25,seed=" + std::to_string(seed));
    case 1:
      return rollfix::load_part("gallery:spline,n=30,wobble=0.12,seed=" + std::to_string(seed));
    case 2:
      return rollfix::load_part("gallery:naca,digits=2412");
    case 3:
      return random_polygon(generator);
    case 4:
      return bracket();
    case 5:
      return rollfix::load_part(checked_out("examples/bracket.dxf"), {}).part;
    default:
      for (;;) {
        if (const std::optional<Part> part = random_outlines::outline(generator)) return *part;
      }
  }
}

/// Two to five touches, of a point or of a disk, with normals or without, in noise or within a tolerance, of a part
/// that lies face up or face down.
inline TouchProblem random_question(int kind, std::mt19937_64& generator, double least = 1e-4) {
  const Part part = random_part(kind, generator);
  const double size = diagonal(part);
  Making making;
  making.count = std::uniform_int_distribution<std::size_t>(2, 5)(generator);
  making.normals =
      uniform(generator, 0, 1) < 0.5 ? 0 : std::uniform_int_distribution<std::size_t>(0, making.count)(generator);
  making.radius = uniform(generator, 0, 1) < 0.4 ? 0 : uniform(generator, 0.01, 0.15) * size;
  making.place_sd = least * std::pow(1e-2 / least, uniform(generator, 0, 1)) * size;
  making.angle_sd = std::pow(10, uniform(generator, -3, -1.2));
  TouchProblem problem = random_case(part, making, generator).problem;
  problem.diagnose = false;
  if (uniform(generator, 0, 1) < 0.5) {
    problem.noise.reset();
    problem.tolerance =
        rollfix::TouchTolerance{rollfix::kPossibleSigmas * making.place_sd, rollfix::kPossibleSigmas * making.angle_sd};
  }
  problem.mirrored = uniform(generator, 0, 1) < 0.25;
  for (MeasuredTouch& touch : problem.touches) {
    if (!problem.mirrored) break;
    touch.at.x() = -touch.at.x();
    if (touch.normal) touch.normal = std::numbers::pi - *touch.normal;
  }
  return problem;
}

}  // namespace touch_certificates
