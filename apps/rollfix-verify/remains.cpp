#include "remains.hpp"

#include <algorithm>
#include <string>

namespace rollfix_verify {
namespace {

constexpr int kDeepestPart = 90;

}  // namespace

bool Remains::are_corners() const {
  return std::all_of(parts.begin(), parts.end(), [](const Part& part) { return part.at_corner; });
}

bool Remains::hold(double s, double reach) const {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const Part& part) { return s >= part.lo - reach && s <= part.hi + reach; });
}

Leftover::Standing Leftover::standing(const Rows& from, const Rows& to) const {
  const double tolerance = document_.tolerance();
  bool is_known = true;
  bool is_near = true;
  bool is_corner = false;
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    const Range range = readings_[k]->range(from[k], to[k]);
    is_known = is_known && range.known;
    if (!range.known) continue;
    if (misses(range, tolerance)) return Standing::excluded;
    is_near = is_near && is_below(range, from[k], to[k], kNear * tolerance);
    is_corner = is_corner || range.corner;
  }
  if (!is_known) return Standing::unknown;
  if (is_near) return Standing::near;
  const bool is_narrow = (to[0].start.s - from[0].start.s).is_below(kSamePlace * document_.period());
  if (!is_corner || !is_narrow) return Standing::unknown;
  std::vector<Segment> ends;
  for (std::size_t k = 0; k < readings_.size(); ++k) ends.push_back({from[k].end, to[k].end});
  const Segment starts{from[0].start, to[0].start};
  return fit_together(document_.boundary(), readings_, starts, ends, tolerance) ? Standing::corner : Standing::excluded;
}

void Leftover::add(const Rows& from, const Rows& to, int depth) {
  const Standing here = standing(from, to);
  if (here == Standing::unknown) {
    if (depth == kDeepestPart)
      refuse("it can't be told what fits near s = " + std::to_string(from[0].start.s.middle()));
    const Rows middle = rows_between(document_.boundary(), readings_, from[0].start, to[0].start);
    add(from, middle, depth + 1);
    add(middle, to, depth + 1);
    return;
  }
  const bool remains = here != Standing::excluded;
  if (is_first_) remains_.starts_open = remains;
  is_first_ = false;
  if (remains) {
    if (!is_open_) ++remains_.runs;
    remains_.parts.push_back({from[0].start.s.lower(), to[0].start.s.upper(), here == Standing::corner});
  }
  is_open_ = remains_.ends_open = remains;
}

}  // namespace rollfix_verify
