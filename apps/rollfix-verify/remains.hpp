#pragma once

#include <vector>

#include "cells.hpp"

namespace rollfix_verify {

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

  bool settles(const Rows& from, const Rows& to);
  Standing standing(const Rows& from, const Rows& to) const;

  const Document& document_;
  Readings readings_;
  double near_;
  std::vector<Part> parts_;
  std::size_t pieces_ = 0;    // as long as nothing is round
  bool is_first_ = true;      // nothing was added yet
  bool starts_open_ = false;  // what was added first remains
  bool is_open_ = false;      // what was added last remains
};

}  // namespace rollfix_verify
