#include "remains.hpp"

#include <algorithm>

namespace rollfix_verify {

std::size_t Remains::pieces(bool is_round) const {
  return is_round && pieces_ > 1 && starts_open_ && is_open_ ? pieces_ - 1 : pieces_;
}

bool Remains::are_corners() const {
  return std::all_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.is_corner; });
}

bool Remains::hold(double s, double reach) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) { return part.starts.holds({s, s}, reach); });
}

Remains::Standing Remains::standing(const Rows& from, const Rows& to) const {
  const double tolerance = document_.tolerance();
  bool is_known = true;
  bool is_near = true;
  bool is_corner = false;
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    const Range range = readings_[k]->range(from[k], to[k]);
    is_known = is_known && range.known;
    if (!range.known) continue;
    if (range.misses(tolerance)) return Standing::excluded;
    is_near = is_near && range.is_below(from[k], to[k], near_ * tolerance);
    is_corner = is_corner || range.corner;
  }
  if (!is_known) return Standing::unknown;
  if (is_near) return Standing::near;
  const bool is_narrow = (to[0].start.s - from[0].start.s).is_below(kSamePlace * document_.period());
  if (!is_corner || !is_narrow) return Standing::unknown;
  std::vector<Segment> around = {{from[0].start, to[0].start}};
  for (std::size_t k = 0; k < readings_.size(); ++k) around.push_back({from[k].end, to[k].end});
  return fit_together(document_.boundary(), readings_, around, tolerance) ? Standing::corner : Standing::excluded;
}

void Remains::add(const Rows& from, const Rows& to) {
  by_halves(document_.boundary(), readings_, from, to, [&](const Rows& lo, const Rows& hi) { return settles(lo, hi); });
}

bool Remains::settles(const Rows& from, const Rows& to) {
  const Standing here = standing(from, to);
  if (here == Standing::unknown) return false;
  const bool remains = here != Standing::excluded;
  if (is_first_) starts_open_ = remains;
  is_first_ = false;
  if (remains) {
    if (!is_open_) ++pieces_;
    parts_.push_back({{from[0].start.s.lower(), to[0].start.s.upper()}, here == Standing::corner});
  }
  is_open_ = remains;
  return true;
}

}  // namespace rollfix_verify
