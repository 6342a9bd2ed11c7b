#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "belief/nodes.hpp"
#include "rollfix/turning_function.hpp"

// Notation, as in docs/belief.md, "Centres as evidence" and "How many rows are joined":
//   p(s)            the boundary, by Hermite's cubic on each cell of s: BoundaryPath::at
//   w               turn + c L of a row, c being `tilt_`: `tilted`
//   median          of up to kRowsOfMedian neighbouring rows where outliers are reckoned with, else a row is its own
//   block           the mean of `stride_` rows, or of errors that add up the last of them: JoinedRows
//   scatter         variance of w among the medians of a block; `own` the variance of the mean's own errors
// Follows the paragraphs named above; variances are updated as by D. H. D. West, "Updating mean and variance estimates:
// an improved method" (1979).
// Idea: rows are added to the open block as they come. Where there are too many blocks each two neighbours become one.
namespace rollfix::belief {
namespace {

// A cell of the path is no longer than this share of the perimeter, and turns by no more than this, radians: a cubic is
// then within 2e-8 of the radius of curvature.
constexpr double kLongestCell = 1.0 / 1024;
constexpr double kMostTurnOfCell = 0.05;

}  // namespace

/// Each spiral is cut into cells of equal length, as many as both bounds ask for. Cells share their ends, so that the
/// path has no gaps; tangents at a cell's ends are its spiral's, so that corners stay sharp.
BoundaryPath::BoundaryPath(const Part& part) : closed_(part.closed()), perimeter_(part.perimeter()) {
  const TurningFunction& turning = part.turning();
  std::vector<double> starts;
  for (const Spiral& spiral : turning.spirals()) {
    const double length = spiral.hi - spiral.lo;
    const double pieces = std::max({1.0, std::ceil(length / (kLongestCell * perimeter_)),
                                    std::ceil(std::abs(spiral.end.angle - spiral.start.angle) / kMostTurnOfCell)});
    const auto direction = [&](double s) {
      const double angle = turning.on_spiral(spiral, s).angle;
      return Vec2(std::cos(angle), std::sin(angle));
    };
    for (double k = 0; k < pieces; ++k) {
      const double lo = spiral.lo + length * k / pieces;
      const double hi = k + 1 < pieces ? spiral.lo + length * (k + 1) / pieces : spiral.hi;
      if (!(hi > lo)) continue;
      const Vec2 from = cells_.empty() ? part.point(lo) : cells_.back().to;
      cells_.push_back({lo, hi - lo, from, part.point(hi), (hi - lo) * direction(lo), (hi - lo) * direction(hi)});
      starts.push_back(lo);
    }
  }
  buckets_ = Buckets(starts, perimeter_);
}

/// By Hermite's cubic on the cell of s; beyond an open outline's ends along the tangent there.
Vec2 BoundaryPath::at(double s) const {
  const double place = closed_ ? wrap(s, perimeter_).base : std::clamp(s, 0.0, perimeter_);
  std::size_t k = buckets_.before(place);
  // A bucket may begin a few cells early.
  while (k + 1 < cells_.size() && cells_[k + 1].s <= place) ++k;
  const Cell& cell = cells_[k];
  const double x = (place - cell.s) / cell.length;
  // Hermite's.
  const Vec2 rise = cell.to - cell.from;
  const Vec2 b = 3 * rise - 2 * cell.by_from - cell.by_to;
  const Vec2 c = cell.by_from + cell.by_to - 2 * rise;
  Vec2 on_path = cell.from + x * (cell.by_from + x * (b + x * c));
  if (closed_ || place == s) return on_path;
  // Derivatives are by the share of the cell: divided by its length they are by s.
  const Vec2& along = s < 0 ? cell.by_from : cell.by_to;
  return on_path + (s - place) / cell.length * along;
}

namespace {

/// Adds a centre and its arm, as vectors in the world and in the normal's frame, by a factor.
void add_share(FeltCentre& sum, double factor, const FeltCentre& felt) {
  sum.centre += factor * felt.centre;
  sum.arm.at += factor * felt.arm.at;
  sum.arm.per_length += factor * felt.arm.per_length;
}

}  // namespace

double median(std::span<double> values) {
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 == 1) return *upper;
  return 0.5 * (*upper + *std::max_element(values.begin(), upper));
}

/// Number by number: lengths and turn of the result need not be of one row.
Reading median_of(std::span<const Reading> rows) {
  Reading middle = rows.front();
  if (rows.size() == 1) return middle;
  const auto median_by = [&](const auto& number) {
    std::array<double, kRowsOfMedian> values{};
    std::transform(rows.begin(), rows.end(), values.begin(), number);
    return median(std::span(values).first(rows.size()));
  };
  for (std::size_t finger = 0; finger < middle.fingers(); ++finger) {
    middle.length[finger] = median_by([&](const Reading& row) { return row.length[finger]; });
  }
  middle.turn = median_by([](const Reading& row) { return row.turn; });
  return middle;
}

