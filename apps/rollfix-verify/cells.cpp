#include "cells.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rollfix_verify {

/// What f is on all the starts from one row to the next.
struct Range {
  bool known = false;
  int slope = 0;  // +-1: f rises, falls all the way
  bool corner = false;
  std::vector<Ball> parts;  // f is in one of these at each start; several where it jumps at a concave corner
  double blur = 0;          // what f changes by as places are rounded
};

namespace {

// |f| on a stretch, radians.
constexpr double kFlat = 4e-12;
// On what is excluded f misses the tolerance by at least this share of what it does at the nearer end.
constexpr double kShare = 0.9;
// Within a cell |f| may be larger than at its ends by this factor.
constexpr double kBeyond = 1.01;
constexpr int kMostDepth = 80;
constexpr std::size_t kMostParts = 400000;  // of a cell, before it is given up
// Where a cell is halved; the next ones where that is at a joint.
constexpr double kSplits[] = {0.4990234375, 0.5166015625, 0.4697265625};

// Rows on both sides of a place are looked for at these shares of the perimeter; the next ones where they are at a
// joint.
constexpr double kBeside[] = {0.25 * kSamePlace, 0.5 * kSamePlace, 0.75 * kSamePlace, kSamePlace};

// Stretches over more joints than this are halved first.
constexpr long kMostJoints = 6;

/// f between rows where it has the slopes given, one sign of them making it monotone.
Range by_slope(const Row& from, const Row& to, const Ball& slope, const Ball& extra) {
  Range range;
  range.known = slope.is_finite();
  range.slope = sign_of(slope);
  const Ball ends = hull(from.f, to.f) + extra;
  range.parts = {range.slope != 0 ? ends : from.f + up_to(to.start.s - from.start.s) * slope + extra};
  return range;
}

/// No joint in between: by Taylor polynomials of both ends' angles in the arc length, which each start and its end have
/// in common.
Range smooth_range(const Boundary& boundary, const Row& from, const Row& to) {
  const Taylor& start = from.start_ahead;
  const Taylor& end = from.end_ahead;
  const Taylor all_starts = taylor_along(boundary, {from.start, to.start});
  const Taylor all_ends = taylor_along(boundary, {from.end, to.end});
  const Ball ahead = up_to(to.start.s - from.start.s);
  const auto last = static_cast<std::size_t>(kOrder) - 1;
  Ball slope = static_cast<double>(kOrder) * (all_ends[last] - all_starts[last]);
  for (std::size_t k = last; k-- > 0;) slope = slope * ahead + static_cast<double>(k + 1) * (end[k] - start[k]);
  const Ball plain = all_ends[0] - all_starts[0];
  Range range = by_slope(from, to, sign_of(slope) == 0 && sign_of(plain) != 0 ? plain : slope, 0.0);
  range.blur = (kRounding * boundary.perimeter() * (abs(all_starts[0]) + abs(all_ends[0]))).upper();
  return range;
}

double size_of(const Row& row) { return abs(row.f).lower(); }

bool misses(const Range& range, double bound) {
  return std::all_of(range.parts.begin(), range.parts.end(),
                     [&](const Ball& part) { return part.is_above(bound) || part.is_below(-bound); });
}

bool meets(const Range& range, double bound) {
  return std::any_of(range.parts.begin(), range.parts.end(),
                     [&](const Ball& part) { return part.lower() <= bound && part.upper() >= -bound; });
}

/// Bounds f from row to row. REQUIRES `to` ahead of `from`.
Range range_between(const Boundary& boundary, const Ball& turn, const Row& from, const Row& to) {
  const long joints = (to.start.curve - from.start.curve) + (to.end.curve - from.end.curve);
  if (joints > kMostJoints) return {};
  if (joints == 0) return smooth_range(boundary, from, to);
  const std::vector<Segment> starts = segments(boundary, from.start, to.start);
  const std::vector<Segment> ends = segments(boundary, from.end, to.end);
  if (!spans_corner(boundary, from, to)) {
    return by_slope(from, to, curvatures(boundary, ends) - curvatures(boundary, starts),
                    jumps(boundary, ends) - jumps(boundary, starts));
  }
  Range range;
  range.known = true;
  range.corner = true;
  for (const Ball& end : angles(boundary, ends)) {
    for (const Ball& start : angles(boundary, starts)) range.parts.push_back(end - start - turn);
  }
  return range;
}

}  // namespace

bool spans_corner(const Boundary& boundary, const Row& from, const Row& to) {
  return !is_smooth(boundary, from.start, to.start) || !is_smooth(boundary, from.end, to.end);
}

