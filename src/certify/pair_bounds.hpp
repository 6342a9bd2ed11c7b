#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "locate/pair/plane_curve.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix::certifying {

/// The tangent's angles at all contacts of one finger while its first contact moves along a stretch, or while it
/// pivots there.
struct ContactStretch {
  double lo = 0;  // first contacts
  double hi = 0;
  bool pivot = false;
  std::vector<Range> angle;  // from the one at lo to the one at hi; of a pivot all that there are
  std::vector<double> from;  // at lo
  std::vector<double> to;    // at hi
  std::vector<Range> rate;   // curvatures in between

  /// Arc length; of a pivot the few steps around the corner.
  double width() const { return hi - lo; }
  /// The contact that pivots: whose range is the widest.
  std::size_t widest() const;
  /// How far a contact turns from end to end; of a pivot the one that pivots.
  double turn(std::size_t contact) const;
  /// What a sum of the angles is, each with its weight.
  Range sum(const std::vector<double>& weights) const;
  /// The same as the straight way from the one end to the other, which it leaves by no more than `off`.
  struct Chord {
    double from = 0;
    double to = 0;
    double off = 0;
  };
  Chord chord(const std::vector<double>& weights) const;
};

/// All contacts of one finger along the boundary, in the search's own numbers: what the cells of a certificate of two
/// fingers are drawn up by.
class ContactCurve {
 public:
  ContactCurve(const Part& part, std::vector<double> lengths);

  enum class Cuts { corners, bends };  // bends: and where the curvature jumps

  /// All first contacts from lo to hi, cut where a contact comes to a corner.
  const std::vector<ContactStretch>& over(double lo, double hi, Cuts cuts = Cuts::corners);

  /// The angle of each contact.
  /// Radians, unwrapped; at a corner before it or after it.
  std::vector<double> angles(double s, Side side) const;

 private:
  /// A first contact that brings a contact to a corner.
  struct Event {
    double s = 0;
    std::size_t contact = 0;
    double turn = 0;  // of the corner, radians; 0 at a bend
    bool concave = false;
    bool is_corner = false;
  };

  std::vector<Event> events(double lo, double hi, Cuts cuts) const;
  Range curvatures(double lo, double hi) const;
  ContactStretch smooth(double lo, double hi) const;
  std::vector<ContactStretch> at_corner(double lo, double hi, const std::vector<Event>& events) const;

  const Part& part_;
  std::vector<double> lengths_;  // of each contact from the first one, 0 among them
  std::vector<double> bends_;    // where the curvature jumps
  std::map<std::tuple<double, double, Cuts>, std::vector<ContactStretch>> known_;
};

/// First contacts of finger a and of finger b.
using PairBox = std::array<Interval, 2>;

/// Pairs along which both fingers' contacts move by the same arc length: from (s, t) on by `length`, finger b ahead as
/// well (`way` 1) or against it (-1).
struct PairLine {
  double s = 0;
  double t = 0;
  int way = 1;
  double length = 0;  // of a lap: it goes round
};

/// How far two fingers' equations are off, in the search's own numbers: f_k of each reading, then the facing's.
class PairBounds {
 public:
  PairBounds(const Part& part, const std::vector<Reading>& readings, const std::optional<double>& facing);

  std::size_t count() const { return turns_.size() + (facing_ ? 1 : 0); }

  /// Of each equation what it is off by at a pair.
  std::vector<double> off(double s, double t) const;

  /// At every pair in a box some equation is off by more.
  double bound(const PairBox& box);

  /// The same of the tolerance, as far as some halvings tell.
  bool are_apart(const PairBox& box, double tolerance);

  /// Boxes around all that may fit in a box, where equations are planes to some tolerances, or where it is beside a
  /// line of pairs that fit. Nothing: it can't be told.
  std::optional<std::vector<PairBox>> remains(const PairBox& box, double tolerance, const PairLine* line);

  /// How much an equation changes at the most while a finger's first contact moves, or pivots, in a range; of what
  /// pivots change, this share.
  double change(const Interval& side, std::size_t finger, double share_of_pivots = 1);

  /// From the least to the largest that its part of an equation is anywhere in a range.
  double spread(const Interval& side, std::size_t finger);

  /// How much there is to be gained by halving that range.
  double use_of_halving(const Interval& side, std::size_t finger);

  /// Exactly one pair in a box solves some two equations (all, where there are two), all that is within the tolerance
  /// is inside of it.
  bool has_one_root(const PairBox& box, double tolerance);

