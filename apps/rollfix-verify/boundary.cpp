#include "boundary.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "check.hpp"

// Notation:
//   s               arc length; u: a curve's parameter; Theta: the tangent's angle, from that at s = 0
//   piece           a stretch of a curve with its middle; x = u - middle
//   l(x), a(x)      `length`, `angle`: s = s_base + l(x), Theta = angle_base + a(x) on a piece
//   joint           where a curve ends and the next begins: `jump`; a segment is what lies between two of them
// Follows docs/certificates.md, "How it is checked", step 1; `after` is step 2.
// Idea: l' = ds/du and a' = d(Theta)/du are the formula's Taylor series of degree kOrder - 1. The last coefficient is
// that of all places of the piece, so that both polynomials hold the exact ones (Taylor's theorem). Between two places
// a stretch is taken curve by curve: the curvatures of each segment, and what the joints between turn by.
namespace rollfix_verify {
namespace {

// What a piece's polynomials leave out, of its length and in radians: far below what a certificate states.
constexpr double kPieceError = 1e-16;
constexpr int kMostHalvings = 50;
// A piece's bounds hold this share of its width beyond its ends: a ball around a place may reach over them.
constexpr double kMargin = 1.0 / 64;
// Of a curve's point: the curvature's derivative takes three of them.
constexpr slong kBendTerms = 4;
constexpr slong kTurnTerms = 3;  // the angle's takes two
constexpr double kFewTermsWork = 0.25;
constexpr double kPieceWork = 40;  // what one keeps of memory
constexpr int kNewtonSteps = 8;
constexpr double kNewtonGoal = 1e-15;
// A ball around a parameter is larger than it need be by this factor, for the rounding of its own size.
constexpr double kOutward = 1.001;
constexpr double kLeastReach = 1e-300;

/// Whether s is certainly nearer than `reach` to a corner, on its lap or a neighbouring one.
bool is_at_corner(const Boundary& boundary, const Ball& s, double reach) {
  const long count = boundary.curves();
  const double period = boundary.perimeter().middle();
  const long first = boundary.closed() ? count * static_cast<long>(std::floor(s.middle() / period)) - 1 : 0;
  const long joints = boundary.closed() ? count + 2 : count - 1;
  for (long curve = first; curve < first + joints; ++curve) {
    if (boundary.is_corner(curve) && abs(boundary.front(curve + 1).s - s).is_below(reach)) return true;
  }
  return false;
}

}  // namespace

/// Curve after curve: pieces add up arc length and angle, joints add the angle between two tangents. s and Theta are 0
/// at the first point.
Boundary::Boundary(std::vector<Formula> curves, bool closed) : curves_(std::move(curves)), closed_(closed) {
  if (curves_.empty()) throw std::runtime_error("an outline without curves");
  pieces_.resize(curves_.size());
  starts_.push_back({0, curves_[0].lo, 0.0, 0.0});
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    // Also refuses a NaN.
    if (!(curves_[k].lo < curves_[k].hi)) throw std::runtime_error("a curve whose parameter has no range");
    starts_.back().u = curves_[k].lo;
    const Place end = starts_.back();
    starts_.push_back(end);  // moves on piece by piece
    add_pieces(k, curves_[k].lo, curves_[k].hi, 0);
    join(k);
  }
  if (closed_) laps_ = {-perimeter().middle(), 0, perimeter().middle()};
}

/// Halves a curve until each piece's polynomials leave out no more than `kPieceError` and its speed is certainly above
/// 0. Only the smallest pieces, beside a place at rest, may have a speed of 0. Throws std::runtime_error.
void Boundary::add_pieces(std::size_t curve, double lo, double hi, int depth) {
  const Piece piece = piece_between(curves_[curve], lo, hi);
  const bool is_smallest = depth == kMostHalvings;
  if (piece.is_good && (piece.least_speed > 0 || is_smallest)) return append(curve, piece);
  if (is_smallest || !(piece.middle > lo && piece.middle < hi)) throw std::runtime_error("a curve that is not regular");
  add_pieces(curve, lo, piece.middle, depth + 1);
  add_pieces(curve, piece.middle, hi, depth + 1);
}

