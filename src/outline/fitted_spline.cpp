#include "outline/fitted_spline.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <utility>

// Notation:
//   t_i, q_i        parameters and points
//   f(t)            sum of N_j(t) c_j: cubic B-splines, `basis`, and their control points, `controls_`
//   A c = b         normal equations of |f(t_i) - q_i|^2 and, with a small weight, of the third derivative: `blocks`
//   knot            where spans meet: counted once, three times where f is sharp, four times at an end: `repeated_`
// Follows C. de Boor, "A Practical Guide to Splines" (1978).
// Idea: four B-splines are not zero on a span, so that A is banded (of a closed f cyclically): sparse elimination takes
// linear time.
namespace rollfix {

namespace {

constexpr int kSharp = 3;  // a cubic spline's knot counted this often leaves only the position continuous
constexpr int kEnd = 4;    // and this often it is an end
/// Bending counts this much beside the third derivative: nothing, except where no point says anything.
constexpr double kBending = 1e-3;

}  // namespace

/// Binary search; before the first break the first span, behind the last one the last span. At a break the span that
/// starts there.
std::size_t Knots::span_at(double t) const {
  const auto after = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, t);
  return static_cast<std::size_t>(after - breaks.begin()) - 1;
}

/// No break is sharp.
Knots even_knots(double lo, double hi, std::size_t spans, bool closed) {
  Knots knots{{}, std::vector<char>(spans + 1, 0), closed};
  for (std::size_t k = 0; k < spans; ++k) {
    knots.breaks.push_back(lo + (hi - lo) * static_cast<double>(k) / static_cast<double>(spans));
  }
  // Set, not computed: the end is exact.
  knots.breaks.push_back(hi);
  return knots;
}

/// Linear in the number of points and spans.
FittedSpline::FittedSpline(Knots knots, const std::vector<double>& parameters, const std::vector<Vec2>& points,
                           double stiffness)
    : knots_(std::move(knots)) {
  lay_knots();
  solve(parameters, points, stiffness);
  make_spans();
}

void FittedSpline::lay_knots() {
  const std::size_t spans = knots_.spans();
  for (std::size_t k = 0; k < knots_.breaks.size(); ++k) {
    // An end counts 4 times, so that the curve ends at its last control point; a corner 3 times, which leaves position
    // alone continuous.
    const bool is_end = !knots_.closed && (k == 0 || k == spans);
    const int count = is_end ? kEnd : (knots_.sharp[k] != 0 ? kSharp : 1);
    // Closed: the last break is the first, one period on, and is not repeated.
    if (k < spans || !knots_.closed)
      repeated_.insert(repeated_.end(), static_cast<std::size_t>(count), knots_.breaks[k]);
    if (k < spans) last_knot_.push_back(static_cast<long>(repeated_.size()) - 1);
  }
  controls_.resize(knots_.closed ? repeated_.size() : repeated_.size() - kEnd);
}

double FittedSpline::knot(long index) const {
  const auto count = static_cast<long>(repeated_.size());
  if (!knots_.closed) return repeated_[static_cast<std::size_t>(std::clamp(index, 0L, count - 1))];
  const double period = knots_.breaks.back() - knots_.breaks.front();
  long laps = index / count;
  long rest = index % count;
  if (rest < 0) {
    rest += count;
    --laps;
  }
  return repeated_[static_cast<std::size_t>(rest)] + static_cast<double>(laps) * period;
}

std::size_t FittedSpline::coefficient(long index) const {
  const auto count = static_cast<long>(controls_.size());
  const long rest = index % count;
  return static_cast<std::size_t>(rest < 0 ? rest + count : rest);
}

/// The values at t of the four B-splines that are not zero on the span: Cox and de Boor's recurrence. None is below 0
/// for t on the span, and their sum is 1.
FittedSpline::Weights FittedSpline::basis(std::size_t span, double t) const {
  const long j = last_knot_[span];
  Weights n = {1, 0, 0, 0};
  // From the B-splines of one degree less: each new one is a mix of two neighbours. n[0 ... degree] are valid after
  // each turn.
  for (int degree = 1; degree <= 3; ++degree) {
    double carried = 0;
    for (int r = 0; r < degree; ++r) {
      const double right = knot(j + r + 1);
      const double left = knot(j + 1 - degree + r);
      const double share = n[static_cast<std::size_t>(r)] / (right - left);
      n[static_cast<std::size_t>(r)] = carried + (right - t) * share;
      carried = (t - left) * share;
    }
    n[static_cast<std::size_t>(degree)] = carried;
  }
  return n;
}

