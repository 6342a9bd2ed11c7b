// Whatever an outline through points and a roll on it are: every placement is finite and fits, or there is an
// InputError. The bytes are small numbers: two fingers?, closed?, the reading, the tolerance, and points.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"

namespace {

using namespace rollfix;

// Enough to prune, and little enough that thousands of problems are done in a minute.
constexpr std::size_t kBudget = 2000;
constexpr std::size_t kMostPoints = 24;
// Beyond the tolerance: what rounding makes of a residual, and how well two fingers' sets are outlined.
constexpr double kRounding = 1e-9;
constexpr double kOutline = 1.25;

/// Numbers of two bytes each, 0 where there are no more.
class Numbers {
 public:
  Numbers(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::size_t left() const { return size_ / 2; }
  int whole() {
    if (left() == 0) return 0;
    const int value = static_cast<std::int16_t>(data_[0] | (data_[1] << 8));
    data_ += 2;
    size_ -= 2;
    return value;
  }
  /// From -8 to 8, and now and then anything at all.
  double next() {
    const int value = whole();
    if (value % 1024 == 1023) return std::ldexp(static_cast<double>(whole()), whole() % 1100);
    return value / 4096.0;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const Search& search, const LocateOptions& options) {
  require((search.status == Status::complete) == search.unresolved.empty());
  for (const Placement& placement : search.placements) {
    const double most = (placement.start.size() == 2 ? kOutline : 1) * options.tolerance;
    require(search.status == Status::incomplete || placement.residual <= most + kRounding);
    for (const double s : placement.start) require(std::isfinite(s));
    for (const Interval& extent : placement.extent) require(extent.lo <= extent.hi);
  }
}

Reading next_reading(Numbers& numbers, bool two) {
  const double first = numbers.next();
  const double second = numbers.next();
  return two ? Reading(first, second, numbers.next()) : Reading(first, second);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Numbers numbers(data, size);
  try {
    const int kind = numbers.whole();
    const bool two = (kind & 1) != 0;
    const Reading reading = next_reading(numbers, two);
    LocateOptions options;
    options.budget = kBudget;
    options.tolerance = std::abs(numbers.next()) * 1e-3;
    if (two) options.facing = numbers.next();
    const bool closed = (kind & 2) == 0;
    std::vector<Vec2> points;
    while (numbers.left() >= 2 && points.size() < kMostPoints) {
      const double x = numbers.next();
      points.emplace_back(x, numbers.next());
    }
    const Part part(Outline{"fuzz", spline_through(points, closed), closed}, {true});
    check(locate(part, reading, options), options);
  } catch (const InputError&) {
    // what bad input should give
  }
  return 0;
}
