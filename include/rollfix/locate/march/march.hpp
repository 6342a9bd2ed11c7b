#pragma once

#include <memory>
#include <vector>

#include "rollfix/locate/march/density.hpp"
#include "rollfix/locate/march/refusal.hpp"
#include "rollfix/locate/march/result.hpp"
#include "rollfix/locate/reading.hpp"
#include "rollfix/outline/outline.hpp"

/// The paper's one-finger algorithms as the paper has them (section 2, eq. (6), section 5), by numerical integration
/// along the parametric curve at step h: the reference that the production search is compared with. Use rollfix::locate
/// for anything else. docs/march.md derives the algorithm and shows its counted steps and its two holes.
namespace rollfix::march {

/// An outline prepared for any number of questions about one density: the paper's one-time overhead for a part shape.
/// Immutable; copies share their data; safe to use from any number of threads.
class March {
 public:
  /// Throws Refusal for an outline that section 2 excludes, InputError for options out of range or no curves.
  March(const Outline& outline, const Density& density, const Options& options = {});

  /// Every segment of signed length L over which the density's integral equals C, from s to s + L. On a closed outline
  /// L may have any size. On an open one |L| <= P, and only segments that lie on it count.
  /// Throws Refusal where a continuum of segments fits; InputError for numbers that are not finite and lengths that do
  /// not fit on an open outline.
  Result segments(double length, double integral) const;

  /// What preprocessing found: inflections, vertices, or sign changes of f, in order.
  std::vector<Breakpoint> breakpoints() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// Section 2: all segments with length L and total curvature theta.
Result locate(const Outline& outline, const Reading& reading, const Options& options = {});

/// Eq. (6): all stationary points of phi(s) = Phi(s, s + L), that is kappa(s + L) = kappa(s).
Result stationary_points(const Outline& outline, double length, const Options& options = {});

/// Section 5: all segments of length L over which the integral of f (per unit of arc length) equals C.
Result segments_with_integral(const Outline& outline, const DensityFunction& f, double length, double integral,
                              const Options& options = {});

}  // namespace rollfix::march
