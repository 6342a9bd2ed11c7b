#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "belief/posterior.hpp"
#include "belief/two/pair_density.hpp"
#include "belief/two/pair_filter.hpp"
#include "outline/turn.hpp"
#include "work/pulse.hpp"

// Notation:
//   s               a finger's first contact; L: `length` of a node
//   c               a corner whose turn shows in the noise, or an open outline's end
//   passing         s = c - L, from where the contact is at c in that node, with its standard deviation
// Follows docs/two_fingers.md, "The search".
// Idea: between two passings next to each other a finger has passed the same corners in the same nodes, and on flat
// sides the likelihood is constant; at each it changes, within the passing's standard deviation.
namespace rollfix::belief {

/// A pivot that is smaller is lost in the errors of both orientations.
bool is_felt(const PairModel& model, const Corner& corner) {
  return corner.turn > kFarthest * std::sqrt(model.errors->facing_variance());
}

/// Of each node and each corner c that is felt, and both ends of an open outline: s = c - L, on the first lap. `nodes`:
/// the facing has no length and is left out.
Passings::Passings(const PairModel& model, std::size_t finger, const std::vector<PairNode>& nodes)
    : boundary_(model.places) {
  std::vector<double> places;
  for (const Corner& corner : model.part->corners()) {
    if (is_felt(model, corner)) places.push_back(corner.s);
  }
  if (!boundary_.closed) places.insert(places.end(), {0, boundary_.perimeter});
  const PairErrors& errors = *model.errors;
  const auto i = static_cast<Eigen::Index>(finger);
  double gathered = 0;
  for (const PairNode& node : nodes) {
    if (node.is_facing) continue;
    // What has gathered by this node, with the first contact's error, the scale's times L, and the node's own:
    // length^2.
    gathered += errors.gathered(node.gathered, node.travelled)[i];
    const double length = node.length[finger];
    const double sd = std::sqrt(errors.contact_variance() / std::max(1.0, node.rows) + errors.start()(i, i) + gathered +
                                errors.start()(2 + i, 2 + i) * square(length));
    for (const double place : places) passings_.push_back({boundary_.on_first_lap(place - length), sd});
  }
  std::sort(passings_.begin(), passings_.end(), [](const Passing& a, const Passing& b) { return a.s < b.s; });
}

/// By bisection: lo <= s < hi.
std::span<const Passing> Passings::between(double lo, double hi) const {
  const auto at_or_after = [&](double s) {
    return std::lower_bound(passings_.begin(), passings_.end(), s,
                            [](const Passing& passing, double at) { return passing.s < at; });
  };
  return {at_or_after(lo), at_or_after(hi)};
}

/// On a closed outline also across the seam, a lap back and a lap on.
double Passings::sharpest(double s, double reach) const {
  double least = std::numeric_limits<double>::infinity();
  const double at = boundary_.on_first_lap(s);
  const double laps = boundary_.closed ? boundary_.perimeter : 0;
  for (const double lap : {-laps, 0.0, laps}) {
    for (const Passing& passing : between(at - reach + lap, at + reach + lap)) least = std::min(least, passing.sd);
    if (laps == 0) break;
  }
  return least;
}

/// The neighbours of s on the first lap, the last one before the seam and the first one after it included, shifted to
/// the lap of s.
Interval Passings::gap(double s) const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (passings_.empty()) return {-kInfinite, kInfinite};
  const double at = boundary_.on_first_lap(s);
  const std::span<const Passing> after = between(at, kInfinite);
  const std::size_t before = passings_.size() - after.size();
  const double period = boundary_.closed ? boundary_.perimeter : kInfinite;
  const double above = after.empty() ? passings_.front().s + period : after.front().s;
  const double below = before == 0 ? passings_.back().s - period : passings_[before - 1].s;
  return {below + (s - at), above + (s - at)};
}

// ---- candidates
// Notation:
//   (s, t)          a pair of first contacts; a square around it is `half` to either side
//   Theta over I    least and largest angle on an interval of the boundary: `range_.over`
//   f               Theta(s + La) - Theta(t + Lb) - C of a row, or its change since the first contacts: [`lo`, `hi`]
//   margin          how far a contact may be from where it was felt, `sigmas` standard deviations: `RangeRow::margin`
//   precision       1 / (variance of f times sigmas^2), so that `sum` counts squares in units of sigmas^2
// Follows docs/two_fingers.md, "The search", step 1.
// Idea: a square is refused when the least squared distance that any pair in it can have from some of the rows is
// larger than noise makes it; the rest is quartered. It refuses the true pair with a small chance, `missed`, which is
// bounded.

