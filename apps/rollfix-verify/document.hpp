#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "boundary.hpp"
#include "centre_tree.hpp"

// The outline and the places that a certificate states, and what those of touches and of holds state alike.
namespace rollfix_verify {

using Json = nlohmann::json;

// How far a stated number may be off the one that is computed here: lengths, as a share of the perimeter, ...
inline constexpr double kLengthSlack = 1e-11;
// ... and angles, radians; besides what the curvatures make of the length's rounding.
inline constexpr double kTurnSlack = 1e-12;
inline constexpr double kRounding = 2e-14;
// Points and tangents of placements, which stand in the plane.
inline constexpr double kPlaceSlack = 1e-9;
// A crossing is stated to this share of the perimeter, or to this angle over the slope of f.
inline constexpr double kRootLength = 1e-9;
inline constexpr double kRootTurn = 4e-12;
// The least tolerance: below it rounding decides.
inline constexpr double kLeastTolerance = 4e-12;

// Starts that are taken for one placement are off by no more than so many tolerances.
inline constexpr double kNear = 8;

/// Ends the check: the certificate is refused.
[[noreturn]] void refuse(const std::string& why);
/// Likewise, where a stated number is not the one that follows from the formulas: "`what`: stated 1.5, computed 1.25".
[[noreturn]] void refuse_number(const std::string& what, double stated, const Ball& computed);

/// What certificates of one finger and of two have in common: the outline, and places on it.
class Document {
 public:
  explicit Document(const Json& json);

  const Json& json() const { return json_; }
  const Boundary& boundary() const { return boundary_; }
  double period() const { return period_; }  // the perimeter
  double tolerance() const { return tolerance_; }

  /// The tolerance is one, and the outline is the one that is stated.
  void check() const;
  /// The outline alone.
  void check_outline() const;

  /// Of the question: refused where it is too large for its digits.
  Ball length(const Json& stated) const;
  static Ball turn(const Json& stated);

  /// All starts whose rolls by these lengths stay on an open outline; of a closed one a lap.
  Interval starts(const std::vector<Ball>& lengths) const;

  /// Of [curve, its parameter].
  Place place_at(const Json& stated) const;

  /// Whether that is as far along, but for whole laps; refused where it is not.
  bool is_as_far(const Ball& s, const Ball& stated) const;
  void require_as_far(const Ball& s, const Ball& stated, const std::string& what) const;

  /// A placement's kind: one that there is; a tangent is told unless the finger pivots.
  static std::string kind_of(const std::string& name, const Json& placement);

  /// Where a placement's roll by so much starts, by `at`: start, end, point and tangent have to be those that follow.
  /// `finger`: whose of them, where there are two.
  Place contact(const std::string& name, const Json& placement, const Ball& length,
                std::optional<std::size_t> finger = std::nullopt) const;

  /// How far the tangent turns at most over what a place may be off.
  Ball turn_beside(const Place& place) const;

 private:
  void require_at(const Point& point, const Json& stated, const std::string& what) const;

  const Json& json_;
  Boundary boundary_;
  double period_;
  double tolerance_;
};

/// How far a residual may be beyond its tolerance, as a share of it: a search takes what is on the edge.
inline constexpr double kEdge = 1e-9;
/// Larger angles are not looked at, radians.
inline constexpr double kMostAngle = 1e6;

/// Refused where it is not finite.
double number(const Json& stated);
Interval interval(const Json& stated);
std::vector<Interval> intervals(const Json& stated);

/// Of a closed outline arcs begin on the first lap and are no longer than one.
std::vector<Interval> arcs(const Json& stated, double period);
/// Where a finger is said to be able to touch; nothing: everywhere.
std::optional<Considered> considered(const Json& stated, double period);
/// Whether a place, at a corner with this tangent, is among them.
bool is_considered(const Boundary& boundary, const std::optional<Considered>& considered, const Place& place,
                   double tangent);

/// The tangent's angle at a place: at a corner the stated one, if the finger can pivot to it; else the boundary's own.
Ball direction_at(const Document& document, const CentreTree& tree, const Place& place, double stated,
                  const std::string& name);

/// A residual is within its tolerance, and as it is stated, in tolerances.
void require_off(const Ball& residual, double tolerance, double slack, double stated, const std::string& name);

// What a certificate of a hold is about: docs/certificates.md, "Holds".

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
