#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "rollfix/error.hpp"

namespace rollfix {

/// "{path}: has the unknown ending '.step', expected {known}", and what gallery shape may have been meant.
std::string unknown_ending(const std::string& path, const std::string& known);

/// Points of an outline, or curves of a drawing. A part takes some 600 bytes for each.
inline constexpr std::size_t kMostPieces = 10'000'000;

/// Throws InputError beyond that many. `where` begins the message: the file, and what of it.
// The limit is one of memory: beyond it the part alone would take 6 GB.
inline void require_few_pieces(std::size_t count, const std::string& where) {
  if (count <= kMostPieces) return;
  throw InputError(
      fmt::format("{}: expected no more than {} points or curves, found more: thin it out", where, kMostPieces));
}

}  // namespace rollfix
