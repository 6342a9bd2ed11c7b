#pragma once

namespace rollfix::belief {

inline double square(double x) { return x * x; }

}  // namespace rollfix::belief