/// l and a by their Taylor polynomials about the middle. The last coefficient is that over a ball with all parameters
/// of the piece and its margin: Lagrange's remainder.
Boundary::Piece Boundary::piece_between(const Formula& formula, double lo, double hi) {
  Budget::spend(2 * formula.work);
  Piece piece;
  piece.lo = lo;
  piece.hi = hi;
  piece.middle = 0.5 * (lo + hi);
  const double margin = kMargin * (hi - lo);
  const Motion thin = formula.motion(piece.middle);
  const Motion wide = formula.motion(hull(Ball(lo) - margin, Ball(hi) + margin));
  piece.length = with_remainder(integral(thin.speed), integral(wide.speed), kOrder);
  piece.angle = with_remainder(integral(thin.turning), integral(wide.turning), kOrder);
  piece.least_speed = std::max(wide.speed[0].lower(), 0.0);
  // Half the width of the last coefficient times reach^kOrder is what the polynomial leaves open to either side.
  const double reach = std::max(hi - piece.middle, piece.middle - lo) + margin;
  const auto is_within = [&](const Series& polynomial, double most) {
    const Ball last = polynomial[kOrder];
    return last.is_finite() && 0.5 * spread(last) * std::pow(reach, static_cast<double>(kOrder)) <= most;
  };
  piece.is_good =
      is_within(piece.length, kPieceError * thin.speed[0].middle() * (hi - lo)) && is_within(piece.angle, kPieceError);
  return piece;
}

/// Puts a piece behind those before it: its polynomials are 0 in its middle, and s_base and angle_base are set so that
/// they start with the sums so far.
void Boundary::append(std::size_t curve, Piece piece) {
  Budget::spend(kPieceWork);
  Place& here = starts_.back();
  const Ball from = Ball(piece.lo) - piece.middle;
  piece.s = here.s;
  piece.s_base = here.s - value(piece.length, from);
  piece.angle_base = here.angle - value(piece.angle, from);
  const Place end = on_piece(curve, piece, piece.hi);
  here.s = end.s;
  here.angle = end.angle;
  pieces_[curve].push_back(std::move(piece));
}

/// The angle from the end tangent to the next curve's first one, in (-pi, pi), and the distance of the two points. A
/// closed outline's last curve has the first one as its next.
void Boundary::join(std::size_t curve) {
  const bool is_last = curve + 1 == curves_.size();
  if (is_last && !closed_) {
    jumps_.emplace_back(0.0);
    at_rest_.push_back(false);
    return;
  }
  const Formula& before = curves_[curve];
  const Formula& after = curves_[is_last ? 0 : curve + 1];
  const Point v = before.velocity(before.hi);
  const Point w = after.velocity(after.lo);
  const auto moves = [](const Formula& one, double u) { return one.motion(u).speed[0].is_above(0.0); };
  // A speed that is not certainly above 0 counts as rest, and rest as a corner: the safe side.
  at_rest_.push_back(!moves(before, before.hi) || !moves(after, after.lo));
  // atan2 of the cross and the dot product; at rest `velocity` is the tangent's direction.
  jumps_.push_back(atan2(v.x * w.y - v.y * w.x, v.x * w.x + v.y * w.y));
  starts_.back().angle = starts_.back().angle + jumps_.back();
  starts_.back().curve = static_cast<long>(curve) + 1;
  const Point end = before.position(before.hi);
  const Point start = after.position(after.lo);
  const Ball dx = end.x - start.x;
  const Ball dy = end.y - start.y;
  largest_gap_ = std::max(largest_gap_, sqrt(dx * dx + dy * dy).upper());
}

/// A counted curve on the first lap.
std::size_t Boundary::index(long curve) const {
  const long rest = curve % curves();
  return static_cast<std::size_t>(rest < 0 ? rest + curves() : rest);
}

/// s and the angle grow by the perimeter and the whole turn with each lap; u stays.
Place Boundary::moved(Place place, long laps) const {
  if (laps == 0) return place;
  place.curve += laps * curves();
  place.s = place.s + static_cast<double>(laps) * perimeter();
  place.angle = place.angle + static_cast<double>(laps) * total_turn();
  return place;
}

