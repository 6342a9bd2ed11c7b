#pragma once

#include "rollfix/locate/march/path.hpp"
#include "rollfix/locate/march/preprocessing.hpp"
#include "rollfix/locate/march/samples.hpp"

namespace rollfix::march {

/// Throws Refusal where the outline or its density is outside what section 2 assumes:
///  * corner: the tangent jumps by more than kSmoothJoint where two curves meet
///  * line: the tangent turns nowhere by more than kFlatTurn along a curve
///  * arc: the curvature is constant along a curve (to kConstant of its size); for eq. (6) this and a line are one
///  * zero_density: any other density is zero along a curve (to kZero of its scale)
///  * curvature_jump: for eq. (6), the curvature jumps where two curves meet
void check_preconditions(const Path& path, const Preprocessed& preprocessed, const Samples& samples);

}  // namespace rollfix::march
