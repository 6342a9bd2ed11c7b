#pragma once

#include <optional>
#include <vector>

#include "centre_tree.hpp"
#include "document.hpp"

// What a certificate of a hold is about: docs/certificates.md, "Holds".
namespace rollfix_verify {

/// One finger with skin, and how far what it measured may be off.
struct HeldFinger {
  struct At {
    double travelled = 0;  // L: from the first contact, by arc length
    double tangent = 0;    // of the part in the world, radians, counted on from instant to instant
    double x = 0;          // the contact in the world
    double y = 0;
  };
  std::vector<At> at;      // at each instant
  double travel = 0;       // a: tolerance of the arc length
  double angle = 0;        // of the tangent, radians
  bool has_place = false;  // x and y were measured, ...
  double place = 0;        // ... to this
  double turn = 0;         // that the tangent may turn by before it tells something, at least `angle`
  Interval passed;         // from the first contact all the boundary in between was rolled over for certain
  std::optional<Considered> reach;

  /// Places where it can touch, corners at which some tangent is within reach among them.
  std::vector<Interval> within;
  /// Where it can't.
  std::vector<Interval> gaps;
};

/// A wheel without skin.
struct HeldWheel {
  struct At {
    double x = 0;  // of the pin
    double y = 0;
    double spin = 0;  // of the wheel, radians
  };
  std::vector<At> at;
  double radius = 0;
  double place = 0;            // tolerance of the pin, ...
  std::optional<double> spin;  // ... of the encoder, ...
  std::optional<double> line;  // ... and of the force through both contacts, radians
  std::optional<Considered> reach;
};

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
