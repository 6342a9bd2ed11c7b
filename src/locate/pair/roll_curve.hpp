#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <boost/container/vector.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "part/cursor.hpp"
#include "part/turning_range.hpp"
#include "range.hpp"
#include "rollfix/part.hpp"

namespace rollfix::locating {

/// What one finger adds to the equations: (8) and (9) say that two curves meet, A(s) of finger a and B(t) of finger b,
/// with the components Theta(s + L_k) - Theta(s) + shift_k, one for each reading, and with the facing equation one
/// more, Theta(s) + facing.
struct RollEquations {
  std::vector<double> lengths;   // L_k
  std::vector<double> shifts;    // added to each component, radians
  std::optional<double> facing;  // added to Theta(s)

  std::size_t rows() const { return lengths.size() + (facing ? 1 : 0); }
  std::size_t contacts() const { return lengths.size() + 1; }
  /// From the first contact to contact c.
  double length_to(std::size_t c) const { return c == 0 ? 0 : lengths[c - 1]; }
};

/// Bounds on a roll's components over stretches of the boundary that are not cut into pieces yet, from the tree over
/// the part's spirals: what is between two contacts' strips. Of a part with few spirals there are none, nor of one with
/// corners: where pivots make continua, an answer's start would hang on the order of the boxes.
class RollStrips {
 public:
  /// The spirals that a contact passes: of its first lap from 0 on, on the next one from their number on.
  struct Span {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
  };

  /// `range`: of first contacts.
  RollStrips(const Part& part, const RollEquations& equations, const Interval& range);

  bool is_empty() const { return !is_wanted_; }
  /// Of each contact while the first one is anywhere on the range.
  const std::vector<Span>& whole() const { return whole_; }
  /// How often a contact passes from one spiral to the next.
  std::size_t cuts(const Span* spans) const;
  /// Where the contact that passes most spirals is half way through them. `below` and `above`: the spans on both sides.
  double halve(const Span* spans, Span* below, Span* above) const;
  /// Of each component, wherever the first contact is in s.
  void bound(const Interval& s, const Span* spans, Range* values) const;

 private:
  class Walk;

  double joint(std::uint32_t index) const;
  double place_of(std::size_t contact, std::uint32_t index) const;
  std::uint32_t spiral_at(const Span& among, double base) const;
  Walk walk(std::size_t contact, double s, const Span& span) const;
  Range between(const Walk& start, const Walk* end, double lo, double hi) const;
  Range bound(const Interval& s, Walk start, Walk* end) const;

  const TurningFunction& turning_;
  const TurningTree& tree_;
  const RollEquations& equations_;
  bool is_wanted_;
  double same_place_;
  std::vector<double> offset_;   // from the first contact to each contact's place on its first lap
  std::vector<double> winding_;  // that lap, and ...
  std::vector<double> lift_;     // ... its turn, radians
  std::vector<Span> whole_;
};

/// A place on such a curve.
struct RollPoint {
  double x = 0;                                     // the piece's coordinate
  boost::container::small_vector<double, 4> value;  // of each component
  boost::container::small_vector<double, 4>
      rate;  // of the tangent's angle by x: at the first contact, then at each s + L_k

  /// Of a component by x.
  double slope(std::size_t row) const { return row + 1 < rate.size() ? rate[row + 1] - rate[0] : rate[0]; }
  /// A tiny step along the tangents.
  void step(double by) {
    x += by;
    for (std::size_t row = 0; row < value.size(); ++row) value[row] += by * slope(row);
  }
};

/// Where all contacts stay on one spiral each, so that every tangent's angle has a monotone rate: x is s. Or where the
/// finger pivots at a convex corner (or at a tiny joint), x being the angle that it has pivoted by and s a constant.
struct RollPiece {
  double lo = 0;  // of x
  double hi = 0;
  std::optional<double> pivot_at;    // s of a pivot
  std::optional<std::size_t> pivot;  // which contact pivots: 0 the first, k + 1 that of reading k
  boost::container::small_vector<std::uint32_t, 4> spiral;  // of each contact; of a pivot unused
  boost::container::small_vector<double, 4> offset;         // from x to each contact's place on its spiral
  boost::container::small_vector<double, 4> angle;          // whole periods' turn; of a pivot each contact's tangent
  boost::container::small_vector<bool, 4> constant;         // components that don't change: the contacts turn alike

