#pragma once

#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "touch/roll_cases.hpp"
#include "touch/touch_certificates.hpp"
#include "touch/touch_liar.hpp"

// Certificates of rolls and touches that share a pose: random questions for them, and lies.
namespace roll_certificates {

using namespace roll_cases;
using touch_certificates::Json;

/// As a mirror shows them: of a part that lies face down.
inline TouchProblem face_down(TouchProblem problem) {
  for (Log& log : problem.rolls) {
    rollfix::FingerRows& rows = log.fingers.front();
    for (double& u : rows.u) u = -u;
    for (double& psi : rows.psi) psi = std::numbers::pi - psi;
    for (double& x : rows.x) x = -x;
  }
  for (MeasuredTouch& touch : problem.touches) {
    touch.at.x() = -touch.at.x();
    if (touch.normal) touch.normal = std::numbers::pi - *touch.normal;
  }
  problem.mirrored = true;
  return problem;
}

/// How a question is made.
struct Asking {
  Rolling rolling{};
  double length = 1e-3;  // tolerances: a share of the diagonal, ...
  double angle = 1e-3;   // ... and radians
  bool some_centres = true;
  bool normals = true;
};

inline TouchProblem question(const Part& part, Asking asking, std::mt19937_64& generator) {
  asking.rolling.place_sd = 0.2 * asking.length;
  asking.rolling.angle_sd = 0.1 * asking.angle;
  TouchProblem problem = random_rolls(part, asking.rolling, generator).problem;
  problem.noise.reset();
  problem.tolerance = {asking.length * diagonal(part), asking.angle};
  for (Log& log : problem.rolls) {
    const bool keeps = &log == &problem.rolls.front() || !asking.some_centres || uniform(generator, 0, 1) < 0.7;
    if (!keeps) log.fingers.front().x = log.fingers.front().y = {};
  }
  for (MeasuredTouch& touch : problem.touches) {
    if (!asking.normals || uniform(generator, 0, 1) < 0.4) touch.normal.reset();
  }
  return uniform(generator, 0, 1) < 0.25 ? face_down(problem) : problem;
}

/// Two rolls with x and y, exact but for a tolerance.
inline TouchProblem two_rolls(const Part& part, std::mt19937_64& generator) {
  Rolling rolling;
  rolling.rows = 10;
  TouchProblem problem = random_rolls(part, rolling, generator).problem;
  problem.tolerance = {1e-3 * diagonal(part), 1e-3};
  return problem;
}

/// One to three rolls, with x and y or without, and up to two touches, of a part of this kind.
inline TouchProblem random_question(int kind, std::mt19937_64& generator) {
  const Part part = touch_certificates::random_part(kind % 6, generator);
  Asking asking;
  asking.rolling.count = std::uniform_int_distribution<std::size_t>(1, 3)(generator);
  asking.rolling.touches = std::uniform_int_distribution<std::size_t>(asking.rolling.count == 1 ? 1 : 0, 2)(generator);
  asking.rolling.length = uniform(generator, 0.03, 0.15);
  asking.rolling.rows = 10;
  asking.rolling.radius = uniform(generator, 0.01, 0.04);
  asking.rolling.centres = uniform(generator, 0, 1) < 0.7;
  asking.length = std::pow(10, uniform(generator, -3.5, -2));
  asking.angle = std::pow(10, uniform(generator, -4, -1.7));
  return question(part, asking, generator);
}

/// Lies about rolls, besides those about poses.
inline std::vector<touch_liar::Lie> lies() {
  using touch_liar::Document;
  std::vector<touch_liar::Lie> all = touch_liar::about_poses();
  const auto any_reading = [](Document& d) -> Json& {
    Json& readings = d.any("rolls")["readings"];
    return readings[std::uniform_int_distribution<std::size_t>(0, readings.size() - 1)(d.generator)];
  };
  all.push_back({"a reading that turned further", [=](Document& d) {
                   Document::add(any_reading(d)["turn"], 4 * d.sign() * d.json["rolls"][0]["within"].get<double>());
                   return true;
                 }});
  all.push_back({"a reading that went further", [=](Document& d) {
                   Document::add(any_reading(d)["length"], 0.2 * d.json["perimeter"].get<double>());
                   return true;
                 }});
  all.push_back({"a roll the other way", [](Document& d) {
                   for (Json& one : d.any("rolls")["readings"]) Document::scale(one["length"], -1);
                   return true;
                 }});
  all.push_back({"a roll whose turns are reversed", [](Document& d) {
                   for (Json& one : d.any("rolls")["readings"]) {
                     Document::add(one["turn"], 0.3 + 100 * d.json["rolls"][0]["within"].get<double>());
                   }
                   return true;
                 }});
  all.push_back({"a roll without readings", [](Document& d) {
                   d.any("rolls")["readings"] = Json::array();
                   return true;
                 }});
  all.push_back({"a roll without a normal", [](Document& d) { return d.any("rolls").erase("normal") > 0; }});
  all.push_back({"a roll whose normal is turned", [](Document& d) {
                   Document::add(d.any("rolls")["normal"], d.sign() * uniform(d.generator, 0.5, 3));
                   return true;
                 }});
  all.push_back({"a roll that was elsewhere", [](Document& d) {
                   Json& roll = d.any("rolls");
                   if (!roll.contains("at")) return false;
                   Document::add(roll["at"][1], 3 * d.sign() * roll["tolerance"][0].get<double>());
                   return true;
                 }});
  all.push_back({"a roll exact beyond rounding", [](Document& d) {
                   d.any("rolls")["within"] = 1e-13;
                   return true;
                 }});
  all.push_back({"a roll left out", [](Document& d) {
                   d.json["rolls"].erase(d.json["rolls"].size() - 1);
                   return true;
                 }});
  all.push_back({"all rolls left out, with their contacts", [](Document& d) {
                   if (d.json["touches"].size() > 1) return false;
                   const std::size_t rolls = d.json["rolls"].size();
                   d.json.erase("rolls");
                   for (Json& pose : d.json["poses"]) {
                     for (std::size_t k = 0; k < rolls; ++k) pose["contacts"].erase(0);
                   }
                   return true;
                 }});
  all.push_back({"rolls in another order", [](Document& d) {
                   if (d.json["rolls"].size() < 2) return false;
                   std::swap(d.json["rolls"][0], d.json["rolls"][1]);
                   return true;
                 }});
  return all;
}

}  // namespace roll_certificates
