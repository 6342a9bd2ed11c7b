#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "box_search.hpp"
#include "held_rows.hpp"
#include "hold_fit.hpp"
#include "rollfix/hold.hpp"

namespace rollfix::hold {

/// Whether fingers that touch the part somewhere would enter each other: where each is on the part follows from its
/// contact, with or without x and y. Disks, outlines and jaws, which have no ends; two jaws are not compared.
class FingersApart {
 public:
  /// Looks at some of the rows, spread over the logs.
  FingersApart(const HoldProblem& problem, const HeldRows& rows);

  /// Whether two of them enter each other at some instant wherever on these arcs their first contacts are. With noise
  /// arcs end at kPossibleSigmas standard deviations.
  bool must_overlap(const std::vector<Interval>& first_contacts) const;

 private:
  /// A finger as it lies on the part.
  struct Body;
  /// A finger at a row, with how far it can move while its first contact goes over an arc.
  Body body_at(std::size_t row, std::size_t finger, const Interval& first_contact) const;
  /// How deep two of them are in each other at least, wherever on their arcs they started, length.
  double depth(const Body& one, const Body& other) const;
  /// Two errors as one: with noise by the root of their squares, else their sum.
  double together(double one, double other) const;

  const HoldProblem& problem_;
  std::vector<HeldRow> rows_;                // those looked at
  std::vector<std::vector<double>> travel_;  // how far off a contact can be, of each row, of each finger
  std::vector<double> size_;                 // of each finger: how far its reference, of an outline its rim, is at most
                                             // from a contact
  bool has_noise_ = false;
  double radius_slack_ = 0;  // of two radii together, length; without noise 0
};

/// Throws InputError: two fingers enter each other by their own x and y, whatever the part does. `logs`: aligned; of
/// the fingers, then of the wheels. What has no x and y is not compared.
void require_apart(const HoldProblem& problem, const std::vector<Log>& logs);

/// The same of a finger and a wheel, and of two wheels, farther than they can be off.
void require_wheels_apart(const HoldProblem& problem, const std::vector<Log>& logs);

// With noise: the posterior of first contacts, from the boxes that are left to the places of the answer.

/// First contacts on a ridge of the posterior, and what is normally distributed about them.
struct HoldNode {
  HeldState state;
  double log_density = 0;  // by the length of the axis, everything else summed over
  double width = 0;        // of the axis, that it stands for
  UnknownsMatrix covariance;
};

/// A connected hump of the posterior.
struct HoldMode {
  HeldState best;
  std::vector<HoldNode> nodes;
  double log_weight = 0;   // logarithm of its probability but for a constant
  bool continuum = false;  // some direction is free, as far as its set goes
  std::size_t set = 0;     // of boxes
};

/// A set of boxes, as the posterior sees it.
struct HeldSet {
  std::vector<Interval> extent;    // of each finger's first contact
  std::vector<Interval> wheels{};  // of each wheel's
};

/// Where the fits ended, and in which sets.
struct Optimum {
  HeldState state;
  std::size_t set = 0;
};

/// Of each unknown the standard deviation that it has where no measurement determines it.
using Scale = Unknowns;

/// The inverse of an information matrix in which no direction is known worse than its scale, log det of what was
/// inverted, and how many directions were.
struct Inverse {
  UnknownsMatrix covariance;
  double log_determinant = 0;
  int free = 0;
};
Inverse inverse_within(const UnknownsMatrix& information, const Scale& scale);

/// log p at a state with these unknowns held: integrated over all others by Laplace's method. The covariance is of
/// those; the rows and columns of what is held are 0.
HoldNode node_at(const HoldFit& fit, const HeldState& state, const Held& held, const Scale& scale);

/// The posterior over a continuum of two dimensions and more: as many first contacts are held at each node, and nodes
/// are spread evenly over all that fits about a state.
struct HoldCloud {
  std::vector<HoldNode> nodes;
  std::vector<Interval> box;  // of each first contact that is held: everything in it was looked at
};
HoldCloud cloud_about(const HoldFit& fit, const Boundary& boundary, const HeldState& state, const Held& held,
                      const Scale& scale);

/// The posterior's modes about these optima: a ridge is followed along the first contact that is known worst, on each
/// of its places the rest is taken as normally distributed (Laplace's method).
std::vector<HoldMode> modes_about(const HoldFit& fit, const Part& part, std::vector<Optimum> optima,
                                  const std::vector<HeldSet>& sets);

/// The mode, once for each way the part may lie at the first and at the last row: HoldFit::poses_at_ends. Those that
/// noise does not tell apart are one.
std::vector<HoldMode> split_by_poses(const HoldFit& fit, const HoldMode& mode);

/// The mode as it is without some of its nodes, which are taken out; false: none is left.
bool keep_nodes(HoldMode& mode, const std::function<bool(const HoldNode&)>& is_possible);

/// Whether first contacts are in a set of boxes, by their extents.
bool is_within(const HeldSet& set, const HeldState& state, const Boundary& boundary, double slack);

// Places in a set from which a fit starts.
inline constexpr std::size_t kStarts = 8;

/// Boxes that hang together, with what was found in them.
struct FoundSet {
  std::vector<Box> boxes;
  HeldSet set;
};

/// The first contacts in the middle of one of a set's boxes, `look` of `looks` through it.
std::vector<double> middle_of_box(HoldBoxSearch& search, const FoundSet& found, std::size_t look, std::size_t looks);

/// How much is looked at: at a glance the likeliest place, by few starts, that may be missed.
enum class Care { full, glance };

/// With noise: the posterior over these sets, into the answer. `searched`: of the rows those that were searched with.
void weigh(const HoldProblem& problem, const HeldRows& rows, const HeldRows& searched,
           const std::vector<FoundSet>& found, HoldBoxSearch& search, const WheelPaths& wheels, Care care,
           HoldAnswer& answer);

/// A state as the answer has it: places at the first and the last instant, poses, residuals; extents of its set.
HoldPlacement described(const HoldFit& fit, const Part& part, const HeldState& state, const HeldSet& set);

/// Adds what the posterior knows of a mode, but for its probability.
void add_posterior(HoldPlacement& placement, const HoldFit& fit, const Part& part, const HoldMode& mode);

/// How well a state fits the noise.
TouchFit fit_of(const HoldFit& fit, const HeldState& state);

/// Throws InputError: a wheel that fits nowhere.
WheelPaths paths_of(const HoldProblem& problem);

/// The logs of the fingers, then those of the wheels, in the part's unit, at the instants that all of them share.
std::vector<Log> logs_of(const HoldProblem& problem);

/// Where each finger can touch: of disks, and of jaws beside wheels; nullptr for others. Fingers of one radius share
/// it.
class ReachOfFingers {
 public:
  explicit ReachOfFingers(const HoldProblem& problem);
  std::vector<const Reach*> each;  // of each finger; owned by this

