#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "along.hpp"
#include "document.hpp"

namespace rollfix_verify {

/// A roll from a start by the length asked, and how far its turn is off.
struct Row {
  Place start;
  Place end;
  Ball f;  // the turn along it less the one asked
  Taylor start_ahead;
  Taylor end_ahead;
};

/// Whether the start or the end of the roll passes a corner from row to row.
bool spans_corner(const Boundary& boundary, const Row& from, const Row& to);

struct Range;

/// One reading: its f from row to row.
class OneReading {
 public:
  /// Of {"length": L, "turn": theta}.
  OneReading(const Document& document, const Json& stated)
      : OneReading(document, Ball(stated.at("length").get<double>()), Ball(stated.at("turn").get<double>()),
                   document.tolerance()) {}

  /// Where this one's roll is from there on at the other one's end: where both fit that is off by twice the tolerance
  /// at the most, whatever the tangent at their start.
  OneReading beyond(const OneReading& other) const {
    return {document_, length_ - other.length_, turn_ - other.turn_, 2 * tolerance_};
  }

  const Ball& length() const { return length_; }

  /// The roll from there; nothing where it ends at a joint.
  std::optional<Row> row_at(const Place& start) const;
  /// The same from so far beside it.
  std::optional<Row> row_beside(const Place& start, double distance) const;

  /// f is outside the tolerance at both ends of a cell, on opposite sides of it.
  bool changes_sign(const Row& from, const Row& to) const;

  /// Proves what is claimed of f on all the starts between the two, by the name that the certificate has for it. Throws
  /// std::domain_error: it could not.
  void prove(const std::string& kind, const Row& from, const Row& to) const;

  /// Whether the place itself fits, as far as it can be told from what is beside it.
  bool fits(const Place& start) const;

 private:
  OneReading(const Document& document, const Ball& length, const Ball& turn, double tolerance)
      : document_(document),
        boundary_(document.boundary()),
        length_(length),
        turn_(turn),
        tolerance_(tolerance),
        period_(document.period()) {}

  struct Claim;
  Claim claim_of(const std::string& kind, const Row& from, const Row& to) const;
  bool is_narrow(const Row& from, const Row& to) const;
  bool holds(const Claim& claim, const Range& range, const Row& from, const Row& to) const;
  void prove(const Claim& claim, const Row& from, const Row& to, int depth, std::size_t& parts) const;
  Row between(const Row& from, const Row& to) const;

  const Document& document_;
  const Boundary& boundary_;
  Ball length_;
  Ball turn_;
  double tolerance_;
  double period_;
};

}  // namespace rollfix_verify
