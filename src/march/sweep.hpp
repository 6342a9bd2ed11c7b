#pragma once

#include "march/alternation.hpp"
#include "march/preprocessing.hpp"

namespace rollfix::march {

/// Section 2.2: slides a segment of length L once along the boundary, mode by mode, and notes each place where its
/// integral equals C. A convex boundary is one mode, and the sweep is then section 2.1.
/// Segments, doubts and counts; starts as arc lengths in [0, P], ends not reduced to one loop.
Result sweep(const Path& path, const Preprocessed& preprocessed, const Problem& problem, const Options& options);

}  // namespace rollfix::march
