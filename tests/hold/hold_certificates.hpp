#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <string>

#include "hold/hold_cases.hpp"
#include "hold/rig_cases.hpp"
#include "random_outlines.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/files.hpp"
#include "verified.hpp"

// Certificates of holds and of the rig, and random questions for them.
namespace hold_certificates {

using namespace verified;
using rig_cases::Held;
using rollfix::HoldAnswer;
using rollfix::HoldProblem;
using rollfix::Part;
using touch_cases::uniform;

inline Json certificate(const HoldProblem& problem, const HoldAnswer& answer) {
  return Json::parse(rollfix::format_certificate(rollfix::certify_holds(problem, answer)));
}
inline Json certificate(const HoldProblem& problem) { return certificate(problem, rollfix::solve(problem)); }

/// The same with tolerances that a robot has.
inline HoldProblem within(HoldProblem problem, double length, double angle) {
  problem.tolerance = rollfix::TouchTolerance{length, angle};
  return problem;
}

/// A jaw and a wheel about a smooth part: without noise or with, with the wheel's encoder or without, by the digits of
/// the logs or within a tolerance.
inline HoldProblem random_rig_question(int kind, std::mt19937_64& generator) {
  const std::string seed = std::to_string(std::uniform_int_distribution<int>(1, 1000)(generator));
  const std::string names[] = {"gallery:cam", "gallery:ellipse,a=2,b=1", "gallery:spline,n=9,wobble=0.1,seed=" + seed,
                               "gallery:superellipse", "gallery:limacon"};
  const Part part = rollfix::load_part(names[kind % 5]);
  const double size = part.perimeter();
  const bool has_encoder = uniform(generator, 0, 1) < 0.5;
  rig_cases::RigCase one =
      rig_cases::random_rig(part, uniform(generator, 0.02, 0.07) * size, generator, has_encoder, 16);
  const double how = uniform(generator, 0, 1);
  if (how < 0.4) {
    return rig_cases::noisy(one, {1e-3 * size, 0.005, 1e-3 * size, how < 0.1 ? 1e-4 * size : 0}, generator).problem;
  }
  if (how < 0.6) return one.problem;
  return within(one.problem, std::pow(10, uniform(generator, -5, -2.5)) * size,
                std::pow(10, uniform(generator, -4, -2)));
}

/// Three or four disks about a part: splines, polygons, a bracket; with x and y or without.
inline HoldProblem random_hold_question(int kind, std::mt19937_64& generator) {
  const std::string seed = std::to_string(std::uniform_int_distribution<int>(1, 1000)(generator));
  const Part part = kind % 3 == 0   ? rollfix::load_part("gallery:spline,n=9,wobble=0.2,seed=" + seed)
                    : kind % 3 == 1 ? touch_cases::random_polygon(generator)
                                    : touch_cases::bracket();
  hold_cases::Holding holding;
  holding.fingers = uniform(generator, 0, 1) < 0.7 ? 3 : 4;
  holding.rows = 16;
  holding.centres = kind % 3 != 0 || uniform(generator, 0, 1) < 0.7;
  const double how = uniform(generator, 0, 1);
  if (how < 0.4) {
    holding.contact_sd = holding.place_sd = 0.002;
    holding.angle_sd = 0.005;
  }
  HoldProblem problem = hold_cases::random_hold(part, holding, generator).problem;
  if (how < 0.4 || how > 0.8) return problem;
  return within(problem, std::pow(10, uniform(generator, -4, -2.5)) * touch_cases::diagonal(part),
                std::pow(10, uniform(generator, -3, -2)));
}

}  // namespace hold_certificates
