#pragma once

#include <cmath>

#include "rollfix/locate/locate.hpp"
#include "rollfix/part/period.hpp"

namespace bench {

/// Whether two pairs are one, up to this share of the perimeter.
inline bool same_pair(const rollfix::Part& part, const rollfix::PerFinger<double>& one,
                      const rollfix::PerFinger<double>& two, double share) {
  const auto near = [&](double a, double b) {
    const double distance = part.closed() ? rollfix::periodic_distance(a, b, part.perimeter()) : std::abs(a - b);
    return distance <= share * part.perimeter();
  };
  return near(one[0], two[0]) && near(one[1], two[1]);
}

}  // namespace bench
