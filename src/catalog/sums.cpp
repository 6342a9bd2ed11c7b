#include "sums.hpp"

#include <initializer_list>

#include "files/byte_stream.hpp"

namespace rollfix {
namespace {

/// Numbers, then texts with their lengths before them, so that no byte can move from one to the next. In one go: cells
/// end with a checksum of their own, and the sum of bytes with their sum is the same whatever they are.
std::uint64_t sum_of(ByteWriter numbers, std::initializer_list<std::string_view> columns) {
  for (const std::string_view column : columns) numbers.whole(column.size());
  std::string bytes = numbers.bytes();
  for (const std::string_view column : columns) bytes.append(column);
  return checksum(bytes);
}

}  // namespace

std::uint64_t sum_of(const PartRow& row) {
  ByteWriter numbers;
  for (const std::int64_t whole : {row.id, row.source, row.symmetry, std::int64_t{row.closed},
                                   std::int64_t{row.reversed}, std::int64_t{row.measured}}) {
    numbers.whole(static_cast<std::uint64_t>(whole));
  }
  for (const double number : {row.perimeter, row.period_turn, row.most_curvature, row.count}) numbers.number(number);
  return sum_of(numbers, {row.name, row.profile});
}

std::uint64_t sum_of(const ShapeRow& row, std::uint64_t part) {
  ByteWriter numbers;
  numbers.whole(part);
  return sum_of(numbers, {row.outline, row.numbers});
}

std::uint64_t sum_of_fine(std::string_view fine, std::uint64_t part) {
  ByteWriter numbers;
  numbers.whole(part);
  return sum_of(numbers, {fine});
}

std::uint64_t sum_of_unit(const std::string& unit) { return checksum("unit " + unit); }

}  // namespace rollfix
