#include "pair_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "places.hpp"

// Notation, as in docs/certificates.md, "Two fingers":
//   box             a stretch of finger a's first contacts times one of finger b's
//   cell            a node of the tree: `s` or `t` says which side is halved; else a leaf with its claim: `token`
//   level n         at every pair some equation is off by more than 2^-n rad: one of the characters `kLevels`
//   [k]             the cell is placement k's
//   ?               nothing is claimed
// Follows docs/certificates.md, "Two fingers": the table of cells.
// Idea: breadth first, the side whose equations change more is halved, until each part is excluded, is in a placement's
// box, or is too small; what is left goes to a placement without a box that is near, or claims nothing.
namespace rollfix::certifying {
namespace {

// Cells, before what is near a placement without a box is left to it, and before all is left.
constexpr std::size_t kFewCells = 8000;
constexpr std::size_t kMostCells = 80000;
// No side is halved below this share of the perimeter.
constexpr double kLeastSide = 1e-8;
// What changes by less than this share of the tolerance is not halved.
constexpr double kFlatShare = 0.25;
// A continuum is near where its extent is, with this share of it to spare, if that is thinner than this share of the
// perimeter; else where the line through it is.
constexpr double kThin = 0.01;
constexpr double kRoom = 0.25;
// The verifier proves what is stated: less, by this share, than what was found.
constexpr double kStated = 0.9;
constexpr std::string_view kLevels = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdef";

/// The power of 1/2 below a bound, as a character; what is less than the last one is the tolerance.
std::string level_of(double bound) {
  const int level = std::max(0, -static_cast<int>(std::floor(std::log2(bound))));
  return std::string(1, kLevels[std::min(static_cast<std::size_t>(level), kLevels.size() - 1)]);
}

/// On the way from one place to another, as shares of it: where it is no further than that from a third one.
Interval share_near(const Interval& way, double place, double reach) {
  const double lo = (place - reach - way.lo) / way.width();
  const double hi = (place + reach - way.lo) / way.width();
  // A line of one point: all of it or nothing.
  if (way.width() == 0) return std::abs(place - way.lo) <= reach ? Interval{0, 1} : Boundary::empty_arc();
  return {std::max(0.0, std::min(lo, hi)), std::min(1.0, std::max(lo, hi))};
}

}  // namespace

/// A queue of boxes, the whole first: each gets its claim, or its two halves are put at the end. So the limits on the
/// number of cells cut off the smallest boxes, evenly over the square.
std::string PairCover::cells(const PairBox& whole) {
  cells_ = {{whole, "", 0}};
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const PairBox box = cells_[k].box;
    cells_[k].token = settled(box);
    if (!cells_[k].token.empty()) continue;
    const double least = kLeastSide * part_.perimeter();
    const bool is_done =
        cells_.size() >= kMostCells || is_flat(box) || std::max(box[0].width(), box[1].width()) < least;
    // Above `kFewCells` boxes near a placement without a box are left to it, all others are still halved.
    if (is_done || cells_.size() >= kFewCells) {
      cells_[k].token = left_over(box);
      if (is_done || cells_[k].token != "?") continue;
    }
    // A side of the least width is not halved. Of equal use: the longer side, so that flat parts are cut as well.
    const double use_a = box[0].width() < least ? -1 : bounds_.use_of_halving(box[0], 0);
    const double use_b = box[1].width() < least ? -1 : bounds_.use_of_halving(box[1], 1);
    const std::size_t side = use_a > use_b || (use_a == use_b && box[0].width() > box[1].width()) ? 0 : 1;
    PairBox first = box;
    PairBox second = box;
    first[side].hi = second[side].lo = box[side].middle();
    cells_[k].token = side == 0 ? "s" : "t";
    // The halves stand behind each other at the end.
    cells_[k].first = cells_.size();
    cells_.push_back({first, "", 0});
    cells_.push_back({second, "", 0});
  }
  std::string text;
  write(0, text);
  return text;
}

/// What is to be said of a box at once.
std::string PairCover::settled(const PairBox& box) {
  // A box inside a placement's box needs no bounds.
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (pairs_[k].box && is_inside(box, *pairs_[k].box)) return fmt::format("[{}]", k);
  }
  // Above the tolerance by a margin: the character claims the power of 1/2 below the bound, and never less than the
  // tolerance.
  const double bound = kStated * bounds_.bound(box);
  if (bound > tolerance_) return level_of(bound);
  // Not excluded, but what may fit in it is known to be one placement's.
  const std::optional<std::size_t> owner = this->owner(box);
  if (!owner) return "";
  pairs_[*owner].has_cell = pairs_[*owner].has_cell || holds_start(box, *pairs_[*owner].placement);
  return fmt::format("[{}]", *owner);
}

/// The placement that all that may fit in a box belongs to, where that can be told.
std::optional<std::size_t> PairCover::owner(const PairBox& box) {
  const std::optional<std::vector<PairBox>> sets = bounds_.remains(box, tolerance_, nullptr);
  std::optional<std::size_t> owner;
  // Not planes: only beside a family's line can it be told what may fit.
  if (!sets) {
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (pairs_[k].line && belongs(box, k)) return k;
    }
    return owner;
  }
  // All sets that belong to some placement must belong to the same one, and it must have no box.
  for (const PairBox& set : *sets) {
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (!is_of(set, pairs_[k])) continue;
      if (pairs_[k].box || (owner && *owner != k)) return std::nullopt;
      owner = k;
    }
  }
  return owner;
}

