#include "bounds.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "files/part_record.hpp"
#include "part/turning_range.hpp"

// Notation:
//   Theta, p        the tangent's angle and the boundary by arc length s; P the perimeter, cell k is
//                   [k P / N, (k + 1) P / N]
//   least, most     of Theta on each cell, in single precision, rounded outwards
//   step            a 255th of the range of a cell of 64: a bound of a cell of 256 is a number of these, rounded
//                   outwards
//   h               length of a cell; q its middle place; m +- w the tangent's angles in it
//   c = p + r n     the finger's centre, n = (sin Theta, -cos Theta)
// Follows docs/identify.md, "How parts are ruled out", the table of the file's columns, and "Touches".
// Idea: covers, not samples. Joints beside a cell's end are in both cells (`kBeyondCell`), so that rounding of places
// loses nothing, and four cells of a finer profile make one of the coarser. No place of a cell is further than h / 2
// from its middle, because p goes at unit speed. Normals that turn by at most w lie in the disc about cos w n(m) of
// radius sin w.
namespace rollfix::catalog {
namespace {

// Joints may be on either side of a cell's end by rounding: cells are looked at farther by this share of their length.
constexpr double kBeyondCell = 1e-6;
// Steps between the bounds of a cell of 64.
constexpr int kSteps = 255;

/// Four cells of one profile make one of the next: least of the least, most of the most.
template <std::size_t N>
Profile<N / 4> quarter_of(const Profile<N>& fine) {
  Profile<N / 4> coarse;
  for (std::size_t k = 0; k < N / 4; ++k) {
    const float* const least = fine.least.data() + 4 * k;
    const float* const most = fine.most.data() + 4 * k;
    coarse.least[k] = *std::min_element(least, least + 4);
    coarse.most[k] = *std::max_element(most, most + 4);
  }
  return coarse;
}

/// The bytes with their checksum behind them.
std::string with_checksum(const std::string& bytes) {
  ByteWriter writer;
  writer.whole(checksum(bytes));
  return bytes + writer.bytes();
}

/// Without its checksum; nothing where the length or that is not as expected.
std::optional<std::string_view> checked(std::string_view bytes, std::size_t length) {
  if (bytes.size() != length + sizeof(std::uint64_t)) return std::nullopt;
  const std::string_view content = bytes.substr(0, length);
  // Not what was written.
  if (ByteReader(bytes.substr(length)).whole() != checksum(content)) return std::nullopt;
  return content;
}

/// So many steps into the range of a cell of 64, from its lower end and from its upper one.
float up_from(float least, float most, int steps) {
  return least + static_cast<float>(steps) * ((most - least) / static_cast<float>(kSteps));
}
float down_from(float least, float most, int steps) {
  return most - static_cast<float>(steps) * ((most - least) / static_cast<float>(kSteps));
}

/// The most steps of which `is_outside` says that they don't go too far.
/// As a byte, because there are kSteps + 1 of them. `share`: about how far that is, of the range; rounding is made good
/// by going back. A range of 0 takes no step.
template <typename IsOutside>
char most_steps(double share, const IsOutside& is_outside) {
  // 0 / 0 where the cell's range is 0.
  int steps = std::isfinite(share) ? static_cast<int>(std::clamp(kSteps * share, 0.0, 1.0 * kSteps)) : 0;
  while (steps > 0 && !is_outside(steps)) --steps;
  return static_cast<char>(static_cast<unsigned char>(steps));
}

}  // namespace

Profile<kFineCells> profile_of(const Part& part) {
  Profile<kFineCells> profile;
  const double step = part.perimeter() / kFineCells;
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const auto at = static_cast<double>(k);
    // Beyond both ends by kBeyondCell: covers may only be larger.
    Interval arc{step * (at - kBeyondCell), step * (at + 1 + kBeyondCell)};
    if (!part.closed()) arc = {std::max(arc.lo, 0.0), std::min(arc.hi, part.perimeter())};
    const Interval angles = angles_over(part.turning(), arc);
    // Rounded outwards: a float no larger than the least angle, and one no smaller than the largest.
    profile.least[k] = float_below(angles.lo);
    profile.most[k] = float_above(angles.hi);
  }
  return profile;
}

Profile<kCells> coarser(const Profile<kFineCells>& fine) { return quarter_of(fine); }
Profile<kCoarseCells> coarser(const Profile<kCells>& cells) { return quarter_of(cells); }

