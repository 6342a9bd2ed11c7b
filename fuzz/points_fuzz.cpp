// Points files: whatever the bytes are, they give an outline or an InputError. The first byte chooses the options.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace {

/// More points only make it slower.
constexpr std::size_t kMostPoints = 2000;

void require(bool holds) {
  if (!holds) std::abort();
}

void require_finite(const std::vector<rollfix::Curve>& curves) {
  require(!curves.empty());
  for (const rollfix::Curve& curve : curves) {
    require(curve.front().allFinite() && curve.back().allFinite());
  }
}

double size_of(const std::vector<rollfix::Vec2>& points) {
  double size = 0;
  for (const rollfix::Vec2& point : points) size = std::max(size, (point - points.front()).norm());
  return size;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  rollfix::OutlineOptions options;
  options.open = (data[0] & 1) != 0;
  const bool smooth = (data[0] & 2) != 0;
  const double share = (data[0] & 4) != 0 ? 0.04 : 0.0005;
  if (smooth) options.smooth = 1;  // repeated points are allowed then
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    std::vector<std::string> notes;
    const std::vector<rollfix::Vec2> points = rollfix::parse_points(text, "fuzz.dat", options, &notes);
    if (points.size() > kMostPoints) return 0;
    if (smooth) {
      const double tolerance = share * size_of(points);
      const rollfix::Smoothing found = rollfix::smooth_spline(points, !options.open, tolerance);
      require_finite(found.curves);
      require(found.deviation >= 0 && found.deviation <= tolerance);
    } else {
      require_finite(rollfix::outline_through(points, "fuzz.dat", options, &notes).curves);
    }
  } catch (const rollfix::InputError&) {
  }
  return 0;
}
