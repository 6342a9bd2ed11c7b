#pragma once

#include <string>

#include "rollfix/belief.hpp"

namespace rollfix::app {

/// "1.0020 +- 0.0004 times what was measured: they are 0.2 % longer": a scale that the rows tell. `more`, `less`: what
/// they are where it is above 1, and below.
std::string scale_text(double scale, double sd, const char* more, const char* less);

/// Lines "lengths ...", "turns ...", "bias ...": what the rows tell of the scales of lengths and turns and of a
/// gyroscope's bias, as far as the noise leaves them open.
std::string scale_lines(const Fit& fit, std::size_t fingers);

}  // namespace rollfix::app