namespace {

// Rows that squares are held against: more refuse earlier, and cost more.
constexpr std::size_t kRowsOfSearch = 25;
// The search begins with this many squares along a perimeter, ...
constexpr std::uint32_t kFirstSquares = 64;
// ... and stops halving them when there are more than this.
constexpr std::size_t kMostSquares = 1500;
// Of robust rows no single one may refuse a square: each counts at most this many standard deviations, squared, ...
constexpr double kMostOfRow = 9;
// ... and as many may be outliers: a share of them, three at least.
constexpr double kMostStray = 0.15;

/// A row as the search sees it: f is within what its contacts' ranges leave, give or take its own error.
struct RangeRow {
  bool is_facing = false;          // see PairNode
  std::array<double, 2> length{};  // of finger a and b
  std::array<double, 2> margin{};  // how far a contact may be from where it was felt
  double turn = 0;                 // C, or the change since the first contacts
  double precision = 0;            // of f, in units of sigmas: radians^-2
};

/// Up to kRowsOfSearch of the nodes. What a contact may be off goes into `margin`, in length; what the measured turn
/// and normals may be off into `precision`.
std::vector<RangeRow> rows_for(const PairModel& model, const std::vector<PairNode>& nodes, double sigmas) {
  const PairErrors& errors = *model.errors;
  const PairSharedCovariance& start = errors.start();
  // Variances that have gathered up to this node.
  PairShared gathered = PairShared::Zero();
  std::vector<RangeRow> rows;
  for (const PairNode& node : some_of(nodes, kRowsOfSearch)) {
    gathered += errors.gathered(node.gathered, node.travelled);
    RangeRow row;
    row.is_facing = node.is_facing;
    row.turn = node.turn;
    double variance = node.is_facing ? errors.facing_variance()
                                     : errors.turn_variance() / node.rows + errors.part_variance() * node.alike;
    if (!node.is_facing && !errors.absolute()) variance += start(4, 4) + gathered[4];
    for (const std::size_t finger : {0U, 1U}) {
      const auto i = static_cast<Eigen::Index>(finger);
      const double length = node.length[finger];
      const double kf = errors.normal_turn(finger);
      const double own = errors.contact_variance() / node.rows;
      // Through 1/r a contact's error turns the felt normal: the row's own, and the first contact's where f is a
      // change. In the facing it is the first contact's alone.
      variance += kf * kf * (node.is_facing ? start(i, i) : own + (errors.absolute() ? 0 : start(i, i)));
      row.length[finger] = length;
      if (node.is_facing) continue;
      row.margin[finger] = sigmas * std::sqrt(start(i, i) + gathered[i] + start(2 + i, 2 + i) * length * length + own) +
                           (node.rows > 1 ? std::abs(node.travelled[finger]) : 0);
    }
    row.precision = 1 / (variance * sigmas * sigmas);
    rows.push_back(row);
  }
  // From far apart to close together: neighbours refuse the same squares.
  constexpr std::size_t kApart = 8;
  std::vector<RangeRow> ordered;
  for (std::size_t offset = 0; offset < kApart; ++offset) {
    for (std::size_t k = offset; k < rows.size(); k += kApart) ordered.push_back(rows[k]);
  }
  return ordered;
}

/// Refuses squares in which no pair explains the rows.
class PairSieve {
 public:
  PairSieve(const PairModel& model, const TurningRange& range, const std::vector<PairNode>& nodes, double sigmas)
      : model_(model), range_(range), rows_(rows_for(model, nodes, sigmas)) {
    // A chi-square of n rows exceeds n + sigmas sqrt(2 n) + sigmas^2 with a probability below exp(-sigmas^2 / 2)
    // (Laurent and Massart, "Adaptive estimation of a quadratic functional by model selection", 2000).
    // The sum counts squares in units of sigmas^2.
    most_ = (rows() + sigmas * std::sqrt(2 * rows()) + sigmas * sigmas) / (sigmas * sigmas);
    if (model.outlier_share <= 0) return;
    // As many rows as may be outliers cost their most, and the square is still possible.
    most_of_row_ = kMostOfRow / (sigmas * sigmas);
    most_ += most_of_row_ * std::max(3.0, kMostStray * rows());
  }

  double rows() const { return static_cast<double>(rows_.size()); }

