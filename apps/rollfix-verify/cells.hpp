#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "boundary.hpp"
#include "document.hpp"

namespace rollfix_verify {

/// Rows keep this share of the perimeter from corners.
inline constexpr double kClear = 1e-12;

/// A roll from a start by the length asked, and how far its turn is off.
struct Row {
  Place start;
  Place end;          // of the roll, s + L
  Ball f;             // the turn along it less the one asked
  Series from_start;  // the curvature ahead of both
  Series from_end;
};

/// Whether the start or the end of the roll passes a corner from row to row.
bool spans_corner(const Boundary& boundary, const Row& from, const Row& to);

/// What f is on all the starts from one row to the next.
struct Range {
  bool known = false;  // false: nothing is said of f
  int slope = 0;       // +-1: f rises, falls all the way
  bool corner = false;
  std::vector<Ball> parts;  // f is in one of these at each start; several where it jumps at a concave corner
  double blur = 0;          // what f changes by as places are rounded

  bool misses(double bound) const;
  bool is_below(const Row& from, const Row& to, double bound) const;
};

/// One reading: its f from row to row.
class OneReading {
 public:
  /// Of {"length": L, "turn": theta}.
  OneReading(const Document& document, const Json& stated)
      : OneReading(document, document.length(stated.at("length")), Document::turn(stated.at("turn")),
                   document.tolerance()) {}

  /// Where this one's roll is from there on at the other one's end: where both fit that is off by twice the tolerance
  /// at the most, whatever the tangent at their start.
  OneReading beyond(const OneReading& other) const {
    return {document_, length_ - other.length_, turn_ - other.turn_, 2 * tolerance_};
  }

  const Ball& length() const { return length_; }
  const Ball& turn() const { return turn_; }

  /// The roll from there; nothing where it ends at a joint.
  std::optional<Row> row_at(const Place& start) const;
  std::optional<Row> row_at(const Ball& start) const;

  Range range(const Row& from, const Row& to) const;

  /// f is outside the tolerance at both ends of a cell, on opposite sides of it.
  bool changes_sign(const Row& from, const Row& to) const;

  /// Proves of f on all the starts between the two that it is `apart` from 0, has one `crossing`, or is a `stretch` of
  /// nothing else than 0. Throws std::domain_error: it could not.
  void prove(const std::string& kind, const Row& from, const Row& to) const;

 private:
  OneReading(const Document& document, const Ball& length, const Ball& turn, double tolerance)
      : document_(document),
        boundary_(document.boundary()),
        length_(length),
        turn_(turn),
        tolerance_(tolerance),
        period_(document.period()) {}

  struct Claim;
  /// The claim by its word. Throws std::domain_error where f at the rows already contradicts it.
  Claim claim_of(const std::string& kind, const Row& from, const Row& to) const;
  /// Whether it is proved on a part of the cell.
  bool holds(const Claim& claim, const Range& range, const Row& from, const Row& to) const;

  const Document& document_;
  const Boundary& boundary_;
  Ball length_;       // L
  Ball turn_;         // theta, radians
  double tolerance_;  // radians
  double period_;
};

/// Several readings, and their rolls from one start.
using Readings = std::vector<const OneReading*>;
using Rows = std::vector<Row>;

/// How far from a start their contacts are, its own first.
std::vector<Ball> contacts(const Readings& readings);

/// Halves the starts from row to row, in order, until each part is settled. Throws std::domain_error where that takes
/// too many halvings, or where a row between can't be told from joints.
using Settles = std::function<bool(const Rows& from, const Rows& to)>;
void by_halves(const Boundary& boundary, const Readings& readings, const Rows& from, const Rows& to,
               const Settles& settles, int depth = 0);

/// Whether all readings can fit at once, by no more than that each, where the contacts are anywhere between two places,
/// each on its own, and the tangent at the start is the same one for all. `around`: of each contact, the start first.
bool fit_together(const Boundary& boundary, const Readings& readings, const std::vector<Segment>& around, double most);

/// What some readings leave of a stretch of starts: parts of which none of them excludes all, by rising s. On each all
/// readings are near (off by no more than so many tolerances), or it is a corner, as narrow as one place.
class Remains {
 public:
  Remains(const Document& document, Readings readings, double near)
      : document_(document), readings_(std::move(readings)), near_(near) {}

  /// Of one more stretch, next to the one before: the starts from row to row, each one of which has the rolls of these
  /// readings. Throws std::domain_error where a part is neither excluded, near, nor a corner.
  void add(const Rows& from, const Rows& to);

  /// How many pieces they are; `is_round`: the last stretch is next to the first one.
  std::size_t pieces(bool is_round) const;
  bool are_corners() const;
  /// Whether a place is in one of them or no further from it than that.
  bool hold(double s, double reach) const;

 private:
  enum class Standing { excluded, near, corner, unknown };
  struct Part {
    Interval starts;
    bool is_corner = false;
  };

  /// False: the part has to be halved.
  bool settles(const Rows& from, const Rows& to);
  /// Excluded by some reading, near to fitting, a corner, or not known.
  Standing standing(const Rows& from, const Rows& to) const;

  const Document& document_;
  Readings readings_;
  double near_;  // in tolerances
  std::vector<Part> parts_;
  std::size_t pieces_ = 0;    // as long as nothing is round
  bool is_first_ = true;      // nothing was added yet
  bool starts_open_ = false;  // what was added first remains
  bool is_open_ = false;      // what was added last remains
};

}  // namespace rollfix_verify
