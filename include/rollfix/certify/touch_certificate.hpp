#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/certify/certify.hpp"
#include "rollfix/part/reach.hpp"
#include "rollfix/touch/touch.hpp"

// The same for touches, and rolls that share a pose with them: docs/certificates.md.
namespace rollfix {

/// A set of poses, with one that fits, by the outline's own formulas.
struct CertifiedPose {
  TouchPose pose;              // `extent` holds all of the set; without contacts: it is not known whether one fits
  std::vector<CurvePlace> at;  // of its contacts, of rolls the first ones
  bool listed = true;          // false: the answer leaves it out: it is improbable, or the part would be in the way
  bool is_own = true;          // false: with noise the pose that fits best may be one of another set: `extent` is not
                               // claimed then
};

/// Touches of a part at rest and rolls on it, the outline by its formulas, and sets that together hold every pose that
/// fits.
struct TouchCertificate : CertifiedOutline {
  bool mirrored = false;  // the part lies face down
  double radius = 0;      // of the finger; 0: a point
  std::vector<RollSearched> rolls;
  std::vector<MeasuredTouch> touches;
  std::vector<TouchTolerance> tolerance;  // of each roll, then of each touch: length, and radians
  std::optional<Reach> reach{};           // where contacts are looked for; none: everywhere
  std::vector<CertifiedPose> poses;
  std::vector<Interval> unresolved{};  // arcs of the boundary on which a contact of other poses may be
  std::size_t unresolved_touch = 0;    // which one: rolls are the first ones

  /// Nothing is unresolved.
  bool is_complete() const { return unresolved.empty(); }
};

/// Writes down what an answer to touches and rolls claims: every pose within the tolerances is in one of its sets, and
/// each set has a pose that fits. A roll is its first contact on places of the boundary where its readings are within
/// their tolerance. Of rolls without centres, and no touch, only headings are claimed. With noise, rolls, or paths on
/// which nothing was felt, the sets that the answer leaves out are looked for as well. `budget`: as TouchProblem's.
/// Throws InputError: an answer to fewer than two contacts, rolls with noise or with a tolerance of angles below 1e-9;
/// an outline with a curve whose formula certificates don't have.
TouchCertificate certify_touches(const TouchAnswer& answer, std::optional<std::size_t> budget = {});

}  // namespace rollfix
