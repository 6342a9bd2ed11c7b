#include "cells.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

// Notation:
//   Theta(s)        the tangent's angle; kappa = Theta' the curvature
//   f(s)            Theta(s + L) - Theta(s) - theta of a reading with length L and turn theta: Row::f
//   f'(s)           kappa(s + L) - kappa(s)
//   row, cell       a start with its roll; all s from one row to the next
// Follows eqs. (4) and (5) of the paper (Jia, IROS 2001); docs/certificates.md, "How it is checked", step 3.
// Idea: what is claimed of a cell is proved by bounds on f or f' there, or of both halves. What remains of it are the
// halves that no reading excludes: near, or a corner as narrow as one place; next to each other they are one piece.
namespace rollfix_verify {
namespace {

// |f| on a stretch, radians.
constexpr double kFlat = 4e-12;
// On what is excluded f misses the tolerance by at least this share of what it does at the nearer end.
constexpr double kShare = 0.9;
constexpr int kMostDepth = 90;
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
  // Monotone: f is between its values at the two rows. Else f is within slope * width of its value at the first row.
  range.parts = {range.slope != 0 ? ends : from.f + up_to(to.start.s - from.start.s) * slope + extra};
  return range;
}

/// No joint in between: f' is a Taylor polynomial in the arc length, which each start and its end have in common.
Range smooth_range(const Boundary& boundary, const Row& from, const Row& to) {
  // kappa over all starts, and over all ends, as series in the arc length ahead, which both contacts have in common.
  const Series starts = boundary.curvature_ahead(from.start.curve, hull(from.start.u, to.start.u));
  const Series ends = boundary.curvature_ahead(from.end.curve, hull(from.end.u, to.end.u));
  const Ball slope = value(with_remainder(from.from_end - from.from_start, ends - starts, kOrder - 1),
                           up_to(to.start.s - from.start.s));
  // The plain difference of both curvatures over the cell: sometimes its sign is certain where the polynomial's is not.
  const Ball plain = ends[0] - starts[0];
  Range range = by_slope(from, to, sign_of(slope) == 0 && sign_of(plain) != 0 ? plain : slope, 0.0);
  range.blur = (kRounding * boundary.perimeter() * (abs(starts[0]) + abs(ends[0]))).upper();
  return range;
}

double size_of(const Row& row) { return abs(row.f).lower(); }

/// Bounds f from row to row. REQUIRES `to` ahead of `from`.
/// Three cases: no joint, smooth joints, corners. Not known over many joints: then the cell is halved.
Range range_between(const Boundary& boundary, const Ball& turn, const Row& from, const Row& to) {
  const long joints = (to.start.curve - from.start.curve) + (to.end.curve - from.end.curve);
  if (joints > kMostJoints) return {};
  if (joints == 0) return smooth_range(boundary, from, to);
  const std::vector<Segment> starts = segments(boundary, from.start, to.start);
  const std::vector<Segment> ends = segments(boundary, from.end, to.end);
  // Smooth joints: the curvatures on both sides bound the slope, and jumps up to kSmooth are added.
  if (!spans_corner(boundary, from, to)) {
    return by_slope(from, to, curvatures(boundary, ends) - curvatures(boundary, starts),
                    jumps(boundary, ends) - jumps(boundary, starts));
  }
  // Corners: the sets of Theta at both contacts, each of the one with each of the other.
  Range range;
  range.known = true;
  range.corner = true;
  for (const Ball& end : angles(boundary, ends)) {
    for (const Ball& start : angles(boundary, starts)) range.parts.push_back(end - start - turn);
  }
  return range;
}

/// What is in a set and in one of others.
std::vector<Interval> common(const std::vector<Interval>& some, const std::vector<Interval>& others) {
  std::vector<Interval> result;
  for (const Interval& one : some) {
    for (const Interval& other : others) {
      const Interval both{std::max(one.lo, other.lo), std::min(one.hi, other.hi)};
      if (both.lo <= both.hi) result.push_back(both);
    }
  }
  return result;
}

/// The rolls from a start between two others.
/// Places off joints are tried in turn. Throws std::domain_error if none of them will do.
Rows rows_between(const Boundary& boundary, const Readings& readings, const Place& from, const Place& to) {
  const double period = boundary.perimeter().middle();
  const double lo = from.s.middle();
  const double hi = to.s.middle();
  const bool is_fine = hi - lo < kFine * period;
  for (const double share : kSplits) {
    const double s = lo + share * (hi - lo);
    if (!(Ball(s).is_above(from.s) && to.s.is_above(s))) continue;
    if (is_fine && is_at_corner(boundary, s, contacts(readings), kClear * period)) continue;
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

}  // namespace

/// Whether |f| is certainly above the bound at every start.
bool Range::misses(double bound) const {
  return std::all_of(parts.begin(), parts.end(),
                     [&](const Ball& part) { return part.is_above(bound) || part.is_below(-bound); });
}

/// Whether |f| is certainly no more than the bound, and what rounded places change: of a monotone f both ends decide.
bool Range::is_below(const Row& from, const Row& to, double bound) const {
  const double most = bound + blur;
  if (slope != 0 && !corner) return abs(from.f).upper() <= most && abs(to.f).upper() <= most;
  return std::all_of(parts.begin(), parts.end(),
                     [&](const Ball& part) { return part.upper() <= most && part.lower() >= -most; });
}

bool spans_corner(const Boundary& boundary, const Row& from, const Row& to) {
  return has_corner(boundary, from.start, to.start) || has_corner(boundary, from.end, to.end);
}

/// What a cell is claimed to be.
struct OneReading::Claim {
  enum Kind { apart, crossing, flat } kind = apart;
  double bound = 0;  // apart: |f| is above it; flat: below it
  int slope = 0;     // of a crossing
};

/// f = Theta(s + L) - Theta(s) - theta at one start; nothing where the end can't be told from a joint.
std::optional<Row> OneReading::row_at(const Place& start) const {
  const std::optional<Place> end = boundary_.after(start.s + length_);
  if (!end) return std::nullopt;
  return Row{start, *end, end->angle - start.angle - turn_, boundary_.curvature_ahead(start.curve, start.u),
             boundary_.curvature_ahead(end->curve, end->u)};
}

std::optional<Row> OneReading::row_at(const Ball& start) const {
  const std::optional<Place> place = boundary_.after(start);
  return place ? row_at(*place) : std::nullopt;
}

Range OneReading::range(const Row& from, const Row& to) const { return range_between(boundary_, turn_, from, to); }

bool OneReading::changes_sign(const Row& from, const Row& to) const {
  return size_of(from) > tolerance_ && size_of(to) > tolerance_ && sign_of(from.f) != sign_of(to.f);
}

/// What is to be proved on each part of a cell, from f at its two rows.
OneReading::Claim OneReading::claim_of(const std::string& kind, const Row& from, const Row& to) const {
  // Certain lower bounds of |f| at both rows.
  const double nearer = std::min(size_of(from), size_of(to));
  if (kind == "apart") {
    if (!(nearer > tolerance_)) refuse("f is within the tolerance at an end of it");
    // All of the cell must be outside by kShare of what the nearer row is outside by.
    return {Claim::apart, tolerance_ + kShare * (nearer - tolerance_), 0};
  }
  if (kind == "crossing") {
    if (!changes_sign(from, to)) refuse("f does not change its sign from end to end of it");
    // Opposite signs at the ends and one sign of slope: exactly one root. The slope's sign is that of f at the last
    // row.
    return {Claim::crossing, tolerance_, sign_of(to.f)};
  }
  if (kind == "stretch") return {Claim::flat, kFlat, 0};
  refuse("its kind '" + kind + "' is not known");
}

/// What the claim says of a part of its cell, as far as this range tells.
bool OneReading::holds(const Claim& claim, const Range& range, const Row& from, const Row& to) const {
  if (!range.known) return false;
  // As narrow as one place, with a corner in it: halving can't tell more.
  const bool is_one_corner = range.corner && (to.start.s - from.start.s).is_below(kSamePlace * period_);
  switch (claim.kind) {
    case Claim::crossing:
      // On each part the same sign of slope: f is monotone on the whole cell.
      return range.slope == claim.slope;
    case Claim::flat:
      // Where both ends of the roll come to a corner at once all of it is a jump there and back.
      if (is_one_corner && !range.misses(claim.bound)) return true;
      return range.is_below(from, to, claim.bound);
    case Claim::apart:
      // At corners only the tolerance itself is asked for: f may pass the nearer row's value on its way through the
      // pivot.
      if (range.misses(range.corner ? tolerance_ : claim.bound)) return true;
      if (is_one_corner) refuse("it fits at a corner near s = " + std::to_string(from.start.s.middle()));
      return false;
  }
  return false;
}

void OneReading::prove(const std::string& kind, const Row& from, const Row& to) const {
  const Claim claim = claim_of(kind, from, to);
  by_halves(boundary_, {this}, {from}, {to},
            [&](const Rows& lo, const Rows& hi) { return holds(claim, range(lo[0], hi[0]), lo[0], hi[0]); });
}

std::vector<Ball> contacts(const Readings& readings) {
  std::vector<Ball> result = {0.0};
  for (const OneReading* reading : readings) result.push_back(reading->length());
  return result;
}

/// At most `kMostDepth` deep; what is spent on the way is counted where places are expanded.
void by_halves(const Boundary& boundary, const Readings& readings, const Rows& from, const Rows& to,
               const Settles& settles, int depth) {
  if (settles(from, to)) return;
  const Place& start = from[0].start;
  if (depth == kMostDepth) refuse("it could not be proved near s = " + std::to_string(start.s.middle()));
  const Rows middle = rows_between(boundary, readings, start, to[0].start);
  by_halves(boundary, readings, from, middle, settles, depth + 1);
  by_halves(boundary, readings, middle, to, settles, depth + 1);
}

/// Angles are taken from that at the first start on, so that doubles hold them.
bool fit_together(const Boundary& boundary, const Readings& readings, const std::vector<Segment>& around, double most) {
  const Ball base = around[0].from.angle;
  // The sets of start tangents for which this contact fits: Theta there less the reading's turn, +- the slack.
  const auto tangents = [&](const Segment& contact, const Ball& turn, double slack) {  // at the start
    std::vector<Interval> result;
    for (const Ball& set : angles(boundary, segments(boundary, contact.from, contact.to))) {
      const Ball tangent = set - base - turn;
      result.push_back({(tangent - slack).lower(), (tangent + slack).upper()});
    }
    return result;
  };
  // What the first contact's own corner allows; then each reading leaves its share of it.
  std::vector<Interval> left = tangents(around[0], 0.0, 0);
  for (std::size_t k = 0; k < readings.size(); ++k) {
    left = common(left, tangents(around[k + 1], readings[k]->turn(), most));
  }
  return !left.empty();
}

/// Pieces are counted along the stretches. On a closed outline the first and the last one are the same if both are
/// open.
std::size_t Remains::pieces(bool is_round) const {
  return is_round && pieces_ > 1 && starts_open_ && is_open_ ? pieces_ - 1 : pieces_;
}

bool Remains::are_corners() const {
  return std::all_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.is_corner; });
}

