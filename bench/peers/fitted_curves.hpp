#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace bench {

/// What CAD has: eqs. (8) and (9) say that two planar curves meet, A(s) = (phi_1(s), phi_2(s)) of finger a and B(t) of
/// finger b moved by the turns read. Each is fitted by so many cubics with the right values and slopes at their ends, a
/// library intersects them, and Newton's method on the equations themselves takes each pair to rounding. Two readings.
using Pairs = std::vector<rollfix::PerFinger<double>>;
Pairs locate_by_lib2geom(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings, std::size_t pieces);
/// No value where the program was built without them.
std::optional<Pairs> locate_by_sisl(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                                    std::size_t pieces);
std::optional<Pairs> locate_by_occt(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                                    std::size_t pieces);

/// A curve of them as Bezier control points, each piece's last the next one's first; over equal steps from lo to hi.
struct FittedCurve {
  double lo = 0;
  double hi = 0;
  std::vector<rollfix::Vec2> points;  // 3 * pieces + 1

  std::size_t pieces() const { return points.size() / 3; }
  double at(double piece) const { return lo + (hi - lo) * piece / static_cast<double>(pieces()); }
};
std::array<FittedCurve, 2> fitted_curves(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings,
                                         std::size_t pieces);

/// Pairs by Newton's method from where the curves meet; those that are no answers, or there already, are left out.
Pairs polished(const rollfix::Part& part, const std::vector<rollfix::Reading>& readings, const Pairs& rough);

}  // namespace bench
