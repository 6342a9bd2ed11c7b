#include "fitted_curves.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rollfix/turning_function.hpp"
#include "same_pair.hpp"

namespace bench {

using namespace rollfix;

namespace {

constexpr double kVanishes = 1e-9;   // rad: residuals up to here are an answer
constexpr double kSamePlace = 1e-7;  // of the perimeter
constexpr int kNewtonSteps = 8;

FittedCurve fit(const Part& part, const std::vector<Reading>& readings, std::size_t finger, std::size_t pieces) {
  const TurningFunction& turning = part.turning();
  FittedCurve curve{0, part.perimeter(), {}};
  for (const Reading& reading : readings) {
    if (part.closed()) break;
    curve.lo = std::max(curve.lo, -reading.length[finger]);
    curve.hi = std::min(curve.hi, part.perimeter() - reading.length[finger]);
  }
  const double third = (curve.hi - curve.lo) / static_cast<double>(3 * pieces);
  for (std::size_t k = 0; k <= pieces; ++k) {
    const double s = curve.lo + 3 * third * static_cast<double>(k);
    const Turning start = turning.at(s);
    Vec2 place;
    Vec2 slope;
    for (int i = 0; i < 2; ++i) {
      const Reading& reading = readings[static_cast<std::size_t>(i)];
      const Turning end = turning.at(s + reading.length[finger]);
      place[i] = end.angle - start.angle + (finger == 1 ? reading.turn : 0);
      slope[i] = end.curvature - start.curvature;
    }
    if (k > 0) curve.points.push_back(place - third * slope);
    curve.points.push_back(place);
    if (k < pieces) curve.points.push_back(place + third * slope);
  }
  return curve;
}

}  // namespace

std::array<FittedCurve, 2> fitted_curves(const Part& part, const std::vector<Reading>& readings, std::size_t pieces) {
  return {fit(part, readings, 0, pieces), fit(part, readings, 1, pieces)};
}

Pairs polished(const Part& part, const std::vector<Reading>& readings, const Pairs& rough) {
  const TurningFunction& turning = part.turning();
  Pairs found;
  for (const PerFinger<double>& start : rough) {
    Eigen::Vector2d at(start[0], start[1]);
    double off = kVanishes;
    for (int step = 0; step <= kNewtonSteps; ++step) {
      const Turning s0 = turning.at(at[0]);
      const Turning t0 = turning.at(at[1]);
      Eigen::Vector2d residual;
      Eigen::Matrix2d slopes;
      for (int k = 0; k < 2; ++k) {
        const Reading& reading = readings[static_cast<std::size_t>(k)];
        const Turning s = turning.at(at[0] + reading.length[0]);
        const Turning t = turning.at(at[1] + reading.length[1]);
        residual[k] = (s.angle - s0.angle) - (t.angle - t0.angle) - reading.turn;
        slopes.row(k) << s.curvature - s0.curvature, t0.curvature - t.curvature;
      }
      off = residual.cwiseAbs().maxCoeff();
      if (!(off > 0) || step == kNewtonSteps) break;
      at -= slopes.partialPivLu().solve(residual);
    }
    if (!(off <= kVanishes)) continue;
    PerFinger<double> pair{at[0], at[1]};
    if (part.closed()) {
      for (double& place : pair) place = part.boundary().base(place);
    }
    const auto is_same = [&](const PerFinger<double>& other) { return same_pair(part, pair, other, kSamePlace); };
    if (std::none_of(found.begin(), found.end(), is_same)) found.push_back(pair);
  }
  return found;
}

}  // namespace bench
