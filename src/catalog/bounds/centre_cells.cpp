#include "centre_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

// Notation:
//   p(s), Theta(s)  the boundary, with arc length as its parameter, and the tangent's angle
//   h               length of a cell; q its middle place; m +- w the tangent's angles in it
//   c = p + r n     the finger's centre, n = (sin Theta, -cos Theta)
// Follows docs/identify.md, "Touches".
// Idea: no place of a cell is further than h / 2 from its middle, because p goes at unit speed. Normals that turn by at
// most w lie in the disc about cos w n(m) of radius sin w. Four cells have the disc around theirs.
namespace rollfix {
namespace {

// Places beside a cell's end may be on either side, and middles are rounded to single precision: this share of the
// perimeter.
constexpr double kPlaceSlack = 1e-6;
constexpr std::size_t kTogether = kFineCells / kCells;

CentreCell cell_of(const Vec2& place, double reach, double lo, double hi, double radius) {
  CentreCell cell;
  cell.angle = 0.5 * (lo + hi);
  cell.half_turn = 0.5 * (hi - lo);
  cell.middle = place;
  cell.radius = reach;
  if (radius == 0) return cell;
  const double w = std::min(cell.half_turn, 0.5 * std::numbers::pi);
  const bool is_all = cell.half_turn > w;
  cell.middle += radius * (is_all ? 0 : std::cos(w)) * Vec2(std::sin(cell.angle), -std::cos(cell.angle));
  cell.radius += radius * std::sin(w);
  return cell;
}

CentreCell around(const CentreCell* cells) {
  CentreCell all;
  double lo = cells[0].angle - cells[0].half_turn, hi = cells[0].angle + cells[0].half_turn;
  for (std::size_t k = 0; k < kTogether; ++k) {
    all.middle += cells[k].middle / static_cast<double>(kTogether);
    lo = std::min(lo, cells[k].angle - cells[k].half_turn);
    hi = std::max(hi, cells[k].angle + cells[k].half_turn);
  }
  for (std::size_t k = 0; k < kTogether; ++k) {
    all.radius = std::max(all.radius, (cells[k].middle - all.middle).norm() + cells[k].radius);
  }
  all.angle = 0.5 * (lo + hi);
  all.half_turn = 0.5 * (hi - lo);
  return all;
}

}  // namespace

CellPlaces places_of(const Part& part) {
  CellPlaces places{};
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const Vec2 middle = part.point((static_cast<double>(k) + 0.5) / kFineCells * part.perimeter());
    places.x[k] = static_cast<float>(middle.x());
    places.y[k] = static_cast<float>(middle.y());
  }
  return places;
}

CentreCells centre_cells(const Profile<kFineCells>& profile, const CellPlaces& places, double perimeter,
                         double radius) {
  CentreCells levels;
  levels[2].reserve(kFineCells);
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const Vec2 place(places.x[k], places.y[k]);
    const double reach = 0.5 * perimeter / kFineCells + kPlaceSlack * (perimeter + place.norm());
    levels[2].push_back(cell_of(place, reach, profile.least[k], profile.most[k], radius));
  }
  for (const std::size_t level : {2, 1}) {
    const std::vector<CentreCell>& fine = levels[level];
    for (std::size_t k = 0; k < fine.size(); k += kTogether) levels[level - 1].push_back(around(fine.data() + k));
  }
  return levels;
}

}  // namespace rollfix
