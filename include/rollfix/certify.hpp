#pragma once

// An answer with all that a proof of it needs, which `rollfix-verify` checks without this library:
// docs/certificates.md.
//
//     const Part part = load_part("gallery:ellipse,a=2,b=1");
//     const Certificate certificate = certify(part, {Reading(1.0, 0.5)});
//     certificate.is_complete();        // true
//     certificate.placements.size();    // 4
//
// Degenerate cases: what can't be proved within the budget is `unproved`, or `unresolved`, and `is_complete()` is
// false; what no certificate claims: docs/certificates.md, "What is not proved".
//
// Accuracy: claims hold for the outline's formulas in exact arithmetic, within the stated tolerance; the verifier
// computes in balls of 128 bits.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/hold.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/touch.hpp"

namespace rollfix {

/// A place by the outline's own formulas.
struct CurvePlace {
  std::size_t curve = 0;
  double u = 0;  // that curve's parameter
};

/// What is claimed on all the starts between two rows of a certificate: of one reading's f, or of each one's.
enum class CellKind {
  apart,     // one: outside the tolerance; or two: nowhere both within it
  crossing,  // one: has one sign of slope and exactly one root
  corner,    // one: passes 0 at a convex corner's pivot and is outside the tolerance elsewhere
  within,    // each: nowhere beyond the larger of the tolerance and |f| at the ends
  stretch,   // each: 0 to rounding
  unproved   // nothing
};
const char* name_of(CellKind kind);

/// A start, and of each reading the end of the roll from there and how far its turn is off.
struct CertificateRow {
  CurvePlace start;
  std::vector<CurvePlace> end;
  std::vector<double> off;          // f, in tolerances
  CellKind then = CellKind::apart;  // from here to the next row; of a closed outline's last one to the first
  std::vector<std::size_t> by;      // the reading, or the two, of which that is claimed; none: of each
};

/// A placement by the outline's own formulas.
struct CertifiedPlacement {
  Placement placement;
  CurvePlace at;  // of its start
};

/// The outline that a certificate is of, by its formulas.
struct CertifiedOutline {
  std::string part;  // its name
  bool closed = true;
  double perimeter = 0;
  Vec2 origin = Vec2::Zero();  // the point at s = 0
  double gap = 0;              // the largest between neighbouring curves
  std::vector<CurveRecord> curves;
};

/// A question of one finger, the outline by its formulas, and cells that together hold every start.
struct Certificate : CertifiedOutline {
  std::vector<Reading> readings;
  double tolerance = 0;
  std::vector<CertificateRow> rows;  // by rising start; of an open outline the last one ends the last cell
  std::vector<CertifiedPlacement> placements;

  /// Every cell claims something.
  bool is_complete() const;
};

/// Locates, and writes down what the answer rests on. Nothing is claimed beyond it: what can't be, is `unproved`.
/// Throws InputError: as locate does, readings of two fingers, an outline with a curve whose formula certificates don't
/// have, a roll as long as an open outline.
Certificate certify(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options = {});

}  // namespace rollfix

// The same for two fingers: docs/certificates.md.
namespace rollfix {

/// A pair of first contacts, and how far each equation is off there: of the readings in order, then of the facing.
struct PairRow {
  std::array<CurvePlace, 2> start;
  std::vector<double> off;  // in tolerances
};

/// What is proved of a placement of two fingers.
enum class PairProof {
  one,     // exactly one pair in its box solves the equations, and all that fits there is connected with it
  family,  // each pair of its line fits, and all of it is in its extent
  fits,    // its start fits
  none     // nothing
};
const char* name_of(PairProof proof);

/// A placement by the outline's own formulas.
struct CertifiedPair {
  Placement placement;
  std::array<CurvePlace, 2> at;  // of its start
  PairProof proof = PairProof::none;
  std::optional<std::array<PairRow, 2>> box;    // from corner to corner; none: the cells that name it
  std::array<std::array<double, 2>, 2> line{};  // of a family: from pair to pair, s and t of each
  std::array<Interval, 2> extent;               // of a family
};

/// A question of two fingers, the outline by its formulas, and boxes that together hold every pair of first contacts.
struct PairCertificate : CertifiedOutline {
  std::vector<Reading> readings;
  std::optional<double> facing;
  double tolerance = 0;
  PairRow from;               // where the cells begin; of a closed outline they go once round from there
  std::optional<PairRow> to;  // of an open one where they end
  std::string cells;          // docs/certificates.md
  std::vector<CertifiedPair> placements;

