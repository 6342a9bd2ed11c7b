#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "belief/two/pair_density.hpp"

// Notation:
//   w               (w_a, w_b); F: information on it at a peak, `score.information`
//   gap             from the passing before a place to the next after it, length: `Passings::gap`
//   heat            log-likelihoods are divided by it where the rows fit badly
// Follows docs/two_fingers.md, "The search", step 3.
// Idea: the squares of a density are turned and scaled by F. Between passings F is 0 on flat sides, though the density
// ends at them: a gap counts as information there, and the square begins in its middle.
namespace rollfix::belief {

namespace {

// Squares are no longer than this share of the boundary.
constexpr double kLongestSquare = 1.0 / 96;
// On either side of a gap the density ends within so many standard deviations of a contact.
constexpr double kEdge = 2;
// The middle of a gap is as good as a peak if its log-likelihood is no further below.
constexpr double kAsGood = 1;

/// On w, of a density that is constant in a gap: one square is as wide as the gap with its edges.
Eigen::Matrix2d information_of_gaps(const PairModel& model, const PairStart& start) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (const std::size_t finger : {0U, 1U}) {
    if (model.passings[finger] == nullptr) continue;
    const auto i = static_cast<Eigen::Index>(finger);
    const TiltedPlace place = start.arc[finger]->at(start.w[finger]);
    const double width = model.passings[finger]->gap(place.s).width() + 2 * kEdge * model.errors->contact_sd();
    information(i, i) = square(place.slope / width);
  }
  return information;
}

}  // namespace

/// The peak itself where no gap is wide, or where the middle is worse by kAsGood or more. `nodes`: all rows.
PairPeak between_passings(const PairModel& model, const PairPeak& peak, const std::vector<PairNode>& nodes,
                          double heat) {
  PairStart start = peak.start;
  for (const std::size_t finger : {0U, 1U}) {
    if (model.passings[finger] == nullptr) continue;
    const TiltedArc& arc = *start.arc[finger];
    const TiltedPlace place = arc.at(start.w[finger]);
    const Interval gap = model.passings[finger]->gap(place.s);
    // A narrow gap has no flat middle; in a corner (slope 0) w does not move s.
    if (!(gap.width() > kWide * model.errors->contact_sd()) || !std::isfinite(gap.width()) || place.slope <= 0)
      continue;
    // The middle of the gap, to first order in w.
    const double middle = start.w[finger] + (gap.middle() - place.s) / place.slope;
    if (middle > arc.lo() && middle < arc.hi()) start.w[finger] = middle;
  }
  if (start.w == peak.start.w) return peak;
  const PairPeak found{start, score_of(model, start, nodes, peak.score.errors, kPasses)};
  return (peak.score.log_likelihood() - found.score.log_likelihood()) / heat < kAsGood ? found : peak;
}

/// Columns are the axes of F + that of the gaps, each a standard deviation long (times `factor`), or `longest`.
Eigen::Matrix2d frame_of(const PairModel& model, const PairPeak& peak, double heat, double factor) {
  const double longest = kLongestSquare * std::min(span(*peak.start.arc[0]), span(*peak.start.arc[1]));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(peak.score.information / heat +
                                                              information_of_gaps(model, peak.start));
  Eigen::Matrix2d frame;
  for (const Eigen::Index i : {0, 1}) {
    // Rounding may leave an eigenvalue below 0: nothing is known along it.
    const double precision = std::max(0.0, solver.eigenvalues()[i]);
    const double step = std::min(longest, precision > 0 ? factor / std::sqrt(precision) : longest);
    frame.col(i) = step * solver.eigenvectors().col(i);
  }
  return frame;
}

}  // namespace rollfix::belief
