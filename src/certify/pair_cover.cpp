#include "pair_cover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "places.hpp"

namespace rollfix {
namespace {

// Cells, before what is near a placement without a box is left to it, and before all is left.
constexpr std::size_t kFewCells = 8000;
constexpr std::size_t kMostCells = 80000;
// No side is halved below this share of the perimeter.
constexpr double kLeastSide = 1e-8;
// What changes by less than this share of the tolerance is not halved.
constexpr double kFlatShare = 0.25;
// The verifier proves what is stated: less, by this share, than what was found.
constexpr double kStated = 0.9;
constexpr std::string_view kLevels = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdef";

/// The power of 1/2 below a bound, as a character; what is less than the last one is the tolerance.
std::string level_of(double bound) {
  const int level = std::max(0, -static_cast<int>(std::floor(std::log2(bound))));
  return std::string(1, kLevels[std::min(static_cast<std::size_t>(level), kLevels.size() - 1)]);
}

}  // namespace

std::string PairCover::cells(const PairBox& whole) {
  cells_ = {{whole, "", 0}};
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const PairBox box = cells_[k].box;
    cells_[k].token = settled(box);
    if (!cells_[k].token.empty()) continue;
    const double least = kLeastSide * part_.perimeter();
    const bool is_done =
        cells_.size() >= kMostCells || is_flat(box) || std::max(box[0].width(), box[1].width()) < least;
    if (is_done || cells_.size() >= kFewCells) {
      cells_[k].token = left_over(box);
      if (is_done || cells_[k].token != "?") continue;
    }
    const double use_a = box[0].width() < least ? -1 : bounds_.use_of_halving(box[0], 0);
    const double use_b = box[1].width() < least ? -1 : bounds_.use_of_halving(box[1], 1);
    const std::size_t side = use_a > use_b || (use_a == use_b && box[0].width() > box[1].width()) ? 0 : 1;
    PairBox first = box;
    PairBox second = box;
    first[side].hi = second[side].lo = box[side].middle();
    cells_[k].token = side == 0 ? "s" : "t";
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
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (pairs_[k].box && is_inside(box, *pairs_[k].box)) return fmt::format("[{}]", k);
  }
  const double bound = kStated * bounds_.bound(box);
  return bound > tolerance_ ? level_of(bound) : "";
}

bool PairCover::is_flat(const PairBox& box) {
  return bounds_.change(box[0], 0) + bounds_.change(box[1], 1) <= kFlatShare * tolerance_;
}

/// A placement that it is near to: that starts in it, if there is one.
std::string PairCover::left_over(const PairBox& box) {
  const double slack = least_step(part_);
  const auto holds = [&](const Placement& placement) {
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const Interval side{box[finger].lo - slack, box[finger].hi + slack};
      const double s = placement.start[finger];
      const double lap = part_.closed() ? part_.perimeter() : 0;
      if (!side.contains(s) && !side.contains(s + lap) && !side.contains(s - lap)) return false;
    }
    return true;
  };
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (pairs_[k].box || pairs_[k].has_cell || !holds(*pairs_[k].placement)) continue;
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
  const double reach = 2 * std::max(box[0].width(), box[1].width());
  if (!placement.family.empty()) return is_near_line(box, placement, reach + placement.family_error);
  for (std::size_t finger = 0; finger < 2; ++finger) {
    const Interval& extent = placement.extent[finger];
    const Interval arc{extent.lo - reach, extent.hi + reach};
    const double middle = box[finger].middle();
    const double period = part_.perimeter();
    const double ahead = part_.closed() ? arc.lo + wrap(middle - arc.lo, period).base : middle;
    if (!(ahead >= arc.lo && ahead <= arc.hi)) return false;
  }
  return true;
}

/// To the line through a continuum, by the larger of both fingers' distances.
bool PairCover::is_near_line(const PairBox& box, const Placement& placement, double reach) const {
  const double period = part_.perimeter();
  const auto off = [&](double from, double to) {
    return part_.closed() ? std::remainder(to - from, period) : to - from;
  };
  const auto& line = placement.family;
  for (std::size_t k = 0; k + 1 < line.size() || k == 0; ++k) {
    const PerFinger<double>& from = line[k];
    const PerFinger<double>& to = line[std::min(k + 1, line.size() - 1)];
    const double length = std::max(std::abs(to[0] - from[0]), std::abs(to[1] - from[1]));
    const int steps = 1 + static_cast<int>(length / (0.5 * reach + 1e-6 * period));
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const double s = from[0] + share * (to[0] - from[0]);
      const double t = from[1] + share * (to[1] - from[1]);
      if (std::abs(off(s, box[0].middle())) <= reach && std::abs(off(t, box[1].middle())) <= reach) return true;
    }
  }
  return false;
}

void PairCover::write(std::size_t cell, std::string& text) const {
  text += cells_[cell].token;
  if (cells_[cell].first == 0) return;
  write(cells_[cell].first, text);
  write(cells_[cell].first + 1, text);
}

}  // namespace rollfix
