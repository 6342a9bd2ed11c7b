#pragma once

#include <string>

#include "rollfix/error.hpp"

namespace rollfix::march {

/// What the paper's marching algorithms are not made for.
enum class Reason {
  corner,           // the tangent jumps where two curves meet
  line,             // the curvature is zero on a whole curve
  arc,              // the curvature is constant on a whole curve
  zero_density,     // another density is zero on a whole curve
  degenerate_zero,  // the density is zero with a zero slope: not a simple inflection, not a simple vertex
  curvature_jump,   // the curvature jumps where two curves meet, so that eq. (6) is not an integral of kappa'
  continuum,        // the integral over length L equals C on an interval of starts
  unresolved        // the automatic step can not become small enough: a near cusp
};

/// The march does not answer, and says why and where. The production search (rollfix::locate) handles all of these.
class Refusal : public InputError {
 public:
  Refusal(Reason reason, double where, const std::string& message)
      : InputError(message), reason_(reason), where_(where) {}

  Reason reason() const { return reason_; }
  double where() const { return where_; }  // arc length of the place, or of the start of the curve, in question

 private:
  Reason reason_;
  double where_;
};

}  // namespace rollfix::march
