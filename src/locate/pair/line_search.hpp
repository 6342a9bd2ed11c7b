#pragma once

#include <cstddef>
#include <vector>

#include "components.hpp"
#include "plane_curve.hpp"

namespace rollfix::locating {

/// Where two curves run alongside each other in a box: one equation, the guide, is solved for one of the two contacts,
/// which leaves a line through the box, and the other equations are searched along that line by branch and prune, as
/// one finger's is. Finds touching curves, and curves that overlap: stretches.
class LineSearch {
 public:
  /// A search of one box; `budget` is taken from, `findings` is added to.
  LineSearch(const PairBoxSides& sides, const PairLimits& limits, std::size_t& budget, PairFindings& findings);

  /// Decides the box. False: no equation in this box can guide, or the set within the tolerance about the line would be
  /// wider than the box; then nothing was listed.
  bool run();

  /// Do all equations vanish in the middle of the line too? A quick look before `run`: if not, the curves do not
  /// overlap all along this box.
  bool may_overlap();

 private:
  /// A place on the line.
  struct Place {
    CurvePoint free;   // of the contact that the line is told by
    CurvePoint bound;  // of the other one: the guide is 0
  };
  /// A part of the line between two places; the free contact's x rises from lo to hi.
  struct Stretch {
    Place lo;
    Place hi;
    int depth = 0;
    bool covered = false;  // see PairLimits
  };
  /// Bounds along a stretch of the line.
  struct Bounds {
    Range bound_x;               // of the other contact
    Range direction;             // its change by the free contact's
    std::vector<Range> slope;    // of each residual by the free contact
    std::vector<double> within;  // the tolerance of each residual, for the guide may be off as well
  };

  /// False: no component's slope keeps its sign on a side, is steep enough, and leaves a band narrower than the box.
  bool choose_guide();
  /// The place on the line where the free contact is at x.
  Place place(double x) const;
  double bound_at(double value) const;
  /// f of a row at a place, with its sign as A - B whichever contact is free; and its slope along the line by x.
  double residual(const Place& place, std::size_t row) const;
  double residual_slope(const Place& place, std::size_t row) const;
  /// dy/dx of the line.
  double direction(const Place& place) const;
  Bounds bounds(const Stretch& stretch) const;
  /// May y, along the stretch, rise as well as fall?
  bool turns_round(const Stretch& stretch) const;
  bool clip(Stretch& stretch, double margin) const;
  Place at_edge(const Stretch& stretch, double edge) const;
  /// Excludes, lists or halves a stretch of the line (search.md, "Two fingers", steps 4 and 5).
  void decide(Stretch stretch);
  std::size_t steepest(const Bounds& along) const;
  bool take_flat(const Stretch& stretch, const Bounds& along, bool is_point);
  /// True: `samples` are places all along the overlap, in order of x.
  bool overlaps(const Stretch& whole, std::vector<Place>& samples) const;
  bool is_apart_midway() const;
  /// All residuals but the guide's have a slope of 0 along the line there, or (`vanishes`) are 0, but for rounding.
  bool slopes_vanish(const Place& at) const;
  bool vanishes(const Place& place) const;
  double residual_rounding(const Place& place) const;
  Place turn_between(const Place& one, const Place& two) const;
  void take_overlap(const Stretch& whole, std::vector<Place> samples);
  void add_beyond(const Place& lo, const Place& hi);
  /// `row`: whose residual is monotone on the stretch.
  void take_monotone(const Stretch& stretch, const Bounds& along, std::size_t row);
  /// `y`: bounds on the bound contact between both.
  void add_piece(const Place& lo, const Place& hi, const Range& y);
  bool passes_by(const Place& lo, const Place& hi, const Range& y) const;
  Polygon within_row(const Polygon& polygon, const Place& at, std::size_t row, double most) const;
  Polygon narrow(const Polygon& band, const Place& lo, const Place& hi) const;
  Polygon band(const Place& lo, const Place& hi, double bend) const;
  void add_root(const Place& place, int sign, bool exact);
  /// Where between both places the residual of `row`, monotone there, equals `level`. REQUIRES that it does.
  Place solve(std::size_t row, double level, const Place& from, const Place& to) const;
  /// (s, t) of a place, brought into the box; of a point (x, y).
  PairPoint contacts(const Place& place) const;
  PairPoint contacts(const Vec2& at) const;
  /// Is the bound contact on its side, but for rounding?
  bool is_inside(const Place& place) const;
  void split(const Stretch& stretch);

  /// The sides of the free contact and of the bound one.
  const BoxSide& free() const { return free_is_a_ ? sides_.a : sides_.b; }
  const BoxSide& bound() const { return free_is_a_ ? sides_.b : sides_.a; }
  /// 0 where the bound contact pivots, for then `off` is an angle.
  double length_of(double off) const { return bound().pivots() ? 0 : off; }

  PairBoxSides sides_;
  PairLimits limits_;
  std::size_t& budget_;
  PairFindings& findings_;
  bool free_is_a_ = true;
  std::size_t guide_ = 0;
  double margin_ = 0;  // how far the bound contact may be off the line within the tolerance
  std::vector<Stretch> waiting_;
};

}  // namespace rollfix::locating
