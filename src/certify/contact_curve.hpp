#pragma once

#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "locate/pair/range.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

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
  std::vector<double> angles(double s, Side side) const;

 private:
  /// A first contact that brings a contact to a corner.
  struct Event {
    double s = 0;
    std::size_t contact = 0;
    double turn = 0;
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

}  // namespace rollfix
