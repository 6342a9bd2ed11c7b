#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"

// The least and the largest Theta on equal cells of the boundary. Whatever lies in a cell lies between its bounds, so
// that nothing that fits is lost; see docs/identify.md.
namespace rollfix::catalog {

// Rounding in single precision: of sums of a few turns, radians, and of lengths, as a share, as they occur in bounds.
inline constexpr double kTurnRounding = 2e-5;
inline constexpr double kShareRounding = 1e-6;

/// The nearest float that is no larger, and no smaller.
inline float float_below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded <= value ? rounded : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
}
inline float float_above(double value) { return -float_below(-value); }

/// Cells of a profile: of the one that is looked at first, and of those that are looked at where it leaves something.
/// Four cells of one lie in a cell of the one before.
inline constexpr std::size_t kCoarseCells = 16;
inline constexpr std::size_t kCells = 64;
inline constexpr std::size_t kFineCells = 256;

/// The least and the largest Theta on each of N equal cells of [0, P], radians, unwrapped, rounded outwards.
template <std::size_t N>
struct Profile {
  std::array<float, N> least;  // no larger than any Theta on the cell
  std::array<float, N> most;   // no smaller
};

/// Of the finest cells; the others follow from these by `coarser`.
Profile<kFineCells> profile_of(const Part& part);

/// What is known with a quarter of the cells.
Profile<kCells> coarser(const Profile<kFineCells>& fine);
Profile<kCoarseCells> coarser(const Profile<kCells>& cells);

/// Little-endian floats: the least of all cells, then the most; then a checksum of that.
std::string bytes_of(const Profile<kCells>& profile);
/// Nothing where the bytes are of another length, or are not what was written.
std::optional<Profile<kCells>> profile_from(std::string_view bytes);

/// A byte for each bound: how far it lies within those of its cell of 64, in 255ths of their distance, rounded
/// outwards; then a checksum of that.
std::string fine_bytes_of(const Profile<kFineCells>& fine, const Profile<kCells>& cells);
std::optional<Profile<kFineCells>> fine_profile_from(std::string_view bytes, const Profile<kCells>& cells);

/// The middles of equal cells of a part's boundary, in its frame, in single precision.
template <std::size_t N>
struct Middles {
  std::array<float, N> x;
  std::array<float, N> y;
};
/// Of all three sizes of cells: 2.7 kB.
struct CellPlaces {
  Middles<kCoarseCells> coarse;
  Middles<kCells> cells;
  Middles<kFineCells> fine;
};
CellPlaces places_of(const Part& part);

/// Where the centre of a round finger is while it touches a cell, and how the tangent points there.
struct CentreCell {
  Vec2 middle = Vec2::Zero();  // of a disc that holds the centres
  double radius = 0;
  double angle = 0;  // of the tangent, radians: at most half_turn from this
  double half_turn = 0;
};

/// Of each of N cells, by the tangent's angles in it and its middle. `radius`: the finger's; 0: a point.
template <std::size_t N>
std::vector<CentreCell> centre_cells(const Profile<N>& profile, const Middles<N>& middles, double perimeter,
                                     double radius);
extern template std::vector<CentreCell> centre_cells(const Profile<kCoarseCells>&, const Middles<kCoarseCells>&, double,
                                                     double);
extern template std::vector<CentreCell> centre_cells(const Profile<kCells>&, const Middles<kCells>&, double, double);
extern template std::vector<CentreCell> centre_cells(const Profile<kFineCells>&, const Middles<kFineCells>&, double,
                                                     double);

}  // namespace rollfix::catalog