bool Remains::hold(double s, double reach) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) { return part.starts.holds({s, s}, reach); });
}

Remains::Standing Remains::standing(const Rows& from, const Rows& to) const {
  const double tolerance = document_.tolerance();
  bool is_known = true;
  bool is_near = true;
  bool is_corner = false;
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    const Range range = readings_[k]->range(from[k], to[k]);
    is_known = is_known && range.known;
    if (!range.known) continue;
    // One reading that excludes the part is enough.
    if (range.misses(tolerance)) return Standing::excluded;
    is_near = is_near && range.is_below(from[k], to[k], near_ * tolerance);
    is_corner = is_corner || range.corner;
  }
  if (!is_known) return Standing::unknown;
  if (is_near) return Standing::near;
  const bool is_narrow = (to[0].start.s - from[0].start.s).is_below(kSamePlace * document_.period());
  // Neither excluded nor near, and not yet a single place at a corner: halved again.
  if (!is_corner || !is_narrow) return Standing::unknown;
  // At one corner every contact pivots on its own, but the start's tangent is one for all readings.
  std::vector<Segment> around = {{from[0].start, to[0].start}};
  for (std::size_t k = 0; k < readings_.size(); ++k) around.push_back({from[k].end, to[k].end});
  return fit_together(document_.boundary(), readings_, around, tolerance) ? Standing::corner : Standing::excluded;
}

void Remains::add(const Rows& from, const Rows& to) {
  by_halves(document_.boundary(), readings_, from, to, [&](const Rows& lo, const Rows& hi) { return settles(lo, hi); });
}

/// Records where a part stands; `by_halves` asks for them by rising s, so that touching parts are neighbours.
bool Remains::settles(const Rows& from, const Rows& to) {
  const Standing here = standing(from, to);
  if (here == Standing::unknown) return false;
  const bool remains = here != Standing::excluded;
  if (is_first_) starts_open_ = remains;
  is_first_ = false;
  if (remains) {
    if (!is_open_) ++pieces_;
    parts_.push_back({{from[0].start.s.lower(), to[0].start.s.upper()}, here == Standing::corner});
  }
  is_open_ = remains;
  return true;
}

}  // namespace rollfix_verify