/// s and Theta at u, a ball of them where u is a ball. u may reach beyond the piece by its margin.
Place Boundary::on_piece(std::size_t curve, const Piece& piece, const Ball& u) const {
  const Ball x = u - piece.middle;
  return {static_cast<long>(curve), u, piece.s_base + value(piece.length, x), piece.angle_base + value(piece.angle, x)};
}

/// Throws std::domain_error, a refusal: a parameter that the curve does not have.
Place Boundary::at(long curve, double u) const {
  const std::vector<Piece>& pieces = pieces_.at(static_cast<std::size_t>(curve));
  if (!(u >= pieces.front().lo && u <= pieces.back().hi))
    throw std::domain_error("the place [" + std::to_string(curve) + ", " + std::to_string(u) +
                            "] is beyond its curve's ends, " + std::to_string(pieces.front().lo) + " and " +
                            std::to_string(pieces.back().hi));
  auto piece = pieces.begin();
  while (u > piece->hi) ++piece;
  return on_piece(static_cast<std::size_t>(curve), *piece, u);
}

Place Boundary::front(long curve) const { return moved(starts_[index(curve)], lap(curve)); }

/// The start of the next curve, with the angle before the joint; of an open outline's last curve its end.
Place Boundary::back(long curve) const {
  Place place = front(curve + 1);
  if (!closed_ && index(curve) + 1 == curves_.size()) place = starts_.back();
  place.curve = curve;
  place.u = formula(curve).hi;
  place.angle = place.angle - jump(curve);
  return place;
}

/// Solves s(u) = s by Newton's method in doubles. Its result u0 is only a guess: with the least speed v of the piece,
/// |u - u0| <= |s - s(u0)| / v encloses the exact u in a ball. Nothing if the ball leaves the curve, for then it is not
/// certain on which side of a joint the place is.
std::optional<Place> Boundary::after(const Ball& s) const {
  const double period = perimeter().middle();
  const long laps = closed_ ? static_cast<long>(std::floor(s.middle() / period)) : 0;
  // On the first lap; the place is moved on at the end.
  const Ball wanted = s - static_cast<double>(laps) * perimeter();
  const auto next = std::upper_bound(starts_.begin() + 1, starts_.end() - 1, wanted.middle(),
                                     [](double at, const Place& start) { return at < start.s.middle(); });
  const auto curve = static_cast<std::size_t>(next - starts_.begin()) - 1;
  const std::vector<Piece>& pieces = pieces_[curve];
  const auto piece = std::upper_bound(pieces.begin() + 1, pieces.end(), wanted.middle(),
                                      [](double at, const Piece& one) { return at < one.s.middle(); }) -
                     1;
  // A guess; the piece's polynomial has one root, for the speed is above 0.
  double u = piece->middle;
  for (int k = 0; k < kNewtonSteps; ++k) {
    const auto [length, speed] = value_and_slope(piece->length, Ball(u) - piece->middle);
    const double missing = (wanted - piece->s_base - length).middle();
    u = std::clamp(u + missing / speed.middle(), piece->lo, piece->hi);
    if (std::abs(missing) <= kNewtonGoal * period) break;
  }
  const Ball missing = wanted - piece->s_base - value(piece->length, Ball(u) - piece->middle);
  const double reach = kOutward * (abs(missing).upper() / piece->least_speed) + kLeastReach;
  // The piece's bounds hold no further than its margin.
  if (!(reach < kMargin * (piece->hi - piece->lo))) return std::nullopt;
  const Ball ball = hull(Ball(u) - reach, Ball(u) + reach);
  if (!(ball.is_above(curves_[curve].lo) && ball.is_below(curves_[curve].hi))) return std::nullopt;
  Place place = on_piece(curve, *piece, ball);
  // Known better than by the ball of u.
  place.s = wanted;
  return moved(place, laps);
}

/// An end is taken where s may be at it or beyond it.
std::optional<Place> Boundary::after_or_end(const Ball& s) const {
  if (!closed_ && !s.is_above(0.0)) return front(0);
  if (!closed_ && !s.is_below(perimeter())) return back(curves() - 1);
  return after(s);
}

