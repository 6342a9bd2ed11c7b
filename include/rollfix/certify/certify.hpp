#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/contact/reading.hpp"
#include "rollfix/locate/locate.hpp"
#include "rollfix/locate/placement.hpp"
#include "rollfix/part/part.hpp"

// An answer that anyone can check without this library: docs/certificates.md.
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