  double width() const { return hi - lo; }
  double s(double x) const { return pivot_at ? *pivot_at : x; }
};

/// A first contact for which more than one contact stands at a convex corner: those pivot independently.
struct RollPatch {
  double s = 0;
  std::vector<Range> tangents;  // of each contact, the first one first; of the others with their shifts added
  double facing = 0;            // as in RollEquations
};

/// The curve with a tree of intervals over it, each with bounds on the values and slopes of every component. Intervals
/// are halved when somebody asks for it, once for all the boxes that they are a side of. Where the part's own tree has
/// bounds on the values, the curve is cut into pieces no sooner either.
class RollCurve {
 public:
  static constexpr std::uint32_t kManyPieces = UINT32_MAX;

  struct Node {
    double lo = 0;  // of x, on one piece; else of s
    double hi = 0;
    std::uint32_t piece = kManyPieces;
    std::int32_t left = -1;  // children; none yet
    std::int32_t right = -1;
    std::int32_t parent = -1;
    std::uint32_t first = 0;  // points at the ends; of an uncut one its spans
    std::uint32_t last = 0;
    std::array<Range, 2> diagonals;  // of the first two components the sum and the difference

    bool on_one_piece() const { return piece != kManyPieces; }
    double width() const { return hi - lo; }
  };

  /// What is known of one component on a node.
  struct Component {
    Range value;
    Range slope;
    double first = 0;  // its values at the ends
    double last = 0;
    double by_start = 0;  // what its two contacts' rates change the slope by from end to end, halved
    double by_end = 0;
  };

  /// x times one component and y times another one: both have the first contact.
  struct Combination {
    double x;
    double y;
    const Component& one;
    const Component& two;

    double first() const { return x * one.first + y * two.first; }
    double last() const { return x * one.last + y * two.last; }
    /// How far its slope gets from the middle.
    double slope_radius() const { return std::abs(start()) + std::abs(x * one.by_end) + std::abs(y * two.by_end); }
    /// Each contact's angle is on one side of its chord, for its rate is monotone, by a quarter of the rate's change
    /// times the width at the most.
    Range value(double width) const {
      const double half = 0.5 * width;
      const Range bend = hull(0, start()) + hull(0, x * one.by_end) + hull(0, y * two.by_end);
      const Range ends = hull(first(), last());
      return {ends.least - half * bend.most, ends.most - half * bend.least};
    }

   private:
    double start() const { return x * one.by_start + y * two.by_start; }
  };

  /// `range`: of s, the first contacts whose rolls stay on the part.
  RollCurve(const Part& part, RollEquations equations, const Interval& range);
  RollCurve(const RollCurve&) = delete;  // its strips know its equations
  RollCurve& operator=(const RollCurve&) = delete;

  std::size_t rows() const { return rows_; }
  const Node& node(std::int32_t index) const { return nodes_[static_cast<std::size_t>(index)]; }
  /// One for each row; good until a node is halved.
  const Component* components(std::int32_t node) const { return &components_[static_cast<std::size_t>(node) * rows_]; }
  const RollPiece& piece(const Node& node) const { return pieces_[node.piece]; }
  RollPoint first(const Node& node) const { return stored(node.first, node.lo); }
  RollPoint last(const Node& node) const { return stored(node.last, node.hi); }
  /// A component's slopes at both ends.
  std::array<double, 2> end_slopes(const Node& node, std::size_t row) const {
    return {slope_at(node.first, row), slope_at(node.last, row)};
  }
  std::int32_t root() const { return root_; }  // -1: no pieces
  std::size_t evaluations() const { return evaluations_; }

  /// The two halves of a node; of one with many pieces its two sides. -1 for the other of an only one.
  std::pair<std::int32_t, std::int32_t> halves(std::int32_t index);

  /// Takes a point to x on a node of one piece, and beyond its ends along its tangents there: the slopes keep the
  /// bounds that they have inside.
  void move(RollPoint& point, const Node& node, double x) const;

