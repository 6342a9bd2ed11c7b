#include "pair_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "outline/turn.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/certificates.md, "Two fingers":
//   Theta_c(s)      angle of a finger's contact c, at s + L_c, c = 0 the first one: ContactStretch
//   f_k             A_k(s) - B_k(t) - turn_k with A_k(s) = Theta_k+1(s) - Theta_0(s), B_k of finger b; the facing's is
//                   Theta_0(s) - Theta_0(t) - C
//   w               weights of the equations, by contact in `contact_weights`: a sum of them is w . A - w . B -
//                   `right_side`
//   turns           whole turns by which the facing's row may be off on a box
//   X, J, Y         a pair of stretches scaled to [-1/2, 1/2]^2, the Jacobian's bounds `j`, about its inverse `inverse`
// Follows docs/certificates.md, "Two fingers", from "How it is checked" on; the one root is proved by Krawczyk's
// operator, Y (f +- tolerance) and (1 - Y J) X together inside X (R. Krawczyk, "Newton-Algorithmen zur Bestimmung von
// Nullstellen mit Fehlerschranken", 1969).
// Idea: the bounds of rollfix-verify in the search's own doubles, with some room (`kFill`, `kClearly`, `kBesideLine`),
// so that what is claimed here can be proved there.
namespace rollfix::certifying {
namespace {

// Half of a box is more than what its image may fill: the verifier's bounds on slopes are wider than those by spirals.
constexpr double kFill = 0.35;
// A pivot's angles stay what they are when a range around it is halved: from this share of the perimeter on they count
// for less.
constexpr double kPivotRoom = 0.1;
// A pivot has no slopes to be bounded.
constexpr double kPivotFill = 0.499;
// Equations are planes to so many tolerances, fewer than the verifier asks for; a facing turns by less than this then,
// radians. What is off by so many tolerances is off for the verifier, too.
constexpr double kFlat = 2;
constexpr double kPlainTurn = 3;
constexpr double kClearly = 1.1;
// What is beside a line of pairs that fit is off by this many tolerances, fewer than the verifier asks for, whose
// slopes are wider: by this share to either side, on more than this share of the perimeter by far more.
constexpr double kBesideLine = 7;
constexpr double kWiderSlopes = 0.5;
constexpr double kMostBeside = 0.05;
// Parts in which what is beside a root, or around a box, is to be told apart.
constexpr int kParts = 200;

/// L_c of each contact of a finger from its first one, which stands at the front with 0.
std::vector<double> lengths_of(const std::vector<Reading>& readings, std::size_t finger) {
  std::vector<double> result = {0};
  for (const Reading& reading : readings) result.push_back(reading.length[finger]);
  return result;
}

/// Sum of absolute values: a weighted sum that is off by x has some equation that is off by x / size or more.
double size_of(const std::vector<double>& weights) {
  double sum = 0;
  for (const double weight : weights) sum += std::abs(weight);
  return sum;
}

/// The angles in the middle of a stretch and how fast they change from its one end to the other.
struct Middle {
  std::vector<Range> angle;
  std::vector<Range> rate;
};

/// The middle of Krawczyk's operator for one unknown, and how much each angle changes over the whole stretch. Of a
/// pivot the unknown is the angle of the widest contact: arc length is fixed, so the others change not at all, but each
/// keeps all of its own range.
Middle middle_of(const ContactStretch& stretch, const std::vector<double>& angles) {
  Middle result;
  if (!stretch.pivot) {
    for (const double angle : angles) result.angle.push_back({angle, angle});
    for (const Range& rate : stretch.rate) result.rate.push_back(stretch.width() * rate);
    return result;
  }
  const std::size_t pivoting = stretch.widest();
  const Range& range = stretch.angle[pivoting];
  const double middle = range.middle();
  result.angle = stretch.angle;
  result.rate.assign(stretch.angle.size(), {0, 0});
  result.angle[pivoting] = {middle, middle};
  result.rate[pivoting] = {range.spread(), range.spread()};
  return result;
}

}  // namespace

PairBounds::PairBounds(const Part& part, const std::vector<Reading>& readings, const std::optional<double>& facing)
    : curves_{ContactCurve(part, lengths_of(readings, 0)), ContactCurve(part, lengths_of(readings, 1))},
      facing_(facing),
      period_(part.perimeter()),
      closed_(part.closed()) {
  for (const Reading& reading : readings) turns_.push_back(reading.turn);
}

/// One equation alone.
PairBounds::Weights PairBounds::unit(std::size_t row) const {
  Weights result(count(), 0);
  result[row] = 1;
  return result;
}

/// f_k contains +Theta_k+1 - Theta_0 of finger a and the same of finger b with the other sign; the facing contains
/// Theta_0 of both. So one list of weights serves both fingers.
PairBounds::Weights PairBounds::contact_weights(const Weights& weights) const {
  Weights result(turns_.size() + 1, 0);
  for (std::size_t k = 0; k < turns_.size(); ++k) {
    result[k + 1] = weights[k];
    result[0] -= weights[k];
  }
  if (facing_) result[0] += weights.back();
  return result;
}

double PairBounds::right_side(const Weights& weights, int turns) const {
  double sum = 0;
  for (std::size_t k = 0; k < turns_.size(); ++k) sum += weights[k] * turns_[k];
  if (facing_) sum += weights.back() * (*facing_ + turns * kFullTurn);
  return sum;
}

Range PairBounds::combined(const ContactStretch& a, const ContactStretch& b, const Weights& weights, int turns) const {
  const Weights contacts = contact_weights(weights);
  const double right = right_side(weights, turns);
  return a.sum(contacts) - b.sum(contacts) - Range{right, right};
}

/// Radians, the facing's to the nearest whole turn. At a corner the tangents just after it.
std::vector<double> PairBounds::off(double s, double t) const {
  const std::vector<double> a = curves_[0].angles(s, Side::after);
  const std::vector<double> b = curves_[1].angles(t, Side::after);
  std::vector<double> result;
  for (std::size_t k = 0; k < turns_.size(); ++k) result.push_back((a[k + 1] - a[0]) - (b[k + 1] - b[0]) - turns_[k]);
  if (facing_) result.push_back(std::remainder(a[0] - b[0] - *facing_, kFullTurn));
  return result;
}

PairBounds::Turns PairBounds::turns(const ContactStretch& a, const ContactStretch& b) const {
  if (!facing_) return {0, 0};
  const Range range = combined(a, b, unit(count() - 1), 0);
  return {static_cast<int>(std::floor(range.least / kFullTurn)), static_cast<int>(std::ceil(range.most / kFullTurn))};
}

/// The least bound over all pairs of stretches in the box; 0 where some pair may fit. Concave corners give several
/// stretches at one place, one for each angle.
double PairBounds::bound(const PairBox& box) {
  beat();
  double least = std::numeric_limits<double>::infinity();
  const std::vector<ContactStretch>& all_b = curves_[1].over(box[1].lo, box[1].hi);
  for (const ContactStretch& a : curves_[0].over(box[0].lo, box[0].hi)) {
    for (const ContactStretch& b : all_b) {
      least = std::min(least, bound(a, b));
      if (least <= 0) return 0;
    }
  }
  return least;
}

/// The facing holds but for whole turns: the least bound over all that are possible here.
double PairBounds::bound(const ContactStretch& a, const ContactStretch& b) const {
  double least = std::numeric_limits<double>::infinity();
  const Turns all = turns(a, b);
  for (int k = all.first; k <= all.second; ++k) least = std::min(least, bound(a, b, k));
  return least;
}

/// A bound from below on the largest |equation|, radians; 0: none. Tried are each equation, and of each two the
/// combination that does not change along the chord of a, and of b. Where two equations nearly depend on each other,
/// such a combination excludes 0 while none of them alone does. The verifier does the same.
double PairBounds::bound(const ContactStretch& a, const ContactStretch& b, int turns) const {
  double most = 0;
  const auto look = [&](const Weights& weights) {
    const Range range = combined(a, b, weights, turns);
    // The range's distance from 0, divided by the sum of weights: so much at least one of the equations is off by.
    most = std::max(most, std::max(range.least, -range.most) / size_of(weights));
  };
  for (std::size_t k = 0; k < count(); ++k) look(unit(k));
  for (std::size_t k = 0; k < count(); ++k) {
    for (std::size_t l = k + 1; l < count(); ++l) {
      for (const ContactStretch* one : {&a, &b}) {
        const auto chord = [&](std::size_t row) {
          const Weights contacts = contact_weights(unit(row));
          double sum = 0;
          for (std::size_t c = 0; c < contacts.size(); ++c) sum += contacts[c] * one->turn(c);
          return sum;
        };
        // chord(k) * equation l - chord(l) * equation k has the same value at both ends of the chord.
        Weights across(count(), 0);
        across[k] = -chord(l);
        across[l] = chord(k);
        if (size_of(across) > 0) look(across);
      }
    }
  }
  return most;
}

/// Stretches are cut at jumps of curvature as well, for an equation is near a plane only between them.
std::optional<std::vector<PairBox>> PairBounds::remains(const PairBox& box, double tolerance, const PairLine* line) {
  std::vector<PairBox> result;
  const std::vector<ContactStretch>& all_b = curves_[1].over(box[1].lo, box[1].hi, ContactCurve::Cuts::bends);
  for (const ContactStretch& a : curves_[0].over(box[0].lo, box[0].hi, ContactCurve::Cuts::bends)) {
    for (const ContactStretch& b : all_b) {
      if (!add_remains(a, b, tolerance, line, result)) return std::nullopt;
    }
  }
  return result;
}

/// The pairs of two stretches at which no equation is off by more than the tolerance, as a polygon in [0, 1]^2: shares
/// of the way along a and along b. Each equation is a plane within `off`, so that the polygon contains all that fits.
/// Nothing: some equation is off its plane by more than `kFlat` tolerances, or may be whole turns off the facing.
std::optional<Polygon> PairBounds::flat_part(const ContactStretch& a, const ContactStretch& b, double tolerance) const {
  Polygon set{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t k = 0; k < count(); ++k) {
    const Weights contacts = contact_weights(unit(k));
    const ContactStretch::Chord of_a = a.chord(contacts);
    const ContactStretch::Chord of_b = b.chord(contacts);
    // From the chords of both fingers; their distances from the chords add up.
    const double off = of_a.off + of_b.off;
    if (!(off <= kFlat * tolerance)) return std::nullopt;
    const Vec2 slope(of_a.to - of_a.from, of_b.from - of_b.to);
    double at = of_a.from - of_b.from - right_side(unit(k), 0);
    if (k == turns_.size()) {
      // The whole turns nearest to 0 in the middle. No others are possible if the facing stays below pi on the whole
      // square.
      at -= kFullTurn * std::round((at + 0.5 * slope.sum()) / kFullTurn);
      if (!(std::abs(at + 0.5 * slope.sum()) + 0.5 * slope.lpNorm<1>() < kPlainTurn)) return std::nullopt;
    }
    // |at + slope . x| <= tolerance + off holds wherever the equation itself is within the tolerance.
    set = within(set, Vec2(0, 0), at, slope, tolerance + off);
  }
  return set;
}

/// The same beside a line of pairs that fit. The line pairs t with s'(t); f_k(s, t) - f_k(s', t) is the integral of
/// A_k' from s' to s, and both are within the tolerance where all fits. A slope of one sign, |A_k'| >= m, therefore
/// gives |s - s'| <= 2 tolerance / m: `reach`. docs/certificates.md, "Two fingers".
std::optional<Polygon> PairBounds::part_beside(const ContactStretch& a, const ContactStretch& b, double tolerance,
                                               const PairLine& line) {
  if (a.pivot || b.pivot) return std::nullopt;
  // The whole laps nearest to a way; none on an open outline.
  const auto lap = [&](double way) { return closed_ ? period_ * std::round(way / period_) : 0; };
  double first = line.s + line.way * (b.lo - line.t);  // of b.lo
  const double turned = line.way * b.width();
  const double middle = first + 0.5 * turned;
  first += lap(line.s + 0.5 * line.length - middle);
  // A line that ends says nothing of a finger b's start that is beyond its ends.
  const bool is_round = closed_ && line.length >= period_;
  if (!is_round &&
      !(std::min(first, first + turned) >= line.s && std::max(first, first + turned) <= line.s + line.length))
    return std::nullopt;
  // Unwrapped next to stretch a; `whole` holds it and all s' of stretch b, so that slopes on it bound the integral.
  first += lap(0.5 * (a.lo + a.hi) - first - 0.5 * turned);
  const Interval whole{std::min({a.lo, first, first + turned}), std::max({a.hi, first, first + turned})};
  if (whole.width() > kMostBeside * period_) return std::nullopt;
  const std::vector<ContactStretch>& all = curves_[0].over(whole.lo, whole.hi);
  if (all.size() != 1 || all.front().pivot) return std::nullopt;
  double reach = whole.width();
  std::vector<Range> slopes;
  for (std::size_t k = 0; k < count(); ++k) {
    const Weights contacts = contact_weights(unit(k));
    slopes.push_back({0, 0});
    for (std::size_t c = 0; c < contacts.size(); ++c) slopes[k] = slopes[k] + contacts[c] * all.front().rate[c];
    // Slopes a little wider than they are, for the verifier's are.
    const double wider = kWiderSlopes * slopes[k].spread();
    slopes[k] = slopes[k] + Range{-wider, wider};
    // The facing may only be used where it can't be a whole turn off.
    const bool is_plain = k < turns_.size() || slopes[k].size() * whole.width() < 0.5 * kPlainTurn;
    const double least = std::max(slopes[k].least, -slopes[k].most);
    if (is_plain && least > 0) reach = std::min(reach, kClearly * 2 * tolerance / least);
  }
  for (const Range& slope : slopes) {
    // |s - s'| <= reach and a fit at s' bound how far each equation is off at s.
    if (!(slope.size() * reach + tolerance <= kBesideLine * tolerance)) return std::nullopt;
  }
  // |s'(t) - s| <= reach, a strip across the square of shares.
  return within({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, Vec2(0, 0), first - a.lo, Vec2(-a.width(), turned), reach);
}

/// The polygon's bounding box, in arc lengths.
bool PairBounds::add_remains(const ContactStretch& a, const ContactStretch& b, double tolerance, const PairLine* line,
                             std::vector<PairBox>& remains) {
  // Excluded: nothing of these two stretches remains.
  if (bound(a, b) > kClearly * tolerance) return true;
  std::optional<Polygon> set = flat_part(a, b, tolerance);
  if (!set && line != nullptr) set = part_beside(a, b, tolerance, *line);
  if (!set) return false;
  if (set->empty()) return true;
  // The polygon's corners bound it.
  Vec2 lo = set->front();
  Vec2 hi = set->front();
  for (const Vec2& corner : *set) {
    lo = lo.cwiseMin(corner);
    hi = hi.cwiseMax(corner);
  }
  remains.push_back({Interval{a.lo + lo.x() * a.width(), a.lo + hi.x() * a.width()},
                     Interval{b.lo + lo.y() * b.width(), b.lo + hi.y() * b.width()}});
  return true;
}

/// The largest change over equations and stretches, radians: what decides which side of a box is halved.
double PairBounds::change(const Interval& side, std::size_t finger, double share_of_pivots) {
  double most = 0;
  for (const ContactStretch& stretch : curves_[finger].over(side.lo, side.hi)) {
    // Pivots count in full, or less.
    const double share = stretch.pivot ? share_of_pivots : 1;
    for (std::size_t k = 0; k < count(); ++k) {
      most = std::max(most, share * stretch.sum(contact_weights(unit(k))).spread());
    }
  }
  return most;
}

/// Over the hull of all stretches, jumps at corners included.
double PairBounds::spread(const Interval& side, std::size_t finger) {
  double most = 0;
  for (std::size_t k = 0; k < count(); ++k) {
    Range all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const ContactStretch& stretch : curves_[finger].over(side.lo, side.hi)) {
      all = hull(all, stretch.sum(contact_weights(unit(k))));
    }
    most = std::max(most, all.spread());
  }
  return most;
}

/// `change`, with pivots counted less on short sides: a halved range around a corner still has the whole pivot.
double PairBounds::use_of_halving(const Interval& side, std::size_t finger) {
  return change(side, finger, std::min(1.0, side.width() / (kPivotRoom * period_)));
}

/// Any two equations with exactly one root leave at most one for all of them.
bool PairBounds::has_one_root(const PairBox& box, double tolerance) {
  for (std::size_t k = 0; k < count(); ++k) {
    for (std::size_t l = k + 1; l < count(); ++l) {
      if (has_one_root(box, {k, l}, tolerance)) return true;
    }
  }
  return false;
}

/// Exactly one pair of stretches has a root, all others are apart. Two pivots can't be halved: their bound decides.
bool PairBounds::has_one_root(const PairBox& box, std::array<std::size_t, 2> rows, double tolerance) {
  int roots = 0;
  const std::vector<ContactStretch>& all_b = curves_[1].over(box[1].lo, box[1].hi);
  for (const ContactStretch& a : curves_[0].over(box[0].lo, box[0].hi)) {
    for (const ContactStretch& b : all_b) {
      if (has_one_root(a, b, rows, tolerance)) {
        ++roots;
      } else if ((a.pivot && b.pivot && !(bound(a, b) > kClearly * tolerance)) ||
                 !are_apart({Interval{a.lo, a.hi}, Interval{b.lo, b.hi}}, tolerance)) {
        return false;
      }
    }
  }
  return roots == 1;
}

bool PairBounds::are_apart(const PairBox& box, double tolerance) {
  int budget = kParts;
  return is_apart(box, tolerance, budget);
}

/// Halves the side that changes more. `budget`: parts that may still be looked at; false where they run out.
bool PairBounds::is_apart(const PairBox& box, double tolerance, int& budget) {
  // All of the part is off, with room for the verifier.
  if (bound(box) > kClearly * tolerance) return true;
  if (--budget <= 0) return false;
  const std::size_t side = use_of_halving(box[0], 0) > use_of_halving(box[1], 1) ? 0 : 1;
  PairBox first = box;
  PairBox second = box;
  first[side].hi = second[side].lo = box[side].middle();
  return is_apart(first, tolerance, budget) && is_apart(second, tolerance, budget);
}

/// Krawczyk's operator on X = [-1/2, 1/2]^2, shares of both stretches around their middles: if the image of X is inside
/// of X, there is exactly one root, and all that is within the tolerance is inside as well. False also where the
/// Jacobian in the middle is singular: touching places, lines of pairs.
bool PairBounds::has_one_root(const ContactStretch& a, const ContactStretch& b, std::array<std::size_t, 2> rows,
                              double tolerance) const {
  const Turns all = turns(a, b);
  const Middle of_a = middle_of(a, a.pivot ? Weights{} : curves_[0].angles(0.5 * (a.lo + a.hi), Side::after));
  const Middle of_b = middle_of(b, b.pivot ? Weights{} : curves_[1].angles(0.5 * (b.lo + b.hi), Side::after));
  for (int turn = all.first; turn <= all.second; ++turn) {
    std::array<std::array<Range, 2>, 2> j{};
    std::array<Range, 2> f{};
    for (std::size_t k = 0; k < 2; ++k) {
      const Weights contacts = contact_weights(unit(rows[k]));
      const double right = right_side(unit(rows[k]), turn);
      // f in the middle, widened by the tolerance; J over all of X. For a pivot the angles of its other contacts are
      // ranges.
      f[k] = {-tolerance - right, tolerance - right};
      for (std::size_t c = 0; c < contacts.size(); ++c) {
        f[k] = f[k] + contacts[c] * (of_a.angle[c] - of_b.angle[c]);
        j[k][0] = j[k][0] + contacts[c] * of_a.rate[c];
        j[k][1] = j[k][1] - contacts[c] * of_b.rate[c];
      }
    }
    const double determinant = j[0][0].middle() * j[1][1].middle() - j[0][1].middle() * j[1][0].middle();
    if (determinant == 0) return false;
    const double inverse[2][2] = {{j[1][1].middle() / determinant, -j[0][1].middle() / determinant},
                                  {-j[1][0].middle() / determinant, j[0][0].middle() / determinant}};
    bool fits = true;
    for (std::size_t i = 0; i < 2; ++i) {
      // Y f has the other sign in the operator. Only sizes are compared, and the other term is symmetric about 0.
      Range image = inverse[i][0] * f[0] + inverse[i][1] * f[1];
      for (std::size_t k = 0; k < 2; ++k) {
        const Range off =
            Range{i == k ? 1.0 : 0.0, i == k ? 1.0 : 0.0} - (inverse[i][0] * j[0][k] + inverse[i][1] * j[1][k]);
        image = image + off * Range{-0.5, 0.5};
      }
      // Inside is |image| < 1/2; less is asked for, with room for the verifier's wider bounds.
      fits = fits && image.size() < ((i == 0 ? a : b).pivot ? kPivotFill : kFill);
    }
    if (fits) return true;
  }
  return false;
}

}  // namespace rollfix::certifying
