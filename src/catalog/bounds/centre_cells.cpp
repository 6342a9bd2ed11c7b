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
// most w lie in the disc about cos w n(m) of radius sin w.
namespace rollfix {
namespace {

// Places beside a cell's end may be on either side, and middles are rounded to single precision: this share of the
// perimeter.
constexpr double kPlaceSlack = 1e-6;

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

template <std::size_t N>
Middles<N> middles_of(const Part& part) {
  Middles<N> middles;
  for (std::size_t k = 0; k < N; ++k) {
    const Vec2 middle = part.point((static_cast<double>(k) + 0.5) / static_cast<double>(N) * part.perimeter());
    middles.x[k] = static_cast<float>(middle.x());
    middles.y[k] = static_cast<float>(middle.y());
  }
  return middles;
}

}  // namespace

CellPlaces places_of(const Part& part) {
  return {middles_of<kCoarseCells>(part), middles_of<kCells>(part), middles_of<kFineCells>(part)};
}

template <std::size_t N>
std::vector<CentreCell> centre_cells(const Profile<N>& profile, const Middles<N>& middles, double perimeter,
                                     double radius) {
  std::vector<CentreCell> cells;
  cells.reserve(N);
  for (std::size_t k = 0; k < N; ++k) {
    const Vec2 place(middles.x[k], middles.y[k]);
    const double reach = 0.5 * perimeter / static_cast<double>(N) + kPlaceSlack * (perimeter + place.norm());
    cells.push_back(cell_of(place, reach, profile.least[k], profile.most[k], radius));
  }
  return cells;
}

template std::vector<CentreCell> centre_cells(const Profile<kCoarseCells>&, const Middles<kCoarseCells>&, double,
                                              double);
template std::vector<CentreCell> centre_cells(const Profile<kCells>&, const Middles<kCells>&, double, double);
template std::vector<CentreCell> centre_cells(const Profile<kFineCells>&, const Middles<kFineCells>&, double, double);

}  // namespace rollfix
