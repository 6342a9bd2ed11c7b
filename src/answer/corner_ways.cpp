#include "corner_ways.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

// Notation:
//   L_0 = 0, L_1, L_2, ...   one finger's lengths: at its first contact and at each reading
//   L_k - L_j                what it has rolled in between: a way from corner to corner, but for digits
// Idea: where two contacts of one finger are at corners, digits must not say that one of them has left its own.
namespace rollfix {
namespace {

/// The corners at which a finger can pivot, in order.
std::vector<double> pivots_of(const Part& part) {
  std::vector<double> places;
  for (const Corner& corner : part.corners()) {
    if (!corner.is_concave()) places.push_back(corner.s);
  }
  return places;
}

/// How far a length is from the nearest way between two corners: what is missing of it.
double to_way_between(const std::vector<double>& corners, const Boundary& boundary, double length) {
  double least = std::numeric_limits<double>::infinity();
  for (const double from : corners) {
    const double end = boundary.on_first_lap(from + length);
    const auto next = std::lower_bound(corners.begin(), corners.end(), end);
    const double above = next != corners.end() ? *next : corners.front();
    const double below = next != corners.begin() ? *(next - 1) : corners.back();
    for (const double corner : {below, above}) {
      const double off = boundary.offset(end, corner);
      if (std::abs(off) < std::abs(least)) least = off;
    }
  }
  return least;
}

}  // namespace

void put_on_corners(const Part& part, double within, std::vector<Reading>& readings) {
  const std::vector<double> corners = pivots_of(part);
  if (corners.empty() || readings.empty() || !(within > 0)) return;
  for (std::size_t finger = 0; finger < readings.front().fingers(); ++finger) {
    std::vector<double> lengths{0};
    for (Reading& reading : readings) {
      double& length = reading.length[finger];
      double least = std::numeric_limits<double>::infinity();
      for (const double before : lengths) {
        const double off = to_way_between(corners, part.boundary(), length - before);
        if (std::abs(off) < std::abs(least)) least = off;
      }
      if (std::abs(least) <= within) length += least;
      lengths.push_back(length);
    }
  }
}

}  // namespace rollfix
