#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "box_search.hpp"
#include "hold_fit.hpp"
#include "rollfix/hold.hpp"

// With noise: the posterior of first contacts, from the boxes that are left to the places of the answer.
namespace rollfix::hold {

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

}  // namespace rollfix::hold
