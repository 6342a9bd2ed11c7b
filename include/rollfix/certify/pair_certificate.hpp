#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/certify/certify.hpp"

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
