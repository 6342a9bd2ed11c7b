#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"
#include "touch/cell_search.hpp"

// The least and the largest Theta on equal cells of the boundary. Whatever lies in a cell lies between its bounds, so
// that nothing that fits is lost; see docs/identify.md.
namespace rollfix::catalog {

// Rounding in single precision: of sums of a few turns, radians, and of lengths, as a share, as they occur in bounds.
inline constexpr double kTurnRounding = 2e-5;
inline constexpr double kShareRounding = 1e-6;

/// The nearest float that is no larger, and no smaller.
inline float float_below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded <= value ? rounded : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
}
inline float float_above(double value) { return -float_below(-value); }

/// Cells of a profile: of the one that is looked at first, and of those that are looked at where it leaves something.
/// Four cells of one lie in a cell of the one before.
inline constexpr std::size_t kCoarseCells = 16;
inline constexpr std::size_t kCells = 64;
inline constexpr std::size_t kFineCells = 256;

/// The least and the largest Theta on each of N equal cells of [0, P], radians, unwrapped, rounded outwards.
template <std::size_t N>
struct Profile {
  std::array<float, N> least;  // no larger than any Theta on the cell
  std::array<float, N> most;   // no smaller
};

/// Of the finest cells; the others follow from these by `coarser`.
Profile<kFineCells> profile_of(const Part& part);

/// What is known with a quarter of the cells.
Profile<kCells> coarser(const Profile<kFineCells>& fine);
Profile<kCoarseCells> coarser(const Profile<kCells>& cells);

/// Little-endian floats: the least of all cells, then the most; then a checksum of that.
std::string bytes_of(const Profile<kCells>& profile);
/// Nothing where the bytes are of another length, or are not what was written.
std::optional<Profile<kCells>> profile_from(std::string_view bytes);

/// A byte for each bound: how far it lies within those of its cell of 64, in 255ths of their distance, rounded
/// outwards; then a checksum of that.
std::string fine_bytes_of(const Profile<kFineCells>& fine, const Profile<kCells>& cells);
std::optional<Profile<kFineCells>> fine_profile_from(std::string_view bytes, const Profile<kCells>& cells);

/// The middles of equal cells of a part's boundary, in its frame, in single precision.
template <std::size_t N>
struct Middles {
  std::array<float, N> x;
  std::array<float, N> y;
};
/// Of all three sizes of cells: 2.7 kB.
struct CellPlaces {
  Middles<kCoarseCells> coarse;
  Middles<kCells> cells;
  Middles<kFineCells> fine;
};
CellPlaces places_of(const Part& part);

/// Where the centre of a round finger is while it touches a cell, and how the tangent points there.
struct CentreCell {
  Vec2 middle = Vec2::Zero();  // of a disc that holds the centres
  double radius = 0;
  double angle = 0;  // of the tangent, radians: at most half_turn from this
  double half_turn = 0;
};

/// Of each of N cells, by the tangent's angles in it and its middle. `radius`: the finger's; 0: a point.
template <std::size_t N>
std::vector<CentreCell> centre_cells(const Profile<N>& profile, const Middles<N>& middles, double perimeter,
                                     double radius);
extern template std::vector<CentreCell> centre_cells(const Profile<kCoarseCells>&, const Middles<kCoarseCells>&, double,
                                                     double);
extern template std::vector<CentreCell> centre_cells(const Profile<kCells>&, const Middles<kCells>&, double, double);
extern template std::vector<CentreCell> centre_cells(const Profile<kFineCells>&, const Middles<kFineCells>&, double,
                                                     double);

/// A reading, and how far it may be off.
struct Clue {
  PerFinger<double> length;            // L of each finger, in the catalog's unit
  double turn = 0;                     // theta, radians
  double length_slack = 0;             // of each length
  double turn_slack = 0;               // radians
  double turn_slack_by_curvature = 0;  // so much more, times the part's largest curvature
  double turn_sd = 0;                  // besides, an error that only this reading has: its squares are added up

  /// How far the turn may be off on a part with this largest |kappa|, radians, `turn_sd` aside.
  double slack(double most_curvature) const { return turn_slack + turn_slack_by_curvature * most_curvature; }
};

/// All readings of a roll together; none: nothing is known, and every part may be it.
struct Clues {
  std::vector<Clue> clues;         // far apart ones first
  std::optional<double> facing{};  // of two fingers, as LocateOptions has it
  double facing_slack = 0;
  double facing_slack_by_curvature = 0;
  std::size_t fingers = 1;
  double shared_sd = 0;  // besides, an error of the tangent at the start that all readings share
  double most_cost = 0;  // the squares of both, in standard deviations, may come to so much together
};

