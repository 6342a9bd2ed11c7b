#pragma once

#include <string>
#include <vector>

#include "rollfix/contact/log.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::app {

/// The search's tolerance and why it is that.
struct Tolerance {
  double value = 0;  // radians
  std::string source;
};

/// The larger of 1e-9 and what the rounding of a reading can make of the total curvature: a length that is off by h
/// changes it by at most h times the largest curvature, but for stretches shorter than h, which count as corners.
Tolerance tolerance_from_rounding(const Part& part, const std::vector<Rounding>& roundings);

/// What noise makes of it.
Tolerance tolerance_from_noise(double value);

/// --tolerance as typed: an angle of at least 0. Throws InputError.
Tolerance tolerance_from_option(const std::string& text);

}  // namespace rollfix::app
