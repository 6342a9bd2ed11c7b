#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "rollfix/part.hpp"

// The least and the largest Theta on equal cells of the boundary. Whatever lies in a cell lies between its bounds, so
// that nothing that fits is lost; see docs/identify.md.
namespace rollfix {

/// Cells of a profile: of the one that is looked at first, and of those that are looked at where it leaves something.
/// Four cells of one lie in a cell of the one before.
inline constexpr std::size_t kCoarseCells = 16;
inline constexpr std::size_t kCells = 64;
inline constexpr std::size_t kFineCells = 256;

/// The least and the largest Theta on each of N equal cells of [0, P], radians, unwrapped, rounded outwards.
template <std::size_t N>
struct Profile {
  std::array<float, N> least;
  std::array<float, N> most;
};

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

}  // namespace rollfix
