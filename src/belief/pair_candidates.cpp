#include "belief/pair_candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "rollfix/part/period.hpp"

namespace rollfix::belief {

namespace {

// Cells of the table of ranges, per perimeter.
constexpr std::size_t kRangeCells = 8192;
// Rows that squares are held against: more refuse earlier, and cost more.
constexpr std::size_t kRowsOfSearch = 25;
// The search begins with this many squares along a perimeter, ...
constexpr std::uint32_t kFirstSquares = 64;
// ... and stops halving them when there are more than this.
constexpr std::size_t kMostSquares = 1500;
// Of robust rows no single one may refuse a square: each counts at most this many standard deviations, squared, ...
constexpr double kMostOfRow = 9;
// ... and as many may be stray: a share of them, three at least.
constexpr double kMostStray = 0.15;
constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kFloatSlack = 4e-7;  // relative

/// A row as the search sees it: f is within what its contacts' ranges leave, give or take its own error.
struct RangeRow {
  bool is_facing = false;
  std::array<double, 2> length{};
  std::array<double, 2> margin{};  // how far a contact may be from where it was felt
  double turn = 0;
  double precision = 0;
};

std::vector<RangeRow> rows_for(const PairModel& model, const std::vector<PairNode>& nodes, double sigmas) {
  const PairErrors& errors = *model.errors;
  const PairSharedCovariance& start = errors.start();
  PairShared gathered = PairShared::Zero();
  std::vector<RangeRow> rows;
  for (const PairNode& node : some_of(nodes, kRowsOfSearch)) {
    gathered += errors.gathered(node.gathered, node.travelled);
    RangeRow row;
    row.is_facing = node.is_facing;
    row.turn = node.turn;
    double variance = node.is_facing ? errors.facing_variance() : errors.turn_variance() / node.rows;
    if (!node.is_facing && !errors.absolute()) variance += start(4, 4) + gathered[4];
    for (const std::size_t finger : {0U, 1U}) {
      const auto i = static_cast<Eigen::Index>(finger);
      const double length = node.length[finger];
      const double kf = errors.normal_turn(finger);
      const double own = errors.contact_variance() / node.rows;
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

}  // namespace

TurningRange::TurningRange(const TurningFunction& turning)
    : turning_(&turning), step_(turning.perimeter() / static_cast<double>(kRangeCells)), cells_(kRangeCells) {
  const double P = turning.perimeter();
  std::vector<double> least(cells_);
  std::vector<double> most(cells_);
  for (std::size_t k = 0; k < cells_; ++k) {
    const double from = turning.angle(std::min(P, step_ * static_cast<double>(k)), Side::after);
    const double to = turning.angle(std::min(P, step_ * static_cast<double>(k + 1)), Side::before);
    least[k] = std::min(from, to);
    most[k] = std::max(from, to);
  }
  const auto include = [&](double s, double angle) {
    // Rounding may put an end of a spiral on either side.
    const double at = s / step_;
    for (const double nudge : {-1e-6, 1e-6}) {
      const auto k = static_cast<std::size_t>(std::clamp(at + nudge, 0.0, static_cast<double>(cells_ - 1)));
      least[k] = std::min(least[k], angle);
      most[k] = std::max(most[k], angle);
    }
  };
  const std::vector<Spiral>& spirals = turning.spirals();
  for (std::size_t k = 0; k < spirals.size(); ++k) {
    include(spirals[k].lo, spirals[k].start.angle);
    include(spirals[k].hi, spirals[k].end.angle);
    if (k > 0) include(spirals[k].lo, spirals[k - 1].end.angle);
    if (k > 0) include(spirals[k - 1].hi, spirals[k].start.angle);
  }
  if (turning.closed()) {
    include(0, spirals.back().end.angle - turning.period_turn());
    include(P, spirals.front().start.angle + turning.period_turn());
  }
  const std::size_t count = turning.closed() ? 2 * cells_ : cells_;
  least_.emplace_back(count);
  most_.emplace_back(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double lift = k >= cells_ ? turning.period_turn() : 0;
    const double lo = least[k % cells_] + lift;
    const double hi = most[k % cells_] + lift;
    least_[0][k] = static_cast<float>(lo - kFloatSlack * std::abs(lo));
    most_[0][k] = static_cast<float>(hi + kFloatSlack * std::abs(hi));
  }
  for (std::size_t width = 1; 2 * width <= count; width *= 2) {
    const std::vector<float>& lo = least_.back();
    const std::vector<float>& hi = most_.back();
    std::vector<float> wider_lo(lo.size() - width);
    std::vector<float> wider_hi(wider_lo.size());
    for (std::size_t k = 0; k < wider_lo.size(); ++k) {
      wider_lo[k] = std::min(lo[k], lo[k + width]);
      wider_hi[k] = std::max(hi[k], hi[k + width]);
    }
    least_.push_back(std::move(wider_lo));
    most_.push_back(std::move(wider_hi));
  }
}

Interval TurningRange::over(double lo, double hi) const {
  const double P = turning_->perimeter();
  double lift = 0;
  if (turning_->closed()) {
    if (hi - lo >= P) return {-1e9, 1e9};
    const Wrapped wrapped = wrap(lo, P);
    lift = wrapped.winding * turning_->period_turn();
    hi = wrapped.base + (hi - lo);
    lo = wrapped.base;
  }
  const auto last = static_cast<double>(least_.front().size() - 1);
  const auto first = static_cast<std::size_t>(std::clamp(std::floor(lo / step_), 0.0, last));
  const auto end = static_cast<std::size_t>(std::clamp(std::floor(hi / step_), 0.0, last)) + 1;
  std::size_t j = 0;
  while ((std::size_t{2} << j) <= end - first) ++j;
  const std::size_t second = end - (std::size_t{1} << j);
  return {std::min(least_[j][first], least_[j][second]) + lift, std::max(most_[j][first], most_[j][second]) + lift};
}

PairCandidates pair_candidates(const PairModel& model, const TurningRange& range, const std::vector<PairNode>& nodes,
                               double sigmas, double resolution) {
  const double P = model.perimeter();
  const std::vector<RangeRow> rows = rows_for(model, nodes, sigmas);
  const auto count = static_cast<double>(rows.size());
  const bool robust = model.outliers.share > 0;
  // A sum of as many squares, in units of sigmas^2.
  double most = (count + sigmas * std::sqrt(2 * count) + sigmas * sigmas) / (sigmas * sigmas);
  const double most_of_row = robust ? kMostOfRow / (sigmas * sigmas) : 1e300;
  if (robust) most += most_of_row * std::max(3.0, kMostStray * count);
  const bool absolute = model.errors->absolute();

  const auto is_possible = [&](double s, double t, double half) {
    const Interval at_s = absolute ? Interval{} : range.over(s - half, s + half);
    const Interval at_t = absolute ? Interval{} : range.over(t - half, t + half);
    double sum = 0;
    for (const RangeRow& row : rows) {
      const double reach_a = half + row.margin[0];
      const double reach_b = half + row.margin[1];
      const double a_at = s + row.length[0];
      const double b_at = t + row.length[1];
      if (!model.closed && (a_at + reach_a < 0 || a_at - reach_a > P || b_at + reach_b < 0 || b_at - reach_b > P)) {
        return false;
      }
      const Interval a = range.over(a_at - reach_a, a_at + reach_a);
      const Interval b = range.over(b_at - reach_b, b_at + reach_b);
      double lo = a.lo - b.hi - row.turn;
      double hi = a.hi - b.lo - row.turn;
      if (!absolute && !row.is_facing) {
        lo += at_t.lo - at_s.hi;
        hi += at_t.hi - at_s.lo;
      }
      double middle = 0.5 * (lo + hi);
      if (absolute || row.is_facing) middle -= kFullTurn * std::floor(middle / kFullTurn + 0.5);
      const double off = std::max(0.0, std::abs(middle) - 0.5 * (hi - lo));
      sum += std::min(most_of_row, off * off * row.precision);
      if (sum > most) return false;
    }
    return true;
  };

  PairCandidates candidates;
  candidates.cells = kFirstSquares;
  candidates.missed = std::min(1.0, (2 * count + 1) * std::erfc(sigmas / std::numbers::sqrt2));
  const auto centre = [&](std::uint32_t index) {
    return P * (static_cast<double>(index) + 0.5) / static_cast<double>(candidates.cells);
  };
  for (std::uint32_t i = 0; i < kFirstSquares; ++i) {
    for (std::uint32_t j = 0; j < kFirstSquares; ++j) {
      if (is_possible(centre(i), centre(j), 0.5 * P / kFirstSquares)) candidates.squares.push_back({i, j});
    }
  }
  const double most_cells = std::min(P / resolution, static_cast<double>(kRangeCells) / 2);
  while (candidates.cells < most_cells && candidates.squares.size() <= kMostSquares) {
    candidates.cells *= 2;
    const double half = 0.5 * P / static_cast<double>(candidates.cells);
    std::vector<PairSquare> finer;
    for (const PairSquare& square : candidates.squares) {
      for (const std::uint32_t di : {0U, 1U}) {
        for (const std::uint32_t dj : {0U, 1U}) {
          const PairSquare quarter{2 * square.i + di, 2 * square.j + dj};
          if (is_possible(centre(quarter.i), centre(quarter.j), half)) finer.push_back(quarter);
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