 private:
  using Weights = std::vector<double>;
  /// The first and the last number of whole turns that the facing may be off by.
  using Turns = std::pair<int, int>;

  /// From weights of the equations to weights of a finger's contacts, the first contact's at the front.
  Weights contact_weights(const Weights& weights) const;
  /// What a weighted sum of the equations must be equal to: readings' turns and the facing, `turns` whole turns added.
  double right_side(const Weights& weights, int turns) const;
  Weights unit(std::size_t row) const;
  /// Bounds on a weighted sum of all equations, over all pairs of two stretches, radians.
  Range combined(const ContactStretch& a, const ContactStretch& b, const Weights& weights, int turns) const;
  /// Which whole turns the facing may be off by on two stretches; {0, 0} without a facing.
  Turns turns(const ContactStretch& a, const ContactStretch& b) const;
  double bound(const ContactStretch& a, const ContactStretch& b) const;
  double bound(const ContactStretch& a, const ContactStretch& b, int turns) const;
  bool has_one_root(const ContactStretch& a, const ContactStretch& b, std::array<std::size_t, 2> rows,
                    double tolerance) const;
  bool has_one_root(const PairBox& box, std::array<std::size_t, 2> rows, double tolerance);
  bool is_apart(const PairBox& box, double tolerance, int& budget);
  /// Where all equations are within the tolerance, if they are planes there; nothing: they are not.
  std::optional<Polygon> flat_part(const ContactStretch& a, const ContactStretch& b, double tolerance) const;
  std::optional<Polygon> part_beside(const ContactStretch& a, const ContactStretch& b, double tolerance,
                                     const PairLine& line);
  /// Adds the box around what may fit; false: that can't be told.
  bool add_remains(const ContactStretch& a, const ContactStretch& b, double tolerance, const PairLine* line,
                   std::vector<PairBox>& remains);

  std::array<ContactCurve, 2> curves_;
  std::vector<double> turns_;  // theta of each reading, radians
  std::optional<double> facing_;
  double period_;  // P
  bool closed_;
};

/// A placement as the cover sees it.
struct CoveredPair {
  const Placement* placement = nullptr;
  std::optional<PairBox> box;    // holds all that belongs to it; none: the cells that are left near it do
  bool has_cell = false;         // one that holds its start; of one without a box
  std::optional<PairLine> line;  // of a family: all of it fits
};

/// Halves a box of pairs until some equation is off on each part of it, or the part is in a placement's box. What can't
/// be told apart any further goes to a placement without a box that it is near to.
class PairCover {
 public:
  PairCover(const Part& part, PairBounds& bounds, double tolerance, std::vector<CoveredPair>& pairs)
      : part_(part), bounds_(bounds), tolerance_(tolerance), pairs_(pairs) {}

  /// As text: docs/certificates.md.
  std::string cells(const PairBox& whole);

 private:
  struct Cell {
    PairBox box;
    std::string token;      // of a leaf; "s", "t": halved
    std::size_t first = 0;  // of its halves
  };

  /// The claim for a box that needs no halving: an exclusion, or a placement. Empty: it must be halved.
  std::string settled(const PairBox& box);
  std::optional<std::size_t> owner(const PairBox& box);
  bool belongs(const PairBox& box, std::size_t family);
  bool is_of(const PairBox& set, const CoveredPair& pair) const;
  bool meets(const PairBox& one, const PairBox& two, double room) const;
  bool holds_start(const PairBox& box, const Placement& placement) const;
  /// The claim for a box that is not halved any further.
  std::string left_over(const PairBox& box);
  /// No equation changes by more than a share of the tolerance: halving tells nothing new.
  bool is_flat(const PairBox& box);
  bool is_inside(const PairBox& inner, const PairBox& outer) const;
  bool is_near(const PairBox& box, const Placement& placement) const;
  /// Shares of a way, one for each of three laps.
  using Shares = std::array<Interval, 3>;
  Shares shares_near(const Interval& way, double place, double reach) const;
  bool is_near_line(const PairBox& box, const Placement& placement, double reach) const;
  /// The tree from this node on, before its halves: `s` or `t`, then the lower half, then the upper one.
  void write(std::size_t cell, std::string& text) const;

  const Part& part_;
  PairBounds& bounds_;
  double tolerance_;
  std::vector<CoveredPair>& pairs_;
  std::vector<Cell> cells_;
};

}  // namespace rollfix::certifying
