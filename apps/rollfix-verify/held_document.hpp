#pragma once

#include <vector>

#include "document.hpp"
#include "held.hpp"

namespace rollfix_verify {

/// What a certificate of a hold states of fingers, wheels and instants, as seen face up: a part that lies face down is
/// looked at in the mirror x = -x.
struct HeldQuestion {
  explicit HeldQuestion(const Document& document);

  bool is_mirrored = false;
  std::vector<HeldFinger> fingers;
  std::vector<HeldWheel> wheels;
  std::size_t instants = 0;
  bool any_place = false;
  double size = 0;  // of the largest coordinate

  double mirrored(double value) const { return is_mirrored ? -value : value; }
  /// Refused: a tolerance that doubles decide, a place that is left out though the finger may touch there.
  void require_sound(const Document& document) const;

 private:
  void set_turn();
};

}  // namespace rollfix_verify
