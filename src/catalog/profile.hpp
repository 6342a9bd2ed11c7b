#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/part/part.hpp"
#include "rollfix/per_finger.hpp"

// Bounds that throw out most parts without looking at them: on Theta over equal cells of the boundary. Whatever lies in
// a cell lies between its bounds, so that nothing that fits is lost; see docs/identify.md.
namespace rollfix {

/// Cells of a profile, as it is stored; and of the coarse one that is looked at first.
inline constexpr std::size_t kCells = 64;
inline constexpr std::size_t kCoarseCells = 16;

/// The least and the largest Theta on each of N equal cells of [0, P], radians, unwrapped, rounded outwards.
template <std::size_t N>
struct Profile {
  std::array<float, N> least;
  std::array<float, N> most;
};

Profile<kCells> profile_of(const Part& part);
Profile<kCoarseCells> coarse_of(const Profile<kCells>& fine);

/// Little-endian floats: the least of all cells, then the most. `bytes` of another length: nothing.
std::string bytes_of(const Profile<kCells>& profile);
std::optional<Profile<kCells>> profile_from(std::string_view bytes);

/// What bounds need to know of a part besides.
struct Course {
  float perimeter = 0;
  float period_turn = 0;
  float most_curvature = 0;
  bool closed = true;
};

/// A reading, and how far it may be off.
struct Clue {
  PerFinger<double> length;
  double turn = 0;
  double length_slack = 0;             // of each length
  double turn_slack = 0;               // radians
  double turn_slack_by_curvature = 0;  // so much more, times the part's largest curvature
  double turn_sd = 0;                  // besides, an error that only this reading has: may_start adds up its squares
};

/// All readings of a roll together; none: nothing is known, and every part may be it.
struct Clues {
  std::vector<Clue> clues;
  std::optional<double> facing{};  // of two fingers, as LocateOptions has it
  double facing_slack = 0;
  double facing_slack_by_curvature = 0;
  std::size_t fingers = 1;
  double shared_sd = 0;  // besides, an error of the tangent at the start that all readings share
  double most_cost = 0;  // the squares of both, in standard deviations, may come to so much together
};

/// The cells in which the roll can have started, bit i for cell i. None is left out in which all the readings fit
/// within their slack, with one tangent at the start. Of two fingers: in which finger a can have.
std::uint64_t cells_left(const Profile<kCoarseCells>& profile, const Course& course, const Clues& clues);
std::uint64_t cells_left(const Profile<kCells>& profile, const Course& course, const Clues& clues);

/// Whether one finger's roll can have started anywhere in these cells: they are halved, with bounds from the part
/// itself, until nothing is left or halves are not worth looking at any more.
bool may_start(const Part& part, const Clues& clues, std::uint64_t cells);

}  // namespace rollfix
