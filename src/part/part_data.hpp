#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/part.hpp"
#include "turning_builder.hpp"
#include "turning_range.hpp"

namespace rollfix {

/// All that a part holds, once it is computed.
struct Part::Data {
  Outline outline;                  // as stored: material on its left if closed
  TurningFunction turning;          // Theta(s), with its spirals
  Parametrization parametrization;  // from s back to the curves' parameters
  std::vector<Corner> corners;      // by rising s
  std::vector<double> inflections;  // s in [0, P), rising
  std::vector<double> vertices;     // the same
  TurningTree tree;                 // over the turning function; is not saved
};

/// Where the curvature changes sign. On a straight stretch between bends of opposite sign: its middle.
std::vector<double> find_inflections(const TurningFunction& turning);

/// Where the curvature, itself continuous, turns from rising to falling or back.
std::vector<double> find_vertices(const TurningFunction& turning, const std::vector<Corner>& corners);

/// Two places on the boundary that share a point of the plane.
struct Crossing {
  double first = 0;  // arc lengths
  double second = 0;
  Vec2 point;              // of the crossing, or near it
  bool is_certain = true;  // false: stretches lie side by side, too close to tell them apart with a bounded effort
};

/// A place where the part's boundary crosses or touches itself, if there is one. Exhaustive: stretches are passed
/// over only when they turn too little to meet themselves, or when boxes around them are apart.
std::optional<Crossing> find_crossing(const Part& part);

/// What a finger touches at a place.
struct Touched {
  Vec2 point;
  double tangent = 0;  // its direction just after the place, at the end of an open boundary before it
};

/// For saving a part and making it again, and for what takes one look at what it holds.
struct PartAccess {
  using Data = Part::Data;

  static const Data& data(const Part& part) { return *part.data_; }
  /// Point and tangent at base, 0 <= base <= P: both from one panel, which may be this.
  static Touched contact(const Part& part, double base, std::size_t likely_panel);
  /// The point at base, which lies on this panel; beyond the panel's curve by rounding: the curve's end.
  static Vec2 point(const Part& part, std::size_t panel_index, double base);
  /// A part of data that were complete before, such as those of a saved one; the tree is made anew.
  static Part part(Data data) {
    data.tree = TurningTree(data.turning);
    return Part(std::make_shared<const Data>(std::move(data)));
  }
};

/// Throws InputError for a length below what arc lengths on the part are accurate to. `what` was expected, such as "a
/// disk with a radius"; `cure` ends the message.
void require_not_lost(const Part& part, double length, const std::string& what, const std::string& cure);

}  // namespace rollfix
