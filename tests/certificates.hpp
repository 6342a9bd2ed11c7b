#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "check.hpp"
#include "random.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

// What tests of certificates have in common: parts, and certificates with a number changed.
namespace certificates {

using Json = nlohmann::json;
using rollfix_verify::Verdict;
using shapes::kPi;

inline Verdict checked(const Json& certificate) { return rollfix_verify::check(certificate.dump()); }

/// Of one finger.
inline Json certificate(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                        double tolerance = 1e-9) {
  rollfix::LocateOptions options;
  options.tolerance = tolerance;
  return Json::parse(format_certificate(certify(part, readings, options)));
}

inline std::string described(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                             double tolerance) {
  std::string question = fmt::format("{}, tolerance {}", part.name(), tolerance);
  for (const rollfix::Reading& one : readings) question += fmt::format(", {} turns by {}", one.length[0], one.turn);
  return question;
}

/// Nothing in it is refused, and all that the search found stands in it: is all of it proved?
inline bool is_proved(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                      double tolerance = 1e-9) {
  SCOPED_TRACE(described(part, readings, tolerance));
  const Verdict verdict = checked(certificate(part, readings, tolerance));
  EXPECT_EQ(verdict.refusal, "");
  rollfix::LocateOptions options;
  options.tolerance = tolerance;
  EXPECT_EQ(verdict.placements, locate(part, readings, options).placements.size());
  return verdict.is_complete();
}

inline void expect_proved(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                          double tolerance = 1e-9) {
  EXPECT_TRUE(is_proved(part, readings, tolerance)) << described(part, readings, tolerance);
}

/// Of random questions: a few are too near to the edge of the tolerance, or to what rounding leaves of it.
inline int most_unproved(int questions) { return questions / 50; }

inline std::size_t count_of(const Json& certificate, const std::string& kind) {
  std::size_t count = 0;
  for (const Json& row : certificate["rows"]) count += row.value("then", "") == kind ? 1 : 0;
  return count;
}

inline double uniform(std::mt19937_64& generator, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(generator);
}

inline rollfix::Part random_spline(std::mt19937_64& generator) {
  const int n = std::uniform_int_distribution<int>(4, 12)(generator);
  std::vector<rollfix::Vec2> points;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * kPi * k / n;
    points.push_back(uniform(generator, 0.8, 1.2) * rollfix::Vec2(std::cos(angle), std::sin(angle)));
  }
  rollfix::Outline outline;
  outline.name = "random spline";
  outline.curves = rollfix::spline_through(points, true);
  return rollfix::Part(outline);
}

/// A plate as drawings have it: a Bezier curve, lines, an arc, an arc of an ellipse, a rational Bezier curve.
inline rollfix::Part drawn_plate() {
  rollfix::Outline outline;
  outline.name = "plate";
  outline.curves = {rollfix::Bezier({{0, 0}, {1, -0.7}, {2, 0.5}, {3, 0}}),
                    rollfix::Arc({3, 1}, 1, -kPi / 2, kPi / 2),
                    rollfix::Line({4, 1}, {4, 2}),
                    rollfix::EllipticArc({2, 2}, {2, 0}, {0, 1}, 0, kPi / 2),
                    rollfix::Bezier({{2, 3}, {0, 3}, {0, 1}}, {1, std::sqrt(0.5), 1}),
                    rollfix::Line({0, 1}, {0, 0})};
  return rollfix::Part(outline);
}

/// Where its numbers are, as JSON pointers.
inline std::vector<Json::json_pointer> numbers_of(const Json& certificate) {
  std::vector<Json::json_pointer> places;
  const Json flat = certificate.flatten();
  for (const auto& [place, value] : flat.items()) {
    const bool names_a_reading = place.find("/by/") != std::string::npos;  // another one may do as well
    if (value.is_number() && !names_a_reading) places.emplace_back(place);
  }
  return places;
}

/// Off by between a five hundredth and a half of itself (of 1 where it is smaller), which is above what a number may
/// be off by rounding: of `off` a thousandth of a tolerance. A whole number, which names a curve, by one.
inline void change(Json& number, bool is_tolerance, std::mt19937_64& generator) {
  const double sign = uniform(generator, -1, 1) > 0 ? 1 : -1;
  if (number.is_number_integer()) {
    number = number.get<long>() + static_cast<long>(sign);
    return;
  }
  const double value = number.get<double>();
  const double by = sign * std::pow(10, uniform(generator, std::log10(0.002), std::log10(0.5)));
  number = value + by * (is_tolerance ? value : std::max(std::abs(value), 1.0));
}

inline bool is_refused(const Json& certificate) {
  try {
    return !checked(certificate).refusal.empty();
  } catch (const std::exception&) {
    return true;
  }
}

/// One of its numbers changed at random; says which, for the report of a test.
inline std::string change_one(Json& certificate, std::mt19937_64& generator) {
  const std::vector<Json::json_pointer> places = numbers_of(certificate);
  const auto& place = places[std::uniform_int_distribution<std::size_t>(0, places.size() - 1)(generator)];
  const Json before = certificate[place];
  change(certificate[place], place.back() == "tolerance", generator);
  return certificate["part"].get<std::string>() + " " + place.to_string() + ": " + before.dump() + " to " +
         certificate[place].dump();
}

}  // namespace certificates
