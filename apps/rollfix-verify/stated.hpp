#pragma once

#include <optional>
#include <string>
#include <vector>

#include "centre_tree.hpp"
#include "document.hpp"

// What certificates of touches and of holds state alike.
namespace rollfix_verify {

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
void require_off(const Ball& residual, double tolerance, double slack, const Ball& stated, const std::string& name);

}  // namespace rollfix_verify
