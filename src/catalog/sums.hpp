#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rollfix {

/// A row of `parts`.
struct PartRow {
  std::int64_t id = 0;
  std::string_view name;
  std::int64_t source = 0;
  double perimeter = 0;
  double period_turn = 0;
  double most_curvature = 0;
  bool closed = false;
  bool reversed = false;
  bool measured = false;
  std::int64_t symmetry = 0;
  double count = 0;
  std::string_view profile;
};

/// A row of `shapes` without its fine cells.
struct ShapeRow {
  std::string_view outline;
  std::string_view numbers;
};

/// The checksum of all columns.
std::uint64_t sum_of(const PartRow& row);
/// The checksums of what belongs to a part hold only beside that part's own.
std::uint64_t sum_of(const ShapeRow& row, std::uint64_t part);
std::uint64_t sum_of_fine(std::string_view fine, std::uint64_t part);

/// Of the whole catalog: its parts' checksums are added to this one, so that none goes missing.
std::uint64_t sum_of_unit(const std::string& unit);

}  // namespace rollfix
