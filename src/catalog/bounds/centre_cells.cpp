#include "centre_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

// Notation:
//   p(s), Theta(s)  the boundary and the tangent's angle: p' = e(Theta) = (cos Theta, sin Theta)
//   h               length of a cell: `step_`; m +- w the angles in it: `angle_`, `half_turn_`
//   c = p + r n     the finger's centre, n = (sin Theta, -cos Theta)
//   (z, rho)        a disc: `middle`, `radius`
// Follows docs/identify.md, "Touches".
// Idea: a cell's share of p is a mean of unit vectors e(Theta), times its length: it lies in the disc that holds that
// arc of the unit circle, (cos w e(m), sin w). A stretch that ends within the cell is shorter: it lies in the disc that
// holds 0 as well. Discs of successive cells add up; of a closed part both ways round are known, and the smaller
// counts.
namespace rollfix {
namespace {

// A closed outline's ends meet within 1e-9 of its size, and places are rounded: this share of the perimeter, next to
// nothing beside a cell.
constexpr double kPlaceSlack = 1e-7;
// Angles are rounded, radians.
constexpr double kAngleGrain = 1e-12;

Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Holds all e(m + x) with |x| <= w, and so every mean of them.
Disc disc_of_arc(double m, double w) {
  if (w >= 0.5 * std::numbers::pi) return {Vec2::Zero(), 1};
  return {std::cos(w) * unit(m), std::sin(w)};
}

/// Holds the same times any share from 0 to 1.
Disc disc_of_sector(double m, double w) {
  const double corner = std::sqrt(std::max(0.0, 1.25 - std::cos(std::min(w, std::numbers::pi))));
  if (corner >= 1) return {Vec2::Zero(), 1};
  return {0.5 * unit(m), std::max(0.5, corner)};
}

Disc operator*(double factor, const Disc& disc) { return {factor * disc.middle, std::abs(factor) * disc.radius}; }
Disc operator+(const Disc& one, const Disc& other) { return {one.middle + other.middle, one.radius + other.radius}; }

/// What discs that were added up from a common start to two places say of the vector between them.
Disc difference(const Disc& from, const Disc& to) { return {to.middle - from.middle, to.radius - from.radius}; }

}  // namespace

CentreCells::CentreCells(const float* least, const float* most, std::size_t count, double perimeter, bool closed,
                         double radius)
    : step_(perimeter / static_cast<double>(count)), slack_(kPlaceSlack * perimeter), closed_(closed) {
  up_to_.push_back({});
  for (std::size_t k = 0; k < count; ++k) {
    const double m = 0.5 * (static_cast<double>(least[k]) + most[k]);
    const double w = 0.5 * (static_cast<double>(most[k]) - least[k]) + kAngleGrain;
    angle_.push_back(m);
    half_turn_.push_back(w);
    part_of_.push_back(step_ * disc_of_sector(m, w));
    up_to_.push_back(up_to_.back() + step_ * disc_of_arc(m, w));
    offset_.push_back(radius * disc_of_arc(m - 0.5 * std::numbers::pi, w));
  }
}

/// Along the boundary to a cell that comes later, or again after a lap.
Disc CentreCells::forwards(std::size_t from, std::size_t to) const {
  const Disc ends = part_of_[from] + part_of_[to];
  if (from < to) return ends + difference(up_to_[from + 1], up_to_[to]);
  return ends + difference(up_to_[from + 1], up_to_.back()) + up_to_[to];
}

Disc CentreCells::between(std::size_t from, std::size_t to) const {
  Disc contact{Vec2::Zero(), step_};
  if (from != to) {
    const bool is_later = from < to;
    contact = is_later ? forwards(from, to) : -1 * forwards(to, from);
    if (closed_) {
      const Disc other_way = is_later ? -1 * forwards(to, from) : forwards(from, to);
      if (other_way.radius < contact.radius) contact = other_way;
    }
  }
  contact.radius += slack_;
  return contact + offset_[to] + -1 * offset_[from];
}

}  // namespace rollfix
