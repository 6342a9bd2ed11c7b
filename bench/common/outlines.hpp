#pragma once

#include <string>
#include <vector>

#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace bench {

/// What is measured: the gallery at its defaults, and an outline as a user has it.
struct Family {
  std::string name;
  rollfix::Outline outline;
  bool is_gallery = true;
};
std::vector<Family> families();

/// A wing section through points, with a corner at the trailing edge.
rollfix::Outline wing_through_points(int count);

/// A smooth outline, the same shape through few points and through many.
rollfix::Outline egg_through_points(int count);

/// W is the time that this takes: Boost's adaptive quadrature at 1e-10, one call per smooth piece.
double perimeter_by_quadrature(const rollfix::Outline& outline);

/// Lines and arcs alone: next to nothing to integrate.
bool is_trivial(const rollfix::Part& part);

/// The part without the look for self-crossings: W doesn't look for them either.
inline rollfix::Part trusted_part(const rollfix::Outline& outline) {
  return rollfix::Part(outline, rollfix::PartOptions{true});
}

}  // namespace bench