  /// One component's value and its slope by x, at x on a node of one piece.
  struct Place {
    double value = 0;
    double slope = 0;
  };
  Place place(const Node& node, double x, std::size_t row) const;

  /// Bounds on a component's slope between two points of one piece, for the rates are monotone.
  Range slope_between(const RollPiece& piece, const RollPoint& one, const RollPoint& two, std::size_t row) const {
    return slope_between(piece, one.rate.data(), two.rate.data(), row);
  }

  const std::vector<RollPatch>& patches() const { return patches_; }

 private:
  /// A contact's tangent's angle with its rate by x, and the panel that it is on.
  struct Contact {
    Turning turning;
    std::uint32_t panel = 0;  // of a pivot unused
  };
  using Cursors = boost::container::small_vector<Cursor, 4>;  // of the contacts

  bool is_facing(std::size_t row) const { return row + 1 == contacts_; }
  Range slope_between(const RollPiece& piece, const double* one, const double* two, std::size_t row) const {
    if (piece.constant[row]) return {0, 0};
    const Range start = hull(one[0], two[0]);
    if (is_facing(row)) return start;
    return hull(one[row + 1], two[row + 1]) - start;
  }
  double slope_at(std::uint32_t point, std::size_t row) const {
    const double* rates = &rates_[point * contacts_];
    return is_facing(row) ? rates[0] : rates[row + 1] - rates[0];
  }
  RollPoint stored(std::uint32_t index, double x) const;
  /// From the first contact to contact c's place on the cursor's spiral.
  double offset_of(std::size_t c, const Cursor& contact) const { return equations_.length_to(c) - contact.shift(); }
  std::int32_t cut(const Interval& range);
  std::int32_t make_uncut(const Interval& s, const RollStrips::Span* spans);
  void divide(std::size_t index);
  void make_room(std::size_t points);
  void make_pieces(const Interval& range);
  void pass_corners(double s, const Cursors& contacts);
  void find_constants(RollPiece& piece, std::uint32_t first, std::uint32_t last) const;
  void add_pivots(double s, const std::vector<Range>& tangents);
  std::int32_t make_node(std::uint32_t piece, double lo, double hi, std::uint32_t first, std::uint32_t last);
  Component component_between(const RollPiece& piece, std::size_t row, std::uint32_t first, std::uint32_t last,
                              double width) const;
  std::int32_t join(std::int32_t from, std::int32_t to);
  void adopt(std::int32_t index, std::int32_t left, std::int32_t right);
  bool tighten(std::int32_t index);
  template <class ContactOf>
  std::uint32_t add_point(const ContactOf& contact_of);
  Contact contact_at(const RollPiece& piece, double x, std::size_t c, std::uint32_t first_panel,
                     std::uint32_t last_panel) const;
  Contact contact_on_spiral(const RollPiece& piece, double x, std::size_t c) const;
  Contact contact_between(const Node& node, double x, std::size_t c) const;
  static Contact pivot_at(const RollPiece& piece, double x, std::size_t c) {
    return c == *piece.pivot ? Contact{{piece.angle[c] + x, 1}} : Contact{{piece.angle[c], 0}};
  }
  /// `value` one per row, `rate` one per contact.
  template <class ContactOf>
  void evaluate(const ContactOf& contact_of, double* value, double* rate) const;

  const Part& part_;
  const TurningFunction& turning_;
  RollEquations equations_;
  RollStrips strips_;
  std::size_t rows_;
  std::size_t contacts_;
  std::vector<RollPiece> pieces_;
  std::vector<RollPatch> patches_;
  std::vector<Node> nodes_;
  std::vector<Component> components_;
  std::size_t points_ = 0;
  boost::container::vector<double> values_;         // of the points and of room for more: rows_ of each
  boost::container::vector<double> rates_;          // contacts_ of each
  boost::container::vector<std::uint32_t> panels_;  // that each contact is on; of a pivot unused
  std::vector<RollStrips::Span> spans_;             // of the uncut nodes, contacts_ of each
  std::int32_t root_ = -1;
  mutable std::size_t evaluations_ = 0;
};

}  // namespace rollfix::locating
