#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "cell_search.hpp"
#include "free_space.hpp"
#include "measured.hpp"
#include "pose_fit.hpp"
#include "posterior.hpp"
#include "problem.hpp"
#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Where a contact is in a pose that it need not fit.
TouchContact nearest_contact(const PoseFit& fit, const Pose& pose, std::size_t touch);

/// The share of its tolerance that the worst residual takes.
/// 1 or less means that all of them are within their tolerances.
double worst_of(const PoseFit& fit, const FittedPose& fitted);

/// Intervals of x, y and the heading, in radians.
using PoseExtent = std::array<Interval, 3>;

/// Around all poses that have their first two contacts on one of the cells; the heading is unwrapped about that of
/// `about`.
/// An outer bound: poses of the box need not fit.
PoseExtent extent_of(const PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair, const Pose& about);

/// Around the nodes of a mode, each with its own spread.
PoseExtent extent_of(const PoseMode& mode, const std::vector<PosteriorNode>& nodes, const Pose& about);

/// Whether a pose is in an extent, or no further from it than these; modulo turns.
bool holds(const PoseExtent& extent, const Pose& pose, double place = 0, double turn = 0);

/// Arcs of the boundary that the first touch's nodes of cells cover. `tree`: its own.
std::vector<Interval> places_of(const PathTree& tree, const std::vector<Cell>& cells);

/// A fitted pose as the answer has it, with all that cells say of its set: extent, and whether it is a continuum.
TouchPose described(const PoseFit& fit, const FittedPose& fitted, const std::vector<Cell>& cells,
                    const TouchPair& pair);

/// Adds what the posterior knows of a mode.
/// REQUIRES a mode with nodes.
void add_posterior(TouchPose& pose, const PoseMode& mode, const std::vector<PosteriorNode>& nodes);

// What hangs together, from coarse cells to finer ones, for what a search straight to the finest would not end of; and
// the poses in it, without noise each with a witness, with noise by how probable they are.

/// What every step after the search for cells looks at.
struct Asked {
  const TouchProblem& problem;
  PoseFit& fit;
  TouchPair pair;
  FreeSpace& free;
  PlaceKnown place;  // what the contacts tell of the part's place
};

/// Cells that hang together, with the pose that fits best.
struct PoseSet {
  FittedPose fitted;
  std::vector<Cell> cells;
  PoseMode mode{};  // with noise
};

std::vector<Cell> cells_of(const CellSets& sets, const std::vector<std::size_t>& groups);

/// Adds a set to those with another pose. One pose can have several: of touches near a bump more than one place fits.
void add_set(const Asked& asked, PoseSet set, std::vector<PoseSet>& to);

/// Poses are one where they differ by less than this: a share of the least standard deviation, or tolerance, of a
/// place.
double least_difference(const std::vector<Measured>& contacts);

/// Cells that are cut no finer: they are a continuum, which so many show. To weigh each of them takes longer.
inline constexpr std::size_t kEnoughCells = 20000;
inline constexpr std::size_t kEnoughToWeigh = 4000;

/// Cells that fit, how fine they are, and comparisons of a search for finer ones that did not end.
struct LevelCells {
  Cells cells;
  double leaf = CellSearch::kLeaf;
  std::size_t abandoned = 0;
};

/// Cells down to the leaf of the tolerances. Measurements may be so exact that a continuum of poses would have too many
/// such cells: then they stay coarser, so many being enough. That can be of rolls; of touches alone the leaf is tried
/// first. `search`: the one that has found them.
LevelCells search_levels(std::optional<CellSearch>& search, const AllContacts& contacts, const TouchPair& pair,
                         std::size_t budget, std::size_t enough);

/// Sets of cells of one fineness.
struct LevelSets {
  CellSets sets;
  double leaf = CellSearch::kLeaf;
};

/// What hangs together of the cells that no path blocks. Of coarser ones sets with few, next to what was enough of them
/// all, are cut finer, so that a pose beside a continuum is told from it; as far as the budget goes.
std::vector<LevelSets> cut_sets(const Asked& asked, CellSearch& search, LevelCells from, std::size_t enough);

/// Sets of all levels.
CellSets together(std::vector<LevelSets> levels);

/// Without noise: sets of poses that hold one that is known to fit, and what is left.
struct WitnessedPoses {
  std::vector<TouchPose> poses;  // by their headings
  std::vector<Cell> without;     // of sets of which it is not known whether any of their poses fits
  std::vector<Cell> undecided;   // where the budget ran out
};

/// Looks in every set of cells for a pose that fits all contacts. Sets without one are searched again, finer; they go
/// where it is proved that none does.
WitnessedPoses witnessed_poses(const Asked& asked, CellSearch& search, const std::vector<LevelSets>& levels);

/// Whether what is known of the pose beforehand says where the part is.
bool knows_place(const TouchProblem& problem);

/// The posterior by one touch that has a place, or by several at one place without normals, and by what is known
/// beforehand: the nodes of a group hang together. REQUIRES that it knows the place.
std::vector<PosteriorNode> nodes_by_prior(const Asked& asked);