std::size_t rows_of_median(bool robust, std::size_t stride) { return robust ? std::min(stride, kRowsOfMedian) : 1; }

JoinedRows RowBlocks::joined(const JoinedRows& a, const JoinedRows& b) const {
  // Increments: the last row has all errors of those before it, and says as much as all.
  if (errors_.gathers_rows()) {
    JoinedRows last = b;
    last.rows += a.rows;
    return last;
  }
  JoinedRows both;
  both.rows = a.rows + b.rows;
  both.seconds = b.seconds;
  const double of_a = a.rows / both.rows;
  const double of_b = b.rows / both.rows;
  const double apart = b.tilted(tilt_) - a.tilted(tilt_);
  both.length = of_a * a.length + of_b * b.length;
  both.turn = of_a * a.turn + of_b * b.turn;
  both.sensed = of_a * a.sensed + of_b * b.sensed;
  both.middle = of_a * a.middle + of_b * b.middle;
  // The variance within both and between their means.
  both.scatter = of_a * a.scatter + of_b * b.scatter + of_a * of_b * apart * apart;
  const double way = b.length - a.length;
  both.length_scatter = of_a * a.length_scatter + of_b * b.length_scatter + of_a * of_b * way * way;
  // Independent errors: shares enter squared.
  both.own = of_a * of_a * a.own + of_b * of_b * b.own;
  add_share(both.felt, of_a, a.felt);
  add_share(both.felt, of_b, b.felt);
  return both;
}

/// Rows fill a median, medians fill the block. Of increments each row replaces what the block had.
bool RowBlocks::add(const Row& row) {
  // How many rows a taught part is off for alike depends on all rows so far, and on the boundary they are spread over.
  rows_ += 1;
  sum_.rows += 1;
  sum_.seconds = row.seconds;
  range_ = {std::min(range_.lo, row.reading.length[0]), std::max(range_.hi, row.reading.length[0])};
  own_ = errors_.row(row.finger_curvature, errors_.rows_alike(rows_, range_.width()));
  if (errors_.gathers_rows()) {
    // Errors that add up are in all rows that follow: the last one tells as much as all.
    sum_ = {0, 0, 0, 0, {}, {}, sum_.rows, row.seconds, 0, 0};
    medians_ = 0;
    of_median_.clear();
  }
  of_median_.push_back(row);
  if (of_median_.size() >= rows_of_median(robust_, stride_)) {
    close_median(sum_, medians_);
    of_median_.clear();
  }
  // The block is full: it is closed, and a new one is open and empty.
  if (sum_.rows < static_cast<double>(stride_)) return false;
  blocks_.push_back(open());
  sum_ = {};
  medians_ = 0;
  of_median_.clear();
  return true;
}

/// Adds the median of the rows that wait for it to these sums; times and centres are means. Nothing where no row waits.
void RowBlocks::close_median(JoinedRows& sum, double& medians) const {
  if (of_median_.empty()) return;
  std::array<Reading, kRowsOfMedian> readings;
  for (std::size_t k = 0; k < of_median_.size(); ++k) {
    const Row& row = of_median_[k];
    readings[k] = row.reading;
    // Sums over medians: the means of these rows count as one.
    const double share = 1 / static_cast<double>(of_median_.size());
    sum.sensed += share * row.sensed;
    sum.middle += share * row.seconds;
    add_share(sum.felt, share, row.felt);
  }
  // Counts as one row: where rows lie on a slope their median is about as noisy as one of them.
  const Reading middle = median_of(std::span(readings).first(of_median_.size()));
  // The variance among the medians so far, times their number (West 1979).
  if (medians > 0) {
    const double off = middle.turn + tilt_ * middle.length[0] - sum.tilted(tilt_) / medians;
    sum.scatter += off * off * medians / (1 + medians);
    const double way = middle.length[0] - sum.length / medians;
    sum.length_scatter += way * way * medians / (1 + medians);
  }
  sum.length += middle.length[0];
  sum.turn += middle.turn;
  sum.own = sum.own + own_;
  medians += 1;
}

/// Sums over medians as means; the rows that wait are taken as a median of their own. REQUIRES has_open().
JoinedRows RowBlocks::open() const {
  JoinedRows sum = sum_;
  double medians = medians_;
  close_median(sum, medians);
  const double share = 1 / medians;
  JoinedRows rows{
      share * sum.length, share * sum.turn, share * sum.sensed, share * sum.scatter,       share * share * sum.own, {},
      sum.rows,           sum.seconds,      share * sum.middle, share * sum.length_scatter};
  add_share(rows.felt, share, sum.felt);
  return rows;
}

/// REQUIRES an even number of blocks.
void RowBlocks::halve() {
  for (std::size_t k = 0; 2 * k + 1 < blocks_.size(); ++k) {
    blocks_[k] = joined(blocks_[2 * k], blocks_[2 * k + 1]);
  }
  blocks_.resize(blocks_.size() / 2);
  stride_ *= 2;
}

}  // namespace rollfix::belief
