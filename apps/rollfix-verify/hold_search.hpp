#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "centre_tree.hpp"
#include "contact_arcs.hpp"
#include "document.hpp"

namespace rollfix_verify {

/// What an encoder's zero can be: intervals, counted modulo a period if that is above 0.
class Zeros {
 public:
  explicit Zeros(double period) : period_(period) {}

  bool is_empty() const { return known_ && known_->empty(); }
  /// What is in these as well is left.
  void keep(std::vector<Interval> others);

 private:
  double period_;
  std::optional<std::vector<Interval>> known_;  // nothing: any
};

/// Where a finger's contact is at one instant, on the part and in the world.
struct SeenFrom {
  double x = 0;  // on the part: no further than `reach` from here
  double y = 0;
  double world_x = 0;
  double world_y = 0;
  double reach = 0;  // with what the measured place may be off by
};

/// One wheel beside the part: whether its pin can be where it was, touching the part.
class PinLook {
 public:
  /// `turn`: of the tangent around the part, 0 of an open one.
  PinLook(const Boundary& boundary, const HeldWheel& wheel, double turn);

  const HeldWheel& wheel() const { return wheel_; }
  const CentreTree& path() const { return path_; }
  double period() const { return period_; }

  /// Whether the wheel may touch for some heading within `half` of the middle one. Adds what its encoder's zero can be.
  bool may_touch(const SeenFrom& from, std::size_t instant, double heading, double half, std::vector<Interval>& zeros);

 private:
  struct Question;
  /// Headings within `half` of the middle one, halved where that is too wide.
  bool look(Question& question, double heading, double half);
  /// Whether the path comes within reach of a point of the part.
  bool is_near(double x, double y, double reach);
  /// Whether a stretch has a tangent with which the line between contact and pin is as measured.
  bool suits(const Question& question, double heading, double half, const CentreTree::Node& node) const;

  const HeldWheel& wheel_;
  CentreTree path_;
  double period_ = 0;  // of the encoder's zero, radians; 0 of an open outline
  double rounding_ = 0;
};

/// First contacts, of each finger with skin on some arc.
using HeldSet = std::vector<Interval>;

/// What came of a search.
struct HoldCovered {
  std::size_t boxes = 0;      // that were looked at
  std::size_t undecided = 0;  // of the smallest size, that nothing excludes
  std::size_t open = 0;       // in what is left open
  std::vector<double> first_undecided{};

  /// So much was undecided that the rest was not looked at.
  bool is_cut_short() const { return undecided >= kMostUndecided; }
  static constexpr std::size_t kMostUndecided = 100;
};

/// Whether all first contacts that fit at every instant are in some sets: halves boxes of first contacts until each is
/// excluded at some instant, or inside one of those.
class HoldSearch {
 public:
  /// REQUIRES fingers with the same instants as the wheels.
  HoldSearch(BoundaryArcs& boundary, const std::vector<HeldFinger>& fingers, std::deque<PinLook>& wheels,
             std::vector<HeldSet> listed, std::vector<HeldSet> open);

  HoldCovered run();

 private:
  using Nodes = std::vector<int>;  // of each finger's first contacts

  /// Looks at a box and its halves.
  void visit(const Nodes& box);
  /// All of the box is in one of these sets.
  bool is_in(const std::vector<HeldSet>& sets, const Nodes& box) const;
  /// False: no first contacts of the box fit, for certain.
  bool may_fit(const Nodes& box);
  /// The part's headings at an instant, unwrapped; nothing: none is left.
  std::optional<Interval> headings(const Nodes& box, std::size_t instant);
  /// What the chord between two fingers' contacts leaves of the headings.
  bool keep_chord(const Nodes& box, std::size_t instant, std::size_t one, std::size_t other, double base,
                  Interval& offsets);
  /// Whether all wheels can touch at these headings.
  bool may_touch(const Nodes& box, std::size_t instant, const Interval& heading, std::vector<Zeros>& zeros);
  void add_undecided(const Nodes& box);

  BoundaryArcs& boundary_;
  const std::vector<HeldFinger>& fingers_;
  std::deque<PinLook>& wheels_;
  std::vector<HeldSet> listed_;
  std::vector<HeldSet> open_;
  std::deque<FirstContacts> contacts_;  // of each finger
  std::vector<std::size_t> order_;      // instants
  double rounding_ = 0;
  HoldCovered covered_;
};

}  // namespace rollfix_verify