/// What a roll says to every part of a catalog, so that bounds can rule parts out.
struct RollClues {
  Clues few;   // some rows: for cells
  Clues many;  // more of them: for stretches of one part
};

/// For each way in which the roll may have gone, of which one has to fit; [0] on parts that are stored as they were
/// given, [1] on those that are stored reversed. Where nothing can be told, as with stray rows among them, there are no
/// clues.
/// `excess`: so many times the noise that was said is let pass.
std::array<std::vector<RollClues>, 2> clues_of(const Catalog& catalog, const Problem& like, double excess);

/// What one reading asks of the tangent at the start, as if its own error were none; and 1 / its variance.
template <typename Lanes>
struct Asked {
  Lanes least;  // tau is at least this, radians, ...
  Lanes most;   // ... and at most this
  typename Lanes::Scalar weight;
};

/// An interval of tangents at the start, and the standard deviation of an error that all readings share.
template <typename Lanes>
struct Start {
  Lanes least;
  Lanes most;
  typename Lanes::Scalar shared_sd;
};

/// Lower bounds on the sum of squares of all errors, in standard deviations, over all tangents at the start and all
/// shared errors; for several starts side by side. Where one is no more than `enough`, that is all that it says. As a
/// function of the two together, x, the sum is convex: its slope is bisected, and the bound is where two tangents of it
/// meet at worst.
template <typename Lanes>
Lanes least_cost(const Start<Lanes>& start, const std::vector<Asked<Lanes>>& asked, typename Lanes::Scalar enough) {
  using Scalar = typename Lanes::Scalar;
  // Of the slope's interval: more make the bound closer where it is near `enough`, and take time.
  constexpr int kHalvings = 12;
  // One parabola of x, 0 between least and most: convex, and so is the sum of all.
  const auto add = [](const Lanes& x, const Asked<Lanes>& one, Lanes& cost, Lanes& slope) {
    const Lanes miss = (x - one.most).max(Scalar(0)) - (one.least - x).max(Scalar(0));
    cost += one.weight * miss.square();
    slope += 2 * one.weight * miss;
  };
  const auto at = [&](const Lanes& x, Lanes& cost, Lanes& slope) {
    cost.setZero();
    slope.setZero();
    for (const Asked<Lanes>& one : asked) add(x, one, cost, slope);
    if (start.shared_sd > 0) {
      add(x, {start.least, start.most, 1 / (start.shared_sd * start.shared_sd)}, cost, slope);
    }
  };
  // Farther from the start's interval than this the shared error alone costs more than `enough`.
  const Scalar room = std::sqrt(enough) * start.shared_sd;
  Lanes lo = start.least - room;
  Lanes hi = start.most + room;
  Lanes cost_lo;
  Lanes cost_hi;
  Lanes slope_lo;
  Lanes slope_hi;
  at(lo, cost_lo, slope_lo);
  at(hi, cost_hi, slope_hi);
  // A convex function lies above its tangents. That at lo bounds it from below over all of [lo, hi], and so does that
  // at hi: the larger of both bounds holds.
  const auto bound = [&]() -> Lanes {
    const Lanes from_lo = cost_lo + (slope_lo < 0).select(slope_lo * (hi - lo), Lanes::Zero());
    const Lanes from_hi = cost_hi - (slope_hi > 0).select(slope_hi * (hi - lo), Lanes::Zero());
    return from_lo.max(from_hi);
  };
  // Invariant: the minimum over [lo, hi] as it was first lies in the present one: the slope is below 0 at lo and not
  // below 0 at hi, or the end is the first one.
  for (int k = 0; k < kHalvings; ++k) {
    // Goes on only while some lane could still fall to `enough`: a value at an end at most `enough` settles that it
    // does, a bound above it that it does not.
    const bool may_be_less = ((cost_lo.min(cost_hi) > enough) && (bound() <= enough)).any();
    if (!may_be_less) break;
    const Lanes middle = lo + Scalar(0.5) * (hi - lo);
    Lanes cost;
    Lanes slope;
    at(middle, cost, slope);
    const auto rises = slope >= 0;
    hi = rises.select(middle, hi);
    cost_hi = rises.select(cost, cost_hi);
    slope_hi = rises.select(slope, slope_hi);
    lo = rises.select(lo, middle);
    cost_lo = rises.select(cost_lo, cost);
    slope_lo = rises.select(slope_lo, slope);
  }
  return bound();
}

/// Some of N equal cells of the boundary.
template <std::size_t N>
using Cells = std::bitset<N>;

