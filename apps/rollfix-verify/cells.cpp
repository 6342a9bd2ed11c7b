#include "cells.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rollfix_verify {

namespace {

// |f| on a stretch, radians.
constexpr double kFlat = 4e-12;
// On what is excluded f misses the tolerance by at least this share of what it does at the nearer end.
constexpr double kShare = 0.9;
constexpr int kMostDepth = 80;
// Where a cell is halved; the next ones where that is at a joint.
constexpr double kSplits[] = {0.4990234375, 0.5166015625, 0.4697265625, 0.27, 0.73, 0.13, 0.87};
// What is shorter than this share of the perimeter is halved only where no contact is within the other one of a corner:
// contacts that come to corners at once to rounding are not to be told apart.
constexpr double kFine = 1e-9;

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

/// Both ends of an interval.
struct Limits {
  double lo;
  double hi;
};

/// What is in a set and in one of others.
std::vector<Limits> common(const std::vector<Limits>& some, const std::vector<Limits>& others) {
  std::vector<Limits> result;
  for (const Limits& one : some) {
    for (const Limits& other : others) {
      const Limits both{std::max(one.lo, other.lo), std::min(one.hi, other.hi)};
      if (both.lo <= both.hi) result.push_back(both);
    }
  }
  return result;
}

}  // namespace

bool misses(const Range& range, double bound) {
  return std::all_of(range.parts.begin(), range.parts.end(),
                     [&](const Ball& part) { return part.is_above(bound) || part.is_below(-bound); });
}

bool is_below(const Range& range, const Row& from, const Row& to, double bound) {
  const double most = bound + range.blur;
  if (range.slope != 0 && !range.corner) return abs(from.f).upper() <= most && abs(to.f).upper() <= most;
  return std::all_of(range.parts.begin(), range.parts.end(),
                     [&](const Ball& part) { return part.upper() <= most && part.lower() >= -most; });
}

bool spans_corner(const Boundary& boundary, const Row& from, const Row& to) {
  return !is_smooth(boundary, from.start, to.start) || !is_smooth(boundary, from.end, to.end);
}

/// What a cell is claimed to be.
struct OneReading::Claim {
  enum Kind { apart, crossing, flat } kind = apart;
  double bound = 0;  // apart: |f| is above it; flat: below it
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

Range OneReading::range(const Row& from, const Row& to) const { return range_between(boundary_, turn_, from, to); }

bool OneReading::changes_sign(const Row& from, const Row& to) const {
  return size_of(from) > tolerance_ && size_of(to) > tolerance_ && sign_of(from.f) != sign_of(to.f);
}

OneReading::Claim OneReading::claim_of(const std::string& kind, const Row& from, const Row& to) const {
  const double nearer = std::min(size_of(from), size_of(to));
  if (kind == "apart") {
    if (!(nearer > tolerance_)) refuse("f is within the tolerance at an end of it");
    return {Claim::apart, tolerance_ + kShare * (nearer - tolerance_), 0};
  }
  if (kind == "crossing") {
    if (!changes_sign(from, to)) refuse("f does not change its sign from end to end of it");
    return {Claim::crossing, tolerance_, sign_of(to.f)};
  }
  if (kind == "stretch") return {Claim::flat, kFlat, 0};
  refuse("its kind '" + kind + "' is not known");
}

/// What the claim says of a part of its cell, as far as this range tells.
bool OneReading::holds(const Claim& claim, const Range& range, const Row& from, const Row& to) const {
  if (!range.known) return false;
  switch (claim.kind) {
    case Claim::crossing:
      return range.slope == claim.slope;
    case Claim::flat: {
      // Where both ends of the roll come to a corner at once all of it is a jump there and back.
      const bool is_narrow = (to.start.s - from.start.s).is_below(kSamePlace * period_);
      if (range.corner && is_narrow && !misses(range, claim.bound)) return true;
      return is_below(range, from, to, claim.bound);
    }
    case Claim::apart:
      if (misses(range, range.corner ? tolerance_ : claim.bound)) return true;
      if (range.corner && (to.start.s - from.start.s).is_below(kSamePlace * period_)) {
        refuse("it fits at a corner near s = " + std::to_string(from.start.s.middle()));
      }
      return false;
  }
  return false;
}

void OneReading::prove(const std::string& kind, const Row& from, const Row& to) const {
  prove(claim_of(kind, from, to), from, to, 0);
}

void OneReading::prove(const Claim& claim, const Row& from, const Row& to, int depth) const {
  if (holds(claim, range(from, to), from, to)) return;
  if (depth == kMostDepth) refuse("it could not be proved near s = " + std::to_string(from.start.s.middle()));
  const Row middle = rows_between(boundary_, {this}, from.start, to.start).front();
  prove(claim, from, middle, depth + 1);
  prove(claim, middle, to, depth + 1);
}

Rows rows_between(const Boundary& boundary, const std::vector<const OneReading*>& readings, const Place& from,
                  const Place& to) {
  const double lo = from.s.middle();
  const double hi = to.s.middle();
  const bool is_fine = hi - lo < kFine * boundary.perimeter().middle();
  const auto is_clear = [&](double s) {
    const double reach = kClear * boundary.perimeter().middle();
    return !is_at_corner(boundary, s, reach) &&
           std::none_of(readings.begin(), readings.end(), [&](const OneReading* reading) {
             return is_at_corner(boundary, s + reading->length(), reach);
           });
  };
  for (const double share : kSplits) {
    const double s = lo + share * (hi - lo);
    if (!(Ball(s).is_above(from.s) && to.s.is_above(s)) || (is_fine && !is_clear(s))) continue;
    const std::optional<Place> start = boundary.after(s);
    if (!start) continue;
    Rows rows;
    for (const OneReading* reading : readings) {
      const std::optional<Row> row = reading->row_at(*start);
      if (row) rows.push_back(*row);
    }
    if (rows.size() == readings.size()) return rows;
  }
  refuse("it can't be halved near s = " + std::to_string(lo));
}

/// Angles are taken from that at the first start on, so that doubles hold them.
bool fit_together(const Boundary& boundary, const std::vector<const OneReading*>& readings, const Segment& starts,
                  const std::vector<Segment>& ends, double most) {
  const Ball base = starts.from.angle;
  std::vector<Limits> tangents;
  for (const Ball& set : angles(boundary, segments(boundary, starts.from, starts.to))) {
    tangents.push_back({(set - base).lower(), (set - base).upper()});
  }
  for (std::size_t k = 0; k < readings.size(); ++k) {
    std::vector<Limits> allowed;
    for (const Ball& set : angles(boundary, segments(boundary, ends[k].from, ends[k].to))) {
      const Ball tangent = set - base - readings[k]->turn();
      allowed.push_back({(tangent - most).lower(), (tangent + most).upper()});
    }
    tangents = common(tangents, allowed);
  }
  return !tangents.empty();
}

}  // namespace rollfix_verify
