#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/certify/certify.hpp"
#include "rollfix/hold/hold.hpp"
#include "rollfix/part/reach.hpp"

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
/// sets, each of which has some that fit. With noise the tolerances are 4.5 standard deviations (`kTouchSigmas`), and
/// the sets that the answer leaves out are written down as well. `answer`: that of `solve` to this problem. Throws
/// InputError: as `solve`, an answer to another problem, an outline with a curve whose formula certificates don't have.
HoldCertificate certify_holds(const HoldProblem& problem, const HoldAnswer& answer);

}  // namespace rollfix