  /// Every cell and every placement claims something.
  bool is_complete() const;
};

/// Locates, and writes down what the answer rests on. Nothing is claimed beyond it: what can't be, is unproved.
/// Throws InputError: as locate does, readings of one finger, an outline with a curve whose formula certificates don't
/// have, a roll as long as an open outline.
PairCertificate certify_pair(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options = {});

}  // namespace rollfix

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

// The same for three and more fingers, and for fingers beside wheels: docs/certificates.md, "Holds".
namespace rollfix {

/// What is said of one finger with skin, at all instants.
struct CertifiedFinger {
  std::string kind;               // "disk", "jaw" or "outline"
  double radius = 0;              // of a disk
  double travel = 0;              // tolerance of where on the boundary it touches, length; ...
  double angle = 0;               // ... of the part's tangent there, radians; ...
  std::optional<double> place{};  // ... of the contact in the world; none: x and y are not evidence
  Interval passed{};              // from the first contact all of it is rolled over for certain, over all rows
  std::optional<Reach> reach{};   // where it can touch; none: everywhere
};

/// The same of a wheel.
struct CertifiedWheel {
  double radius = 0;
  double place = 0;              // tolerance of the pin, length, ...
  std::optional<double> spin{};  // ... of the encoder, radians; none: it has none, ...
  std::optional<double> line{};  // ... of the line of force, radians; none: it is not squeezed
  std::optional<Reach> reach{};
};

/// What was measured at an instant that is searched with, in the world.
struct CertifiedInstant {
  struct Contact {
    double travelled = 0;      // by the contact since the first row, along the stored outline
    double tangent = 0;        // of the part at the contact, radians, counted on from row to row
    std::optional<Vec2> at{};  // the contact
  };
  struct Pin {
    Vec2 at = Vec2::Zero();
    std::optional<double> spin{};  // the wheel's orientation, radians, counted on from row to row
  };
  double time = 0;
  std::vector<Contact> contacts;  // of each finger
  std::vector<Pin> pins;          // of each wheel
};

/// How the part lies at an instant if first contacts fit, and how far that is off what was measured, in tolerances.
struct CertifiedLie {
  struct Wheel {
    CurvePlace at;  // where it touches
    double tangent = 0;
    std::array<double, 3> off{};  // of the pin, of the line of force, of the encoder
  };
  Pose pose;
  std::vector<std::array<double, 2>> off;  // of each finger's contact, and of its tangent
  std::vector<Wheel> wheels;
};

/// A set of first contacts.
struct CertifiedHoldSet {
  std::vector<Interval> extent;  // of each finger: all first contacts of the set are in these arcs
  bool listed = true;            // false: with noise the answer leaves it out as improbable
  // First contacts that fit; none: it is not known whether any do.
  std::vector<double> first;
  std::vector<CurvePlace> at;
  std::vector<double> zeros;         // of each wheel's encoder, radians; 0 without one
  std::vector<CertifiedLie> lies{};  // at each instant
};

/// What several fingers measured, the outline by its formulas, and sets that together hold all first contacts that fit.
struct HoldCertificate : CertifiedOutline {
  bool mirrored = false;  // the part lies face down
  std::vector<CertifiedFinger> fingers;
  std::vector<CertifiedWheel> wheels;
  std::vector<CertifiedInstant> instants;
  std::vector<CertifiedHoldSet> sets;
  std::vector<std::vector<Interval>> unresolved{};  // arcs of each finger on which other first contacts may be

  /// Nothing is unresolved, and something is known to fit in each set that is listed.
  bool is_complete() const;
};

/// Searches again, and writes down what an answer claims: all first contacts within the tolerances are in one of its
/// sets, each of which has some that fit. With noise the tolerances are 4.5 standard deviations (`kPossibleSigmas`),
/// and the sets that the answer leaves out are written down as well. `answer`: that of `solve` to this problem. Throws
/// InputError: as `solve`, an answer to another problem, an outline with a curve whose formula certificates don't have.
HoldCertificate certify_holds(const HoldProblem& problem, const HoldAnswer& answer);

}  // namespace rollfix
