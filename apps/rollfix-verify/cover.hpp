#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "convex.hpp"

namespace rollfix_verify {

/// One of the boxes that a cover is made of, and what is claimed of it.
struct Leaf {
  enum Kind { apart, placement, unproved } kind = unproved;
  Box box;
  double bound = 0;        // apart: some equation is off by more, radians
  std::size_t number = 0;  // placement: which one
};

/// Reads a cover of a box: `s` or `t` halves it across finger a's or b's first contacts and the two halves follow; else
/// it is a leaf: one character of 0-9A-Za-f for the power of 1/2 that bounds it, [number] of a placement, or `?`.
/// Throws std::domain_error where it is none.
void read_cover(const std::string& text, const Box& whole, const std::function<void(const Leaf&)>& use);

}  // namespace rollfix_verify
