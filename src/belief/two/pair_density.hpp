#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "belief/posterior.hpp"
#include "belief/two/pair_filter.hpp"
#include "part/turning_range.hpp"

// Two fingers' posterior, step by step: where they can have started at all, the peaks there, the density around them,
// and the modes that it has.
namespace rollfix::belief {

// Cells of a table of Theta's ranges, per perimeter.
inline constexpr std::size_t kRangeCells = 8192;

/// A square of first contacts (s, t), in cells of a grid over both perimeters.
struct PairSquare {
  std::uint32_t i = 0;
  std::uint32_t j = 0;
};

/// Where the first contacts can be at all.
struct PairCandidates {
  std::vector<PairSquare> squares;
  std::uint32_t cells = 0;  // of the grid, along a perimeter
  double missed = 0;        // no more than this is the chance that the true ones are elsewhere, the noise being as said
};

/// Branch and prune over all pairs: a square is refused when no pair in it explains some rows, each of whose contacts
/// may lie anywhere within `sigmas` standard deviations of where it was felt. `resolution`: length of the squares.
PairCandidates pair_candidates(const PairModel& model, const TurningRange& range, const std::vector<PairNode>& nodes,
                               double sigmas, double resolution);

/// All squares there are: where even wide errors leave none.
PairCandidates all_squares();

/// A local maximum of the likelihood.
struct PairPeak {
  PairStart start;  // w of both first contacts
  PairScore score;
};

/// A step's worth of two first contacts on: w kept within an arc that is not a loop.
PairStart moved(const PairStart& start, const Eigen::Vector2d& by);

/// The likelihood's local maxima among the candidates, the likeliest first: Gauss-Newton (Levenberg 1944) from the
/// candidates that no neighbour of theirs surpasses, with some of the rows first and then with all.
std::vector<PairPeak> pair_peaks(const PairModel& model, const PairCandidates& candidates,
                                 const std::vector<PairNode>& nodes);

// A leaf has the square of so many.
inline constexpr int kGrainsAcross = 3;

// Passes through the rows for a square's score.
inline constexpr int kPasses = 4;

inline double span(const TiltedArc& arc) { return arc.hi() - arc.lo(); }

/// Where a peak's squares begin: the middle between the passings about it if that is as good, so that these are along
/// the squares' sides. `heat`: log-likelihoods are divided by it.
PairPeak between_passings(const PairModel& model, const PairPeak& peak, const std::vector<PairNode>& nodes,
                          double heat);

/// From a region's coordinates to (w_a, w_b): a square is `factor` standard deviations wide as far as that is known at
/// the peak, or as the gap between passings.
Eigen::Matrix2d frame_of(const PairModel& model, const PairPeak& peak, double heat, double factor = 1);

/// A point within a leaf, where its mass is summed.
struct PairGrain {
  std::array<double, 2> s{};      // of finger a and b, unwrapped from the region's origin on
  std::array<double, 2> angle{};  // of the tangents, unwrapped likewise
  double share = 0;               // of the posterior's mass
};

/// A little of the density: a square of a region's own grid, or a rectangle where it was halved.
struct PairLeaf {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // in the region's coordinates
  Eigen::Vector2d size = Eigen::Vector2d::Ones();    // of its sides, likewise
  PairStart start;
  PairScore score;
  double log_density = 0;  // by (w_a, w_b) with the prior on the boundary, up to a constant
  double share = 0;
  std::vector<PairGrain> grains;
};

/// A connected piece of what the density leaves, on a grid of its own, which is turned and scaled so that a square is
/// about a standard deviation wide: it spreads from a peak to wherever the density is not negligible.
struct PairRegion {
  PairStart origin;
  std::array<double, 2> origin_s{};                     // arc length there, unwrapped
  Eigen::Matrix2d frame = Eigen::Matrix2d::Identity();  // from the region's coordinates to (w_a, w_b)
  Eigen::Matrix2d back = Eigen::Matrix2d::Identity();
  std::vector<PairLeaf> leaves;                                           // in the order in which they were found
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> leaves_of;  // of each whole square
  std::vector<PairStart> beyond;  // where it leaves the half loop either way that it covers

  /// The leaf at these coordinates; none: leaves.size().
  std::size_t leaf_at(const Eigen::Vector2d& y) const;
  /// By (w_a, w_b); nothing where it is further than the region goes.
  std::optional<Eigen::Vector2d> off_origin(const PairStart& start) const;
  bool covers(const PairStart& start) const;
};

/// The posterior of two first contacts where it is not negligible.
struct PairDensity {
  std::vector<PairRegion> regions;
  double total = 0;  // its integral, as a share of the likeliest peak's density
  double rest = 0;   // a bound on the share of what was not resolved
};

/// Spreads from the peaks. `excess`: Fit::widened; log-likelihoods are divided by its square. `corner_length`: what a
/// radian of pivoting counts as, length, of each finger.
PairDensity pair_density(const PairModel& model, const std::vector<PairPeak>& peaks, const std::vector<PairNode>& nodes,
                         double excess, const std::array<double, 2>& corner_length);

struct PairModes {
  std::vector<Mode> modes;                     // the most probable first
  std::vector<std::vector<MassPiece>> pieces;  // of each, without those below kLeastShare
};

/// The connected pieces of a density: two peaks are two modes where it falls far enough on every way between them.
PairModes modes_of(const PairDensity& density, const PairModel& model, const Reading& last);

}  // namespace rollfix::belief