/// All that may fit in a box is beside a family's line, or flat and this placement's.
bool PairCover::belongs(const PairBox& box, std::size_t family) {
  const std::optional<std::vector<PairBox>> sets = bounds_.remains(box, tolerance_, &*pairs_[family].line);
  // Each set belongs to the family, and to no other placement.
  return sets && std::all_of(sets->begin(), sets->end(), [&](const PairBox& set) {
           for (std::size_t k = 0; k < pairs_.size(); ++k) {
             if (is_of(set, pairs_[k]) != (k == family)) return false;
           }
           return true;
         });
}

bool PairCover::is_flat(const PairBox& box) {
  return bounds_.spread(box[0], 0) + bounds_.spread(box[1], 1) <= kFlatShare * tolerance_;
}

/// Whether a set that may fit belongs to a placement: to its box, or to its extent and to the line through it.
bool PairCover::is_of(const PairBox& set, const CoveredPair& pair) const {
  // Extents and boxes are known to rounding only: some steps beside them still belong to them.
  const double room = 16 * least_step(part_);
  if (pair.box) return meets(set, *pair.box, room);
  const Placement& placement = *pair.placement;
  if (!meets(set, {placement.extent[0], placement.extent[1]}, room)) return false;
  // The line may be as far from the set's middle as half of its shorter side.
  const double reach = 0.5 * std::min(set[0].width(), set[1].width());
  return placement.family.empty() || is_near_line(set, placement, reach + placement.family_error + room);
}

/// Whether two boxes are within `room` of each other on both fingers' boundaries, laps aside.
bool PairCover::meets(const PairBox& one, const PairBox& two, double room) const {
  const Boundary boundary = part_.boundary();
  for (const std::size_t finger : {0U, 1U}) {
    const Interval wide{one[finger].lo - room, one[finger].hi + room};
    if (boundary.distance(two[finger], wide.lo) > 0 && boundary.distance(wide, two[finger].lo) > 0) return false;
  }
  return true;
}

/// To a step, on this lap or a neighbouring one.
bool PairCover::holds_start(const PairBox& box, const Placement& placement) const {
  const double slack = least_step(part_);
  for (std::size_t finger = 0; finger < 2; ++finger) {
    const Interval side{box[finger].lo - slack, box[finger].hi + slack};
    const double s = placement.start[finger];
    const double lap = part_.closed() ? part_.perimeter() : 0;
    if (!side.contains(s) && !side.contains(s + lap) && !side.contains(s - lap)) return false;
  }
  return true;
}

/// A placement that it is near to: that starts in it, if there is one.
std::string PairCover::left_over(const PairBox& box) {
  // First the placements that have no cell yet: each must start in a cell of its own.
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (pairs_[k].box || pairs_[k].has_cell || !holds_start(box, *pairs_[k].placement)) continue;
    pairs_[k].has_cell = true;
    return fmt::format("[{}]", k);
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (!pairs_[k].box && is_near(box, *pairs_[k].placement)) return fmt::format("[{}]", k);
  }
  return "?";
}

/// By more than rounding, but for whole laps.
bool PairCover::is_inside(const PairBox& inner, const PairBox& outer) const {
  const double slack = 2 * least_step(part_);
  for (std::size_t finger = 0; finger < 2; ++finger) {
    const Interval room{outer[finger].lo + slack, outer[finger].hi - slack};
    const double lap = part_.closed() ? part_.perimeter() : 0;
    const auto holds = [&](double shift) {
      return room.contains(inner[finger].lo + shift) && room.contains(inner[finger].hi + shift);
    };
    if (!holds(0) && !holds(lap) && !holds(-lap)) return false;
  }
  return true;
}

bool PairCover::is_near(const PairBox& box, const Placement& placement) const {
  // The extent is widened by twice the box's longer side, and by a share of itself. An extent that is not thin holds
  // much besides the line through it: there the line decides.
  const double reach = 2 * std::max(box[0].width(), box[1].width());
  bool is_thin = placement.family.empty();
  PairBox wide{placement.extent[0], placement.extent[1]};
  for (Interval& extent : wide) {
    is_thin = is_thin || extent.width() < kThin * part_.perimeter();
    const double room = reach + kRoom * extent.width();
    extent = {extent.lo - room, extent.hi + room};
  }
  return meets(box, wide, 0) && (is_thin || is_near_line(box, placement, reach + placement.family_error));
}

/// To the line through a continuum, by the larger of both fingers' distances.
bool PairCover::is_near_line(const PairBox& box, const Placement& placement, double reach) const {
  const auto& line = placement.family;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    // Shares of the way along it on which each finger is near.
    std::array<Shares, 2> near;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      near[finger] = shares_near({line[k][finger], line[k + 1][finger]}, box[finger].middle(), reach);
    }
    for (const Interval& a : near[0]) {
      for (const Interval& b : near[1]) {
        if (std::max(a.lo, b.lo) <= std::min(a.hi, b.hi)) return true;
      }
    }
  }
  return false;
}

/// Where on the way a place is within reach: on its lap that is nearest to the way, the one before and the one after.
PairCover::Shares PairCover::shares_near(const Interval& way, double place, double reach) const {
  const double period = part_.perimeter();
  if (!part_.closed()) return {share_near(way, place, reach), Boundary::empty_arc(), Boundary::empty_arc()};
  const double nearest = place + period * std::round((way.middle() - place) / period);
  return {share_near(way, nearest, reach), share_near(way, nearest - period, reach),
          share_near(way, nearest + period, reach)};
}

void PairCover::write(std::size_t cell, std::string& text) const {
  text += cells_[cell].token;
  // A leaf: cell 0 is the whole, and no half of another one.
  if (cells_[cell].first == 0) return;
  write(cells_[cell].first, text);
  write(cells_[cell].first + 1, text);
}

}  // namespace rollfix::certifying