  /// The square around (s, t), half as wide as this.
  bool is_possible(double s, double t, double half) const {
    beat();
    // f over the square is an interval: Theta over the arcs that both contacts can reach.
    const double P = model_.perimeter();
    const bool absolute = model_.errors->absolute();
    const Interval at_s = absolute ? Interval{} : range_.over(s - half, s + half);
    const Interval at_t = absolute ? Interval{} : range_.over(t - half, t + half);
    double sum = 0;
    for (const RangeRow& row : rows_) {
      const double reach_a = half + row.margin[0];
      const double reach_b = half + row.margin[1];
      const double a_at = s + row.length[0];
      const double b_at = t + row.length[1];
      // A contact beyond an open outline's end for every pair in the square.
      if (!model_.places.closed &&
          (a_at + reach_a < 0 || a_at - reach_a > P || b_at + reach_b < 0 || b_at - reach_b > P)) {
        return false;
      }
      const Interval a = range_.over(a_at - reach_a, a_at + reach_a);
      const Interval b = range_.over(b_at - reach_b, b_at + reach_b);
      double lo = a.lo - b.hi - row.turn;
      double hi = a.hi - b.lo - row.turn;
      // A change since the first contacts: their tangents, anywhere in the square, are taken off.
      if (!absolute && !row.is_facing) {
        lo += at_t.lo - at_s.hi;
        hi += at_t.hi - at_s.lo;
      }
      // How far 0 is outside of [lo, hi]; where f counts up to whole turns, the nearest of them.
      double middle = 0.5 * (lo + hi);
      if (absolute || row.is_facing) middle -= kFullTurn * std::floor(middle / kFullTurn + 0.5);
      const double off = std::max(0.0, std::abs(middle) - 0.5 * (hi - lo));
      sum += std::min(most_of_row_, off * off * row.precision);
      if (sum > most_) return false;
    }
    return true;
  }

 private:
  const PairModel& model_;
  const TurningRange& range_;
  std::vector<RangeRow> rows_;
  double most_ = 0;
  double most_of_row_ = 1e300;
};

}  // namespace

/// Quarters what is possible until squares are as small as `resolution`, or there are more than kMostSquares.
PairCandidates pair_candidates(const PairModel& model, const TurningRange& range, const std::vector<PairNode>& nodes,
                               double sigmas, double resolution) {
  const double P = model.perimeter();
  const PairSieve sieve(model, range, nodes, sigmas);
  PairCandidates candidates;
  candidates.cells = kFirstSquares;
  // A contact is beyond `sigmas` with the chance erfc(sigmas / sqrt 2). Two contacts for each row, and the sum counts
  // as one more (union bound).
  candidates.missed = std::min(1.0, (2 * sieve.rows() + 1) * std::erfc(sigmas / std::numbers::sqrt2));
  const auto centre = [&](std::uint32_t index) {
    return P * (static_cast<double>(index) + 0.5) / static_cast<double>(candidates.cells);
  };
  for (std::uint32_t i = 0; i < kFirstSquares; ++i) {
    for (std::uint32_t j = 0; j < kFirstSquares; ++j) {
      if (sieve.is_possible(centre(i), centre(j), 0.5 * P / kFirstSquares)) candidates.squares.push_back({i, j});
    }
  }
  // Cells are no smaller than two of the table's.
  const double most_cells = std::min(P / resolution, static_cast<double>(kRangeCells) / 2);
  while (candidates.cells < most_cells && candidates.squares.size() <= kMostSquares) {
    candidates.cells *= 2;
    const double half = 0.5 * P / static_cast<double>(candidates.cells);
    std::vector<PairSquare> finer;
    for (const PairSquare& square : candidates.squares) {
      for (const std::uint32_t di : {0U, 1U}) {
        for (const std::uint32_t dj : {0U, 1U}) {
          const PairSquare quarter{2 * square.i + di, 2 * square.j + dj};
          if (sieve.is_possible(centre(quarter.i), centre(quarter.j), half)) finer.push_back(quarter);
        }
      }
    }
    candidates.squares = std::move(finer);
  }
  return candidates;
}

PairCandidates all_squares() {
  PairCandidates candidates;
  candidates.cells = kFirstSquares;
  for (std::uint32_t i = 0; i < kFirstSquares; ++i) {
    for (std::uint32_t j = 0; j < kFirstSquares; ++j) candidates.squares.push_back({i, j});
  }
  return candidates;
}

}  // namespace rollfix::belief
