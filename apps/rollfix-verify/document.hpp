#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "boundary.hpp"

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

  /// Of the question: refused where it is too large for its digits.
  Ball length(const Json& stated) const;
  static Ball turn(const Json& stated);

  /// It has one of the names that there are.
  static void check_kind(const std::string& name, const std::string& kind);

  /// Of [curve, its parameter].
  Place place_at(const Json& stated) const;

  /// Whether that is as far along, but for whole laps.
  bool is_as_far(const Ball& s, const Ball& stated) const;

  /// One finger's numbers of a placement: the start and the end of its roll by so much, the point, and unless a pivot
  /// leaves it open the tangent.
  struct Stated {
    Json start;
    Json end;
    Json point;
    std::optional<Json> tangent;
  };
  void check_contact(const std::string& name, const Place& start, const Ball& length, const Stated& stated) const;

 private:
  /// How far the tangent turns at most over what a place may be off.
  Ball turn_beside(const Place& place) const;

  bool is_at(const Point& point, const Json& stated) const;

  const Json& json_;
  Boundary boundary_;
  double period_;
  double tolerance_;
};

}  // namespace rollfix_verify
