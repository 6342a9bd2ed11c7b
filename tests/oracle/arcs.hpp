#pragma once

// Which arcs of a boundary hold each other, and which meet, whichever lap they are named on.

#include "oracle/boundary.hpp"
#include "rollfix/curve.hpp"

namespace oracle {

/// Of the perimeter: what the library's places are accurate to, by docs/search.md.
inline constexpr Real kPlace = 1e-9L;

/// Of an extent's width: by how much its ends may be off, because f is taken as straight where it nearly is.
inline constexpr Real kStraight = 2e-3L;

class Arcs {
 public:
  explicit Arcs(const Boundary& boundary) : boundary_(boundary) {}

  static Interval extent(const rollfix::Interval& arc) { return {arc.lo, arc.hi}; }
  static Interval shrunk(const Interval& arc) {
    const Real off = kStraight * arc.width();
    return {arc.lo + off, arc.hi - off};
  }

  Real slack() const { return kPlace * boundary_.perimeter(); }

  /// Whether the inner one is within the outer one.
  bool covers(const Interval& outer, const Interval& inner) const {
    const Interval wide(outer.lo - slack(), outer.hi + slack());
    for (const int lap : {-2, -1, 0, 1, 2}) {
      const Real off = lap * boundary_.perimeter();
      if ((lap == 0 || boundary_.closed()) && wide.lo <= inner.lo + off && inner.hi + off <= wide.hi) return true;
    }
    return boundary_.closed() && outer.width() >= boundary_.perimeter() * (1 - kPlace);
  }

  bool meets(const Interval& one, const Interval& other) const {
    for (const int lap : {-2, -1, 0, 1, 2}) {
      const Real off = lap * boundary_.perimeter();
      if (lap != 0 && !boundary_.closed()) continue;
      if (one.lo - slack() <= other.hi + off && other.lo + off <= one.hi + slack()) return true;
    }
    return false;
  }

 protected:
  const Boundary& boundary_;
};

}  // namespace oracle
