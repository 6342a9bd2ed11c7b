#pragma once

#include "rollfix/locate.hpp"
#include "rollfix/turning_function.hpp"

namespace bench {

/// Whether two pairs are one, up to this share of the perimeter.
inline bool same_pair(const rollfix::Part& part, const rollfix::PerFinger<double>& one,
                      const rollfix::PerFinger<double>& two, double share) {
  const auto near = [&](double a, double b) { return part.boundary().distance(a, b) <= share * part.perimeter(); };
  return near(one[0], two[0]) && near(one[1], two[1]);
}

}  // namespace bench
