#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "arc_tree.hpp"
#include "box_search.hpp"
#include "fingers_apart.hpp"
#include "held_rows.hpp"
#include "hold_fit.hpp"
#include "rollfix/hold.hpp"
#include "weigh_holds.hpp"

namespace rollfix::hold {

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

}  // namespace rollfix::hold