/// kappa = Theta_u / s_u, and d(kappa)/ds = (Theta_uu s_u - Theta_u s_uu) / s_u^3. Not finite where the speed may be 0.
Boundary::Bend Boundary::bend(long curve, const Ball& u) const {
  Budget::spend(kFewTermsWork * formula(curve).work);
  const FewerTerms terms(kBendTerms);
  const Motion motion = formula(curve).motion(u);
  const Ball speed = motion.speed[0];
  const Ball change = motion.turning[1] * speed - motion.turning[0] * motion.speed[1];
  return {motion.turning[0] / speed, change / (speed * speed * speed)};
}

Ball Boundary::turning(long curve, const Ball& u) const {
  Budget::spend(kFewTermsWork * formula(curve).work);
  const FewerTerms terms(kTurnTerms);
  return formula(curve).motion(u).turning[0];
}

/// Theta as a series in the arc length, by reverting s(x); its derivative is kappa. Every coefficient is unknown where
/// the speed may be 0.
Series Boundary::curvature_ahead(long curve, const Ball& u) const {
  Budget::spend(formula(curve).work);
  const Motion motion = formula(curve).motion(u);
  Series curvature;
  // Only then s(x) can be reverted.
  if (motion.speed[0].is_above(0.0)) {
    curvature = derivative(composed(integral(motion.turning), inverse(integral(motion.speed))));
    arb_poly_truncate(curvature.get(), kOrder);
  } else {
    for (slong k = 0; k < kOrder; ++k) curvature.set(k, unknown());
  }
  return curvature;
}

/// One segment for each curve from the first place to the last one, joints in between.
std::vector<Segment> segments(const Boundary& boundary, const Place& from, const Place& to) {
  std::vector<Segment> result;
  for (long curve = from.curve; curve <= to.curve; ++curve) {
    result.push_back(
        {curve == from.curve ? from : boundary.front(curve), curve == to.curve ? to : boundary.back(curve)});
  }
  return result;
}

/// The hull over all curves; joints have no curvature.
Ball curvatures(const Boundary& boundary, const std::vector<Segment>& all) {
  const auto on = [&](const Segment& one) {
    return boundary.bend(one.from.curve, hull(one.from.u, one.to.u)).curvature;
  };
  Ball result = on(all.front());
  for (std::size_t k = 1; k < all.size(); ++k) result = hull(result, on(all[k]));
  return result;
}

/// Each joint counts from nothing to all of it: between the two places it may be passed or not.
Ball jumps(const Boundary& boundary, const std::vector<Segment>& all) {
  Ball sum = 0.0;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) sum = sum + up_to(boundary.jump(all[k].from.curve));
  return sum;
}

/// A corner that turns by kConcave or more to the concave side begins a new set, for the finger never has the angles in
/// between. All other joints unite both sides.
std::vector<Ball> angles(const Boundary& boundary, const std::vector<Segment>& all) {
  std::vector<Ball> sets;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Segment& one = all[k];
    // From the first angle on, by dTheta/du over the whole segment: finite at rest as well.
    const Ball here =
        one.from.angle + up_to(one.to.u - one.from.u) * boundary.turning(one.from.curve, hull(one.from.u, one.to.u));
    const bool goes_on = k > 0 && !boundary.is_concave(all[k - 1].from.curve);
    if (goes_on) {
      sets.back() = hull(sets.back(), here);
    } else {
      sets.push_back(here);
    }
  }
  return sets;
}

bool has_corner(const Boundary& boundary, const Place& from, const Place& to) {
  for (long curve = from.curve; curve < to.curve; ++curve) {
    if (boundary.is_corner(curve)) return true;
  }
  return false;
}

bool is_at_corner(const Boundary& boundary, const Ball& s, const std::vector<Ball>& lengths, double reach) {
  return std::any_of(lengths.begin(), lengths.end(),
                     [&](const Ball& length) { return is_at_corner(boundary, s + length, reach); });
}

}  // namespace rollfix_verify