 private:
  std::map<double, std::unique_ptr<Reach>> reaches_;  // by radius, of a jaw 0
};

/// A problem with what is searched in: rows, of them those that are searched with, and boxes of first contacts.
class HeldQuestion {
 public:
  /// `instants`: rows to search with, in the order in which they tell most. What is given has to outlive it.
  HeldQuestion(const HoldProblem& problem, HeldRows rows, const std::vector<std::size_t>& instants,
               const WheelPaths& wheels);

  const Part& part() const { return part_.part; }
  const HeldRows& rows() const { return rows_; }
  const HeldRows& searched() const { return searched_; }  // in the order of time
  const Reach* reach(std::size_t finger) const { return reach_.each[finger]; }
  HoldBoxSearch& search() { return search_; }

  /// Boxes that hang together.
  std::vector<FoundSet> sets(const std::vector<Box>& boxes);

 private:
  std::size_t wheels_;  // how many
  HeldRows rows_;       // all rows of the logs
  HeldRows searched_;   // those searched with
  HeldPart part_;
  ReachOfFingers reach_;
  HoldBoxSearch search_;
};

/// A set of first contacts, with some in it that fit.
struct WitnessedSet {
  HeldSet set;            // extents of its boxes
  HeldState state;        // the witness: every residual within its tolerance
  bool overlaps = false;  // all that fits in it has fingers in each other
};

/// Sets in which something fits, and boxes of which that is not known.
struct Witnessed {
  std::vector<WitnessedSet> sets;  // those that overlap included
  std::vector<Box> doubtful;       // as small as they get, with nothing found in them that fits
  std::vector<Box> undecided;      // where the budget ran out
};

/// Without noise: in every set first contacts that fit at all instants that are searched with; sets without are cut
/// smaller, until nothing of them is left or they are reported as doubtful. `fit`: of those instants. `apart`: null
/// where fingers may be in each other.
Witnessed witnessed(HeldQuestion& question, HoldFit& fit, Boxes boxes, const FingersApart* apart = nullptr);

// Logs as they would be without a mistake.

/// These rows of a log of one finger, in order.
Log with_rows(const Log& log, const std::vector<std::size_t>& rows);

/// Leaves rows out of all logs in which a finger jumps farther than is physical, and comes back. Which they were, as in
/// "b.csv, line 17". `logs`: aligned.
std::vector<std::string> leave_out_jumps(const HoldProblem& problem, std::vector<Log>& logs);

/// A mistake in how columns are read, in all logs or in one: what it is, and the problem without it.
struct Mended {
  HoldDiagnosis what;
  HoldProblem problem;
  double log_stretch = 0;  // logarithm of what the density of all measurements grows by with their numbers
};

/// Angles that count the other way or are in degrees, u and psi exchanged.
std::vector<Mended> without_column_mistakes(const HoldProblem& problem);
/// x and y exchanged.
std::vector<Mended> without_exchanged_axes(const HoldProblem& problem);
/// x and y in another unit.
std::vector<Mended> without_units(const HoldProblem& problem);
/// Fingers in another order.
std::vector<Mended> without_swaps(const HoldProblem& problem);

/// Lengths so many times as long, of all disks or of one: their radii; or the radius of a wheel. Nothing: there are
/// none.
std::optional<HoldProblem> with_lengths(const HoldProblem& problem, std::optional<std::size_t> whose, double scale);

/// Row k + `rows` of one log with row k of the others.
HoldProblem shifted(const HoldProblem& problem, std::size_t log, int rows);

/// All measurements noisier.
HoldProblem noisier(const HoldProblem& problem, double times);

/// Some rows of all logs, spread evenly, and angles unwrapped by all of them.
HoldProblem thinned(const HoldProblem& problem, std::size_t rows);

/// `solve` of a problem, without looking for mistakes. At a glance, of a problem with noise, nothing is proved.
HoldAnswer solve_plain(const HoldProblem& problem, Care care = Care::full);

/// The usual mistakes, each tried: those without which the logs fit, else those with which they fit far better, the
/// likeliest first. `as_said`: the answer as it is. Without noise logs are looked at as if they had a little.
std::vector<HoldDiagnosis> mistakes(const HoldProblem& problem, const HoldAnswer& as_said);

}  // namespace rollfix::hold
