#pragma once

#include <vector>

#include "cells.hpp"

namespace rollfix_verify {

/// What some readings leave of a stretch of starts: parts of which none of them excludes all, by rising s. On each all
/// readings are near (off by no more than kNear tolerances), or it is a corner, as narrow as one place.
struct Remains {
  struct Part {
    double lo = 0;
    double hi = 0;
    bool at_corner = false;
  };
  std::vector<Part> parts;
  std::size_t runs = 0;      // of parts next to each other
  bool starts_open = false;  // the first one begins where the stretch does
  bool ends_open = false;    // the last one ends where the stretch does

  bool are_corners() const;
  /// Whether a place is in one of them or no further from it than that.
  bool hold(double s, double reach) const;
};

/// Of the starts from row to row, each one of which has the rolls of these readings. Throws std::domain_error where it
/// is neither one nor the other.
class Leftover {
 public:
  Leftover(const Document& document, std::vector<const OneReading*> readings)
      : document_(document), readings_(std::move(readings)) {}

  /// Of one more stretch, next to the one before.
  void add(const Rows& from, const Rows& to) { add(from, to, 0); }

  const Remains& remains() const { return remains_; }

 private:
  enum class Standing { excluded, near, corner, unknown };

  void add(const Rows& from, const Rows& to, int depth);
  Standing standing(const Rows& from, const Rows& to) const;

  const Document& document_;
  std::vector<const OneReading*> readings_;
  Remains remains_;
  bool is_first_ = true;
  bool is_open_ = false;  // the last part that was added remains
};

}  // namespace rollfix_verify