/// The second derivatives by t at the span's two ends, as weights of its four control points.
std::array<FittedSpline::Weights, 2> FittedSpline::second_derivatives(std::size_t span) const {
  // The derivative of a B-spline curve of degree d has the control points d (c_(i+1) - c_i) / (difference of knots),
  // and the degree d - 1.
  const long j = last_knot_[span];
  std::array<Weights, 3> first{};
  for (int k = 0; k < 3; ++k) {  // first derivatives' control points j-2 .. j
    const long i = j - 2 + k;
    const double factor = 3 / (knot(i + 3) - knot(i));
    const auto at = static_cast<std::size_t>(k);
    first[at][at + 1] = factor;
    first[at][at] = -factor;
  }
  std::array<Weights, 2> second{};
  for (int k = 0; k < 2; ++k) {  // second derivatives' control points j-1, j: they are the values at the ends
    const long i = j - 1 + k;
    const double factor = 2 / (knot(i + 2) - knot(i));
    const auto at = static_cast<std::size_t>(k);
    for (std::size_t c = 0; c < 4; ++c) second[at][c] = factor * (first[at + 1][c] - first[at][c]);
  }
  return second;
}

/// Minimizes the sum of |f(t_i) - q_i|^2 + stiffness * (third derivative)^2 as scaled below. x and y are two right
/// sides of one matrix.
void FittedSpline::solve(const std::vector<double>& parameters, const std::vector<Vec2>& points, double stiffness) {
  using Block = Eigen::Matrix4d;
  const std::size_t spans = knots_.spans();
  std::vector<Block> blocks(spans, Block::Zero());
  const auto size = static_cast<Eigen::Index>(controls_.size());
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(size, 2);
  // Each point adds the product of its four weights to the block of its span.
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t span = knots_.span_at(parameters[i]);
    const Weights weights = basis(span, parameters[i]);
    const Eigen::Map<const Eigen::Vector4d> row(weights.data());
    blocks[span] += row * row.transpose();
    for (int c = 0; c < 4; ++c) {
      const auto control = static_cast<Eigen::Index>(coefficient(last_knot_[span] - 3 + c));
      right.row(control) += row[c] * points[i].transpose();
    }
  }

  // The stiffness of a span counts as so many points as there are on average on its width: it does not depend on the
  // unit or on the number of points.
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(16 * spans);
  const double whole = knots_.breaks.back() - knots_.breaks.front();
  const double density = static_cast<double>(points.size()) / whole;
  for (std::size_t span = 0; span < spans; ++span) {
    const double width = knots_.breaks[span + 1] - knots_.breaks[span];
    const auto ends = second_derivatives(span);
    const Eigen::Map<const Eigen::Vector4d> from(ends[0].data());
    const Eigen::Map<const Eigen::Vector4d> to(ends[1].data());
    // f'' is straight on a span. Its change is the third derivative times the width; `bend` is its mean. Both by the
    // span's own parameter, in [0, 1].
    const Eigen::Vector4d jump = (to - from) * (width * width);
    const Eigen::Vector4d bend = (to + from) * (0.5 * width * width);
    const double weight = stiffness * density * width;
    blocks[span] += weight * (jump * jump.transpose() + kBending * bend * bend.transpose());
    // Each block adds to the 4 by 4 entries of its control points; triplets at one place are summed.
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        entries.emplace_back(static_cast<int>(coefficient(last_knot_[span] - 3 + a)),
                             static_cast<int>(coefficient(last_knot_[span] - 3 + b)), blocks[span](a, b));
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  // Symmetric and banded; the stiffness keeps it regular where a span has no points.
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factored(matrix);
  const Eigen::MatrixX2d solution = factored.solve(right);
  for (Eigen::Index k = 0; k < size; ++k) controls_[static_cast<std::size_t>(k)] = solution.row(k).transpose();
}

Vec2 FittedSpline::sum(std::size_t span, const Weights& weights) const {
  Vec2 total = Vec2::Zero();
  for (int c = 0; c < 4; ++c) {
    total += weights[static_cast<std::size_t>(c)] * controls_[coefficient(last_knot_[span] - 3 + c)];
  }
  return total;
}

/// Each span as a cubic, by its ends and the second derivatives there, scaled to its own parameter.
void FittedSpline::make_spans() {
  const std::size_t spans = knots_.spans();
  std::vector<Vec2> ends;  // computed once for both spans that meet there: they meet to the last bit
  for (std::size_t span = 0; span < spans; ++span) ends.push_back(sum(span, basis(span, knots_.breaks[span])));
  ends.push_back(knots_.closed ? ends.front() : sum(spans - 1, basis(spans - 1, knots_.breaks.back())));
  for (std::size_t span = 0; span < spans; ++span) {
    const double width = knots_.breaks[span + 1] - knots_.breaks[span];
    const auto second = second_derivatives(span);
    spans_.push_back(CubicSpan::with_second_derivatives(
        ends[span], ends[span + 1], width * width * sum(span, second[0]), width * width * sum(span, second[1])));
  }
}

}  // namespace rollfix