/// What bounds need to know of a part besides its profile.
struct Course {
  float perimeter = 0;       // in the catalog's unit
  float period_turn = 0;     // turn of a lap, radians: 2 pi of a simple closed outline
  float most_curvature = 0;  // the largest |kappa|
  bool closed = true;
};

/// The cells in which the roll can have started, of those within these larger ones. None is left out in which all the
/// readings fit within their slack, with one tangent at the start. Of two fingers: in which finger a can have.
template <std::size_t N>
Cells<N> cells_left(const Profile<N>& profile, const Course& course, const Clues& clues, const Cells<N / 4>& within);

extern template Cells<kCoarseCells> cells_left(const Profile<kCoarseCells>&, const Course&, const Clues&,
                                               const Cells<kCoarseCells / 4>&);
extern template Cells<kCells> cells_left(const Profile<kCells>&, const Course&, const Clues&,
                                         const Cells<kCoarseCells>&);
extern template Cells<kFineCells> cells_left(const Profile<kFineCells>&, const Course&, const Clues&,
                                             const Cells<kCells>&);

/// Whether one finger's roll can have started anywhere in these cells: they are halved, with bounds from the part
/// itself, until nothing is left or halves are not worth looking at any more.
bool may_start(const Part& part, const Clues& clues, const Cells<kFineCells>& cells);

}  // namespace rollfix::catalog

namespace rollfix {

/// What all parts of a catalog are asked first, side by side in memory: 660 bytes a part, and its name.
struct Catalog::Index {
  std::vector<catalog::Course> courses;                         // in the catalog's order, as all of these
  std::vector<catalog::Profile<catalog::kCoarseCells>> coarse;  // Theta on 16 cells
  std::vector<catalog::Profile<catalog::kCells>> cells;         // Theta on 64 cells
  std::vector<std::uint8_t> measured;  // its outline is not exact: bounds on it say nothing certain
  /// Read from the file.
  std::function<std::vector<catalog::Profile<catalog::kFineCells>>(const std::vector<std::size_t>& parts)> fine;
  /// Of touches: of the part itself, when it is first asked for.
  std::function<catalog::CellPlaces(std::size_t part)> places;
};

}  // namespace rollfix

namespace rollfix::catalog {

/// The parts that are asked for, by their places in the catalog.
std::vector<std::size_t> parts_of(const Catalog& catalog, const IdentifyOptions& options);

/// A part that is left, and where on it the roll can have started, of each way in which it may have gone: without cells
/// not that way. Nothing of any way: nothing is known.
struct PartLeft {
  std::size_t part = 0;  // its place in the catalog
  std::vector<Cells<kFineCells>> cells{};
};

/// Rules out parts of a catalog on which a roll can't have been: from ever finer cells, then from stretches of the
/// part.
class Bounds {
 public:
  /// `excess`: with so many times the noise.
  Bounds(const Catalog& catalog, const Problem& like, double excess);

  /// Those of the parts that are left. Throws InputError: it was told to stop, or the file is damaged.
  std::vector<PartLeft> left_of(const std::vector<std::size_t>& parts, const IdentifyOptions& options) const;

 private:
  /// A part that was not ruled out yet: the cells that are left, of each way.
  struct Candidate {
    std::size_t part = 0;
    std::vector<Cells<kCells>> cells;
  };

  std::vector<Candidate> candidates(const std::vector<std::size_t>& parts, const IdentifyOptions& options) const;
  /// From what is in memory. False: it can't be it.
  bool look_in_memory(Candidate& candidate) const;
  /// From finer cells and from the part itself; nothing: it can't be it.
  std::optional<PartLeft> look_closely(const Candidate& candidate, const Profile<kFineCells>& fine) const;
  /// The clues that hold on a part, by whether it is stored reversed.
  const std::vector<RollClues>& ways_on(std::size_t part) const;

  const Catalog& catalog_;
  const Catalog::Index& index_;
  std::array<std::vector<RollClues>, 2> clues_;  // [0]: of parts stored as they were given; [1]: reversed
};

/// Rules out parts of a catalog that touches can't be of, by cells of their boundaries.
class TouchBounds {
 public:
  /// REQUIRES that the problem is valid of some part, which does not matter.
  TouchBounds(const Catalog& catalog, const TouchProblem& like);

  /// Those of the parts that are left. Throws InputError: it was told to stop, or the file is damaged.
  std::vector<std::size_t> left_of(const std::vector<std::size_t>& parts, const IdentifyOptions& options) const;

 private:
  const Catalog& catalog_;
  std::vector<touch::Measured> touches_;  // those with a place, as the search takes them
  touch::TouchPair pair_;                 // two of them, whose cells are compared first
  double radius_ = 0;                     // of the finger; 0: a point
};

}  // namespace rollfix::catalog
