#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "boundary.hpp"
#include "centre_tree.hpp"

namespace rollfix_verify {

/// How far a roll had gone along the outline, and turned with it, radians.
struct RollReading {
  Ball length;
  Ball turn;
};

/// Where on the boundary a roll can have started by its readings alone: all of them within a tolerance at once, with
/// one tangent where the finger pivots at the start.
class RollStarts {
 public:
  /// On all contacts of a node of centres: how far readings may be from what they are on it is told for certain.
  struct On {
    bool may_start = true;  // false: at none of them
    bool all_start = false;
    double spread = 0;  // of what decides it, in tolerances: halving the node makes it less
  };

  /// `tree`: of the finger's centres, on whose nodes it is asked; outlives this, as `boundary` does.
  RollStarts(const Boundary& boundary, const CentreTree& tree, std::vector<RollReading> readings, double tolerance);

  const On& on(int node);
  /// Whether it can have started at this place with a tangent of this angle (in the outline's own frame), as far as
  /// places are stated.
  bool may_start(const Place& place, const Ball& direction) const;

 private:
  /// Computes `on`.
  On look(const CentreTree::Node& node) const;
  /// A reading's f over a node by its slope; none: not known.
  std::optional<Ball> by_slope(const CentreTree::Node& node, const RollReading& reading) const;
  std::optional<std::vector<Ball>> ends(const Ball& from, const Ball& to, const Ball& length) const;
  std::optional<Place> clear_of_joints(const Ball& s, int way) const;
  /// All rolls from between two places end beyond an open outline.
  bool leaves(const Ball& from, const Ball& to, const Ball& length) const;

  const Boundary& boundary_;
  const CentreTree& tree_;
  std::vector<RollReading> readings_;
  double tolerance_;
  double period_;
  Ball base_;  // the tangent's angle at s = 0
  std::vector<std::optional<On>> known_;
};

// ---- poses ----

/// A touch in the world, or a roll's first contact, and how far it may be off.
struct SoughtTouch {
  double x = 0;  // of the finger's centre
  double y = 0;
  bool has_place = true;            // false: where the centre was is not known
  std::optional<double> tangent{};  // of the part in the world, radians; none: not measured
  double length = 0;                // tolerances: of the centre, ...
  double angle = 0;                 // ... and of the tangent, radians
  RollStarts* starts = nullptr;     // of a roll: where it can have started; not owned
};

/// Poses: x, y and the heading, in radians. Where no contact has a place, x and y are 0 and tell nothing.
using PoseBox = std::array<Interval, 3>;

/// All poses whose contact of one touch is on some arcs.
struct LeftOpen {
  std::size_t touch = 0;
  std::vector<Interval> arcs;
};

/// What came of a search.
struct Covered {
  std::size_t boxes = 0;      // that were looked at
  std::size_t undecided = 0;  // of the smallest size, of which it is not known whether they hold a pose that fits
  std::size_t open = 0;       // in what is left open
  std::optional<std::array<double, 3>> unlisted{};  // a pose that fits and is nowhere listed

  /// So much was undecided that the rest was not looked at.
  bool is_cut_short() const { return undecided >= kMostUndecided; }
  static constexpr std::size_t kMostUndecided = 1000;
};

/// Whether every pose that fits all touches is in one of some boxes: halves boxes of poses until each holds none that
/// fits, or is inside one of those.
class PoseSearch {
 public:
  /// REQUIRES a tree that is not empty, and a touch.
  PoseSearch(CentreTree& tree, std::vector<SoughtTouch> touches, std::vector<PoseBox> listed,
             std::optional<LeftOpen> open);

  Covered run();

 private:
  // Lists of nodes on a stack, one for each touch, on which its contact can be.
  using List = std::pair<std::size_t, std::size_t>;
  struct View;

  /// Looks at a box and its halves. `lists`: of the larger box.
  void visit(const PoseBox& box, const std::vector<List>& lists);
  View view(const PoseBox& box) const;
  /// Shortens a touch's list to the nodes that may hold its contact; false: none does.
  bool narrow(const View& view, std::size_t touch, List& list);
  /// Whether a node may hold a touch's contact in some pose of the box.
  bool may_hold(const View& view, std::size_t touch, const CentreTree::Node& node) const;
  /// In tolerances of the touch.
  double node_size(std::size_t touch, const CentreTree::Node& node) const;
  /// Headings that contacts without a place leave.
  void add_headings(const Interval& headings, const std::vector<List>& lists, std::vector<Interval>& left);
  static bool holds_heading(const PoseBox& box, const View& view);
  /// All poses of the box are in one listed extent.
  bool is_listed(const View& view) const;
  bool is_open(const List& list) const;
  /// The box's middle fits all touches for certain.
  bool fits_in_the_middle(const View& view, const std::vector<List>& lists);
  bool fits_on(const View& view, std::size_t touch, int index);
  bool fits_all_on(const View& view, std::size_t touch, int index);
  std::array<double, 2> sizes(const View& view) const;

  CentreTree& tree_;
  std::vector<SoughtTouch> touches_;
  std::vector<PoseBox> listed_;
  std::optional<LeftOpen> open_;
  double x_ = 0;  // the place in the world by whose place on the part boxes are told
  double y_ = 0;
  double rounding_ = 0;       // what doubles may make of compared lengths
  std::vector<int> stack_;    // lists of nodes, those of the smallest box on top
  std::vector<int> waiting_;  // nodes to be looked at
  Covered covered_;
};

}  // namespace rollfix_verify
