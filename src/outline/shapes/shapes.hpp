#pragma once

#include <string>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"

namespace rollfix {

/// Cubes of lengths in this range and their reciprocals are normal numbers, so that curvatures are.
inline constexpr double kLeastLength = 1e-99;
inline constexpr double kMostLength = 1e99;

/// The most by which lengths within one shape may differ. An ellipse with half axes a and b turns by pi on a stretch
/// of b^2/a, and other shapes are alike: beyond this the stretch would be below 1e-12 of the perimeter, which is what
/// arc lengths are accurate to, and the turn as good as a cusp.
inline constexpr double kMostContrast = 1e6;

/// The values of one shape's parameters: given or default, each checked against what the shape's table allows.
class Parameters {
 public:
  /// Throws InputError on a name that the shape does not have, one given twice, or a value that is not allowed.
  Parameters(const GalleryShape& shape, const ParameterList& given);

  /// The value of one of the shape's parameters, given or default, as a number or as it is written.
  double number(const std::string& name) const;
  int whole(const std::string& name) const { return static_cast<int>(number(name)); }
  const std::string& text(const std::string& name) const;

  /// Throws InputError: these values do not go together (or not with the shape), for this reason.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  const GalleryShape& shape_;        // a row of the gallery's table
  std::vector<std::string> values_;  // in the order of shape_.parameters
};

}  // namespace rollfix

/// The gallery's shapes, each from its checked parameters.
namespace rollfix::shapes {

using Curves = std::vector<Curve>;

// round.cpp: ellipses, and what is drawn of lines and arcs or through random points
Curves circle(const Parameters& parameters);
Curves ellipse(const Parameters& parameters);
Curves superellipse(const Parameters& parameters);
Curves reuleaux(const Parameters& parameters);
Curves stadium(const Parameters& parameters);
Curves rounded_rectangle(const Parameters& parameters);
Curves polygon(const Parameters& parameters);
Curves spline(const Parameters& parameters);

// polar.cpp: in polar form, and the open ones
Curves limacon(const Parameters& parameters);
Curves cam(const Parameters& parameters);
Curves gear(const Parameters& parameters);
Curves log_spiral(const Parameters& parameters);
Curves exponential(const Parameters& parameters);

// naca.cpp
Curves naca(const Parameters& parameters);

}  // namespace rollfix::shapes