/// What a cell is claimed to be.
struct OneReading::Claim {
  enum Kind { apart, crossing, within, corner } kind = apart;
  double bound = 0;  // apart, corner: |f| is above it (but at the corner); within: below it
  int slope = 0;     // of a crossing
};

std::optional<Row> OneReading::row_at(const Place& start) const {
  const std::optional<Place> end = boundary_.after(start.s + length_);
  if (!end) return std::nullopt;
  return Row{start, *end, end->angle - start.angle - turn_, boundary_.taylor(start.curve, start.u),
             boundary_.taylor(end->curve, end->u)};
}

std::optional<Row> OneReading::row_beside(const Place& start, double distance) const {
  const std::optional<Place> place = boundary_.after(start.s + distance);
  return place ? row_at(*place) : std::nullopt;
}

bool OneReading::changes_sign(const Row& from, const Row& to) const {
  return size_of(from) > tolerance_ && size_of(to) > tolerance_ && sign_of(from.f) != sign_of(to.f);
}

OneReading::Claim OneReading::claim_of(const std::string& kind, const Row& from, const Row& to) const {
  const double nearer = std::min(size_of(from), size_of(to));
  if (kind == "apart") {
    if (!(nearer > tolerance_)) refuse("f is within the tolerance at an end of it");
    return {Claim::apart, tolerance_ + kShare * (nearer - tolerance_), 0};
  }
  if (kind == "crossing" || kind == "corner") {
    if (!changes_sign(from, to)) refuse("f does not change its sign from end to end of it");
    return {kind == "corner" ? Claim::corner : Claim::crossing, tolerance_, sign_of(to.f)};
  }
  if (kind == "stretch") return {Claim::within, kFlat, 0};
  if (kind == "within") {
    const double farther = std::max({abs(from.f).upper(), abs(to.f).upper(), tolerance_});
    return {Claim::within, kBeyond * farther, 0};
  }
  refuse("its kind '" + kind + "' is not known");
}

bool OneReading::is_narrow(const Row& from, const Row& to) const {
  return (to.start.s - from.start.s).is_below(kSamePlace * period_);
}

/// What the claim says of a part of its cell, as far as this range tells.
bool OneReading::holds(const Claim& claim, const Range& range, const Row& from, const Row& to) const {
  if (!range.known) return false;
  const bool at_corner = range.corner && is_narrow(from, to);
  switch (claim.kind) {
    case Claim::crossing:
      return range.slope == claim.slope;
    case Claim::within: {
      if (at_corner && meets(range, claim.bound)) return true;
      const double most = claim.bound + range.blur;
      if (range.slope != 0) return abs(from.f).upper() <= most && abs(to.f).upper() <= most;
      return std::all_of(range.parts.begin(), range.parts.end(),
                         [&](const Ball& part) { return part.upper() <= most && part.lower() >= -most; });
    }
    case Claim::corner:
      if (at_corner && meets(range, 0)) return true;
      return misses(range, claim.bound);
    case Claim::apart:
      return misses(range, range.corner ? tolerance_ : claim.bound);
  }
  return false;
}

void OneReading::prove(const std::string& kind, const Row& from, const Row& to) const {
  std::size_t parts = 0;
  prove(claim_of(kind, from, to), from, to, 0, parts);
}

void OneReading::prove(const Claim& claim, const Row& from, const Row& to, int depth, std::size_t& parts) const {
  if (holds(claim, range_between(boundary_, turn_, from, to), from, to)) return;
  if (depth == kMostDepth || ++parts > kMostParts) {
    refuse("it could not be proved near s = " + std::to_string(from.start.s.middle()));
  }
  const Row middle = between(from, to);
  prove(claim, from, middle, depth + 1, parts);
  prove(claim, middle, to, depth + 1, parts);
}

Row OneReading::between(const Row& from, const Row& to) const {
  const double lo = from.start.s.middle();
  const double hi = to.start.s.middle();
  for (const double share : kSplits) {
    const double s = lo + share * (hi - lo);
    if (!(Ball(s).is_above(from.start.s) && to.start.s.is_above(s))) continue;
    const std::optional<Place> start = boundary_.after(s);
    const std::optional<Row> row = start ? row_at(*start) : std::nullopt;
    if (row) return *row;
  }
  refuse("it can't be halved near s = " + std::to_string(lo));
}

bool OneReading::fits(const Place& start) const {
  const double most = tolerance_ * (1 + kPlaceSlack) + kTurnSlack;
  for (const double share : kBeside) {
    const std::optional<Row> lo = row_beside(start, -share * period_);
    const std::optional<Row> hi = row_beside(start, share * period_);
    if (lo && hi) return meets(range_between(boundary_, turn_, *lo, *hi), most);
  }
  return !boundary_.closed();  // at its end
}

}  // namespace rollfix_verify
