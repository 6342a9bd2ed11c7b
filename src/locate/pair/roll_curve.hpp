#pragma once

#include <boost/container/small_vector.hpp>
#include <boost/container/vector.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "part/cursor.hpp"
#include "part/turning_range.hpp"
#include "plane_curve.hpp"
#include "rollfix/part.hpp"

namespace rollfix::locating {

/// What one finger adds to the equations: (8) and (9) say that two curves meet, A(s) of finger a and B(t) of finger b,
/// with the components Theta(s + L_k) - Theta(s) + shift_k, one for each reading, and with the facing equation one
/// more, Theta(s) + facing.
struct RollEquations {
  std::vector<double> lengths;   // L_k
  std::vector<double> shifts;    // added to each component, radians
  std::optional<double> facing;  // added to Theta(s)

  /// Components: one for each reading, and the facing last.
  std::size_t rows() const { return lengths.size() + (facing ? 1 : 0); }
  /// The first contact (0) and each reading's (k + 1).
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

  /// `range`: of first contacts. `equations` must outlive it.
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

  /// Where a spiral starts, by its number in a Span; on the second lap beyond P.
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
};

/// A first contact for which more than one contact stands at a convex corner: those pivot independently.
struct RollPatch {
  double s = 0;
  std::vector<Range> tangents;  // of each contact, the first one first; of the others with their shifts added
  double facing = 0;            // as in RollEquations
};

/// One finger's side of eqs. (8) and (9). Where the part's own tree has bounds on the values, the curve is cut into
/// pieces no sooner than somebody asks for halves.
class RollCurve final : public PlaneCurve {
 public:
  /// `range`: of s, the first contacts whose rolls stay on the part.
  RollCurve(const Part& part, RollEquations equations, const Interval& range);

  /// Where several contacts of this finger pivot at once: all are known from the start, for a curve of a part with
  /// corners is cut at once.
  const std::vector<RollPatch>& patches() const { return patches_; }
  /// Of the turning function, so far.
  std::size_t evaluations() const { return evaluations_; }

  std::optional<double> pivot_at(const Node& node) const override { return pieces_[node.piece].pivot_at; }
  CurvePoint point(const Node& node, double x) const override;
  Place place(const Node& node, double x, std::size_t row) const override;
  /// The rates are monotone.
  Range slope_between(const Node& node, const CurvePoint& one, const CurvePoint& two, std::size_t row) const override {
    return slopes_of(pieces_[node.piece], one.rates().data(), two.rates().data(), row);
  }

 private:
  /// A contact's tangent's angle with its rate by x, and the panel that it is on.
  struct Contact {
    Turning turning;
    std::uint32_t panel = 0;  // of a pivot unused
  };
  using Cursors = boost::container::small_vector<Cursor, 4>;  // of the contacts

  /// On one piece at the middle of x; else by the tree over the part's spirals, or into pieces.
  void divide(std::int32_t index) override;

  bool is_facing(std::size_t row) const { return row + 1 == contacts_; }
  /// Bounds on a component's slope while every rate is between its two values in `one` and `two`, as it is between two
  /// points of a piece, on which rates are monotone.
  Range slopes_of(const RollPiece& piece, const double* one, const double* two, std::size_t row) const {
    if (piece.constant[row]) return {0, 0};
    const Range start = hull(one[0], two[0]);
    if (is_facing(row)) return start;
    return hull(one[row + 1], two[row + 1]) - start;
  }
  /// A component's slope by x: kappa(s + L_k) - kappa(s), of the facing kappa(s).
  double slope_of(const double* rates, std::size_t row) const {
    return is_facing(row) ? rates[0] : rates[row + 1] - rates[0];
  }
  /// From the first contact to contact c's place on the cursor's spiral.
  double offset_of(std::size_t c, const Cursor& contact) const { return equations_.length_to(c) - contact.shift(); }
  std::int32_t cut(const Interval& range);
  std::int32_t make_uncut(const Interval& s, const RollStrips::Span* spans);
  void divide_on_piece(std::int32_t index);
  void divide_uncut(std::int32_t index);
  void make_room(std::size_t points);
  void make_pieces(const Interval& range);
  void pass_corners(double s, const Cursors& contacts);
  void find_constants(RollPiece& piece, std::uint32_t first, std::uint32_t last) const;
  void add_pivots(double s, const std::vector<Range>& tangents);
  std::int32_t make_node(std::uint32_t piece, double lo, double hi, std::uint32_t first, std::uint32_t last);
  Component component_between(const RollPiece& piece, std::size_t row, std::uint32_t first, std::uint32_t last,
                              double width) const;
  template <class ContactOf>
  std::uint32_t add_point(const ContactOf& contact_of);
  Contact contact_at(const RollPiece& piece, double x, std::size_t c, std::uint32_t first_panel,
                     std::uint32_t last_panel) const;
  Contact contact_on_spiral(const RollPiece& piece, double x, std::size_t c) const;
  Contact contact_between(const Node& node, double x, std::size_t c) const;
  /// At a corner one contact's tangent turns with x at rate 1; the others stand still.
  static Contact pivoted(const RollPiece& piece, double x, std::size_t c) {
    return c == *piece.pivot ? Contact{{piece.angle[c] + x, 1}} : Contact{{piece.angle[c], 0}};
  }
  /// Components and rates at a point, from the contacts' tangents there: `value` one for each row, `rate` one for each
  /// contact.
  template <class ContactOf>
  void evaluate(const ContactOf& contact_of, double* value, double* rate) const;

  const Part& part_;
  const TurningFunction& turning_;
  RollEquations equations_;
  RollStrips strips_;
  std::size_t contacts_;  // equations_.contacts()
  // In order of s within each range that was cut; `Node::piece` is an index into these.
  std::vector<RollPiece> pieces_;
  std::vector<RollPatch> patches_;
  // Points are shared by neighbouring nodes: `Node::first` and `last` are indices of points.
  std::size_t points_ = 0;
  boost::container::vector<double> values_;         // of the points and of room for more: rows() of each
  boost::container::vector<double> rates_;          // contacts_ of each
  boost::container::vector<std::uint32_t> panels_;  // that each contact is on; of a pivot unused
  std::vector<RollStrips::Span> spans_;             // of the uncut nodes, contacts_ of each
  mutable std::size_t evaluations_ = 0;
};

}  // namespace rollfix::locating
