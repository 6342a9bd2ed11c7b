#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "cli.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/reading.hpp"

/// Small catalogs, and rolls on their parts.
namespace catalogs {

using namespace rollfix;

/// A catalog of gallery shapes, built in the current folder.
inline Catalog of(const std::vector<std::string>& shapes, const std::string& file = "parts.db") {
  std::vector<CatalogSource> sources;
  for (const std::string& shape : shapes) sources.push_back({"gallery:" + shape, shape});
  build_catalog(file, sources);
  return Catalog(file);
}

/// Smooth ones, with corners, of lines and arcs, symmetric, open; splines to make up the number.
inline std::vector<std::string> mixed_shapes(int splines) {
  std::vector<std::string> shapes = {"ellipse,a=2,b=1", "cam",        "limacon",          "polygon,n=6",
                                     "polygon,n=4",     "stadium",    "reuleaux",         "gear",
                                     "log-spiral",      "circle,r=1", "naca,digits=4415", "naca",
                                     "naca,digits=0012"};
  for (int k = 0; k < splines; ++k) shapes.push_back("spline,n=9,wobble=0.2,seed=" + std::to_string(k + 1));
  return shapes;
}

/// What a finger reads that rolls from s by these lengths.
inline std::vector<Reading> roll_on(const Part& part, double s, const std::vector<double>& lengths) {
  std::vector<Reading> readings;
  for (const double length : lengths) {
    readings.emplace_back(length, part.turning().angle(s + length) - part.turning().angle(s));
  }
  return readings;
}

/// Of two fingers on it.
inline std::vector<Reading> rolls_on(const Part& part, double s, double t,
                                     const std::vector<std::pair<double, double>>& lengths) {
  std::vector<Reading> readings;
  const TurningFunction& turning = part.turning();
  for (const auto& [a, b] : lengths) {
    readings.emplace_back(a, b, turning.angle(s + a) - turning.angle(s) - turning.angle(t + b) + turning.angle(t));
  }
  return readings;
}

inline std::vector<std::string> names_of(const Catalog& catalog, const Identified& found) {
  std::vector<std::string> names;
  for (const PartFound& part : found.parts) names.push_back(catalog.entry(part.weight.part).name);
  return names;
}

/// Every placement of every part, as text to the last bit.
inline std::string all_of(const Catalog& catalog, const Identified& found) {
  std::string text = found.verdict + "\n";
  for (const PartFound& part : found.parts) {
    text += catalog.entry(part.weight.part).name + " " + part.answer.verdict.text();
    for (const Placement& placement : part.answer.placements) text += " " + cli::exact(placement.start[0]);
    text += "\n";
  }
  return text;
}

}  // namespace catalogs