/// The posterior as a list of poses.
struct WeighedPoses {
  std::vector<TouchPose> poses;        // the most probable first
  std::optional<TouchFit> fit;         // of the one that fits best
  std::size_t improbable = 0;          // sets that are not listed, ...
  double rest = 0;                     // ... and their probability
  std::optional<double> log_evidence;  // but for what rolls say of themselves, and contacts' own places
  bool is_too_long = false;            // so many places that they were not weighed
};

/// The most probable first; those that are as probable, as of a symmetric part, by their headings.
void put_in_order(std::vector<TouchPose>& poses);

/// The boundary's length as far as the finger gets to it, of a corner that of the finger's arc around it.
double length_in_reach(const CentrePath& path);

/// With noise: what is less probable than a bound is not looked at, and modes that end in one pose are one.
WeighedPoses weighed_poses(const Asked& asked, const CellSets& sets, std::size_t budget);

/// By one touch and what is known of the pose beforehand.
WeighedPoses weighed_by_prior(const Asked& asked);

/// Solves a problem in which every touch counts.
using SolveCounted = std::function<void(const TouchProblem&, TouchAnswer&)>;

/// The poses if any touch may be an outlier, and the verdict is yet to be made. REQUIRES noise, and two contacts or
/// more.
/// `solve_counted` is called for each set of outliers with the other touches; it gets an answer with part, touches,
/// radius and noise.
void solve_with_outliers(const TouchProblem& problem, const SolveCounted& solve_counted, TouchAnswer& answer);

/// Whether chance makes so many touches outliers less than once in a thousand times.
bool has_many_outliers(const TouchAnswer& answer);

/// Poses by several sets of touches, each the weighed mean of what the sets say.
class PoseMixture {
 public:
  /// The poses that all touches but the `outliers` leave, ascending, and the weight of all of them together.
  void add(std::vector<TouchPose> poses, const std::vector<std::size_t>& outliers, double log_weight);

  /// Puts those that are probable enough into the answer, with contacts of all touches. `log_total`: of all weights.
  void finish(const TouchProblem& problem, double log_total, TouchAnswer& answer);

 private:
  std::vector<TouchPose> poses_;     // `probability`: among those of the same set
  std::vector<double> log_weights_;  // of the set
};

/// A pose that stands for those about it.
struct LikelyPose {
  std::size_t placement = 0;  // its number in the answer; after one touch any
  double weight = 0;          // of all together 1
  Pose pose;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of x, y, heading
};

/// The poses that an answer leaves: of each set one, of a continuum several along it; after one touch, which fits all
/// along the boundary, a sample of all of them.
std::vector<LikelyPose> likely_poses(const TouchAnswer& answer);

/// Whether the pose of a set is in its extent. With noise it is the one that fits best, which may be another set's.
bool is_own(const TouchPose& pose);

/// Every set of poses within the tolerances, with noise those that its search starts from, that is in the extent of
/// none of these (whose own pose is in it): nothing is weighed, and nothing is left out as improbable or in the way.
/// A set of which it is not known whether a pose of its fits has no contacts, and no pose.
/// `rolls`: beside the problem's touches, by their readings alone; they stand first in `tolerance`, of all contacts.
/// Where no contact has a place x and y of an answer are NaN.
/// REQUIRES a valid problem of two contacts or more, without noise where there are rolls, and without logs, prior and
/// clear paths.
TouchAnswer poses_beyond(const TouchProblem& problem, const std::vector<RollSearched>& rolls,
                         const std::vector<TouchTolerance>& tolerance, const std::vector<TouchPose>& known);

}  // namespace rollfix::touch

namespace rollfix {

/// Lengths that were given in another unit: by what they are to be multiplied, the unit that they are in, and the
/// part's.
struct MistakenUnit {
  double factor;
  const char* from;
  const char* to;
};
inline constexpr std::array<MistakenUnit, 6> kMistakenUnits = {{{25.4, "in", "mm"},
                                                                {1 / 25.4, "mm", "in"},
                                                                {10, "cm", "mm"},
                                                                {0.1, "mm", "cm"},
                                                                {1000, "m", "mm"},
                                                                {0.001, "mm", "m"}}};

}  // namespace rollfix

namespace rollfix::touch {

/// An explanation fits where chi-square is no less likely than this.
inline constexpr double kExplains = 0.01;

/// `solve` of a valid problem, without looking for mistakes.
TouchAnswer solve_plain(const TouchProblem& problem);

/// The usual mistakes, each tried: those without which the touches fit, the likeliest first.
std::vector<TouchDiagnosis> mistakes(const TouchProblem& problem);

/// Whether the part was moved between two rolls: those before fit together, those after do, and not all of them.
/// REQUIRES a problem with rolls, and its answer.
std::vector<TouchDiagnosis> moved(const TouchProblem& problem, const TouchAnswer& answer);

/// Radii of the finger with which touches fit that do not fit with the stated one, or with none stated. It is one
/// unknown more, so the touches have to say more than the pose takes. REQUIRES noise.
std::vector<TouchDiagnosis> other_radii(const TouchProblem& problem);

}  // namespace rollfix::touch