std::string bytes_of(const Profile<kCells>& profile) {
  ByteWriter bytes;
  for (const auto* bounds : {&profile.least, &profile.most}) {
    // Two floats in eight bytes, the first one low: little-endian whatever the machine is.
    for (std::size_t k = 0; k < kCells; k += 2) {
      const auto first = std::bit_cast<std::uint32_t>((*bounds)[k]);
      const auto second = std::bit_cast<std::uint32_t>((*bounds)[k + 1]);
      bytes.whole(first | static_cast<std::uint64_t>(second) << 32U);
    }
  }
  return with_checksum(bytes.bytes());
}

std::optional<Profile<kCells>> profile_from(std::string_view bytes) {
  const std::optional<std::string_view> content = checked(bytes, 2 * kCells * sizeof(float));
  if (!content) return std::nullopt;
  Profile<kCells> profile;
  ByteReader reader(*content);
  for (auto* bounds : {&profile.least, &profile.most}) {
    for (std::size_t k = 0; k < kCells; k += 2) {
      const std::uint64_t both = reader.whole();
      (*bounds)[k] = std::bit_cast<float>(static_cast<std::uint32_t>(both));
      (*bounds)[k + 1] = std::bit_cast<float>(static_cast<std::uint32_t>(both >> 32U));
    }
  }
  return profile;
}

std::string fine_bytes_of(const Profile<kFineCells>& fine, const Profile<kCells>& cells) {
  std::string bytes(2 * kFineCells, '\0');
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const float least = cells.least[k / 4];
    const float most = cells.most[k / 4];
    // In double precision: only the number of steps depends on it, and most_steps() checks that.
    const double range = static_cast<double>(most) - least;
    // Steps up from the larger cell's least, steps down from its most: both stay outside of the fine cell's bounds.
    bytes[k] = most_steps((fine.least[k] - least) / range,
                          [&](int steps) { return up_from(least, most, steps) <= fine.least[k]; });
    bytes[kFineCells + k] = most_steps((most - fine.most[k]) / range,
                                       [&](int steps) { return down_from(least, most, steps) >= fine.most[k]; });
  }
  return with_checksum(bytes);
}

std::optional<Profile<kFineCells>> fine_profile_from(std::string_view bytes, const Profile<kCells>& cells) {
  const std::optional<std::string_view> content = checked(bytes, 2 * kFineCells);
  if (!content) return std::nullopt;
  Profile<kFineCells> fine;
  const auto steps = [&](std::size_t k) { return static_cast<int>(static_cast<unsigned char>((*content)[k])); };
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    const float least = cells.least[cell];
    const float most = cells.most[cell];
    for (std::size_t k = 4 * cell; k < 4 * cell + 4; ++k) {
      fine.least[k] = up_from(least, most, steps(k));
      fine.most[k] = down_from(least, most, steps(kFineCells + k));
    }
  }
  return fine;
}

namespace {

// Places beside a cell's end may be on either side, and middles are rounded to single precision: this share of the
// perimeter.
constexpr double kPlaceSlack = 1e-6;

/// The disc of a round finger's centres at a cell whose places are within `reach` of `place` and whose tangents are in
/// [lo, hi]. Normals that turn by up to w from n(m) lie within sin w of cos w n(m); where they turn by more than a
/// quarter, within 1 of 0. `radius` 0: the places themselves.
CentreCell cell_of(const Vec2& place, double reach, double lo, double hi, double radius) {
  CentreCell cell;
  cell.angle = 0.5 * (lo + hi);
  cell.half_turn = 0.5 * (hi - lo);
  cell.middle = place;
  cell.radius = reach;
  if (radius == 0) return cell;
  // Beyond a quarter turn the disc is about the places themselves, with the whole radius.
  const double w = std::min(cell.half_turn, 0.5 * std::numbers::pi);
  const bool is_all = cell.half_turn > w;
  cell.middle += radius * (is_all ? 0 : std::cos(w)) * Vec2(std::sin(cell.angle), -std::cos(cell.angle));
  cell.radius += radius * std::sin(w);
  return cell;
}

/// Points of the boundary at the middles of N equal cells.
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
    // p goes at unit speed: nothing in the cell is farther from its middle than half its length.
    const double reach = 0.5 * perimeter / static_cast<double>(N) + kPlaceSlack * (perimeter + place.norm());
    cells.push_back(cell_of(place, reach, profile.least[k], profile.most[k], radius));
  }
  return cells;
}

template std::vector<CentreCell> centre_cells(const Profile<kCoarseCells>&, const Middles<kCoarseCells>&, double,
                                              double);
template std::vector<CentreCell> centre_cells(const Profile<kCells>&, const Middles<kCells>&, double, double);
template std::vector<CentreCell> centre_cells(const Profile<kFineCells>&, const Middles<kFineCells>&, double, double);

}  // namespace rollfix::catalog
