#include "belief/travel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "belief/posterior.hpp"

// Notation, as in docs/belief.md, "How far the finger travelled":
//   mark            a measured length with its variance, of the rows that were joined for it: Travel::Mark
//   sd              of the difference of two lengths: with `per_row_` for each row between them where errors add up
//   apart           two lengths that differ by `kFarthest` sd or more: `certain`
// Follows docs/belief.md, the paragraph named above.
// Idea: steps between noisy lengths add up to far more than was travelled. So each length is compared with the last one
// that is apart from it for certain, and the way between them is spread evenly over the rows in between, once.
namespace rollfix::belief {

namespace {

// Of what lies between two lengths that are apart for certain, no more than this many times is given out: without it a
// rest would go on with what came before it, and with less room chance would take away more than it adds.
constexpr double kMostGivenOut = 1.1;

}  // namespace

double Travel::since_last(const Mark& mark) const {
  const double rows = mark.row - marks_.back().row;
  Mark nearer = mark;
  for (std::size_t k = marks_.size(); k-- > 0;) {
    const Mark& other = marks_[k];
    const double apart = std::abs(mark.length - other.length);
    const double certain =
        kFarthest * std::sqrt(mark.variance + other.variance + per_row_ * std::abs(mark.row - other.row));
    if (apart >= certain) {
      if (k + 1 == marks_.size()) return apart;
      // Between the two the length was just that far off.
      const double near_apart = std::abs(mark.length - nearer.length);
      const double share = std::clamp((certain - near_apart) / (apart - near_apart), 0.0, 1.0);
      const double row = nearer.row + share * (other.row - nearer.row);
      const double so_far = so_far_[k + 1] + share * (so_far_[k] - so_far_[k + 1]);
      const double left = kMostGivenOut * certain - (so_far_.back() - so_far);
      return std::clamp(left, 0.0, certain * rows / (mark.row - row));
    }
    nearer = other;
  }
  return std::abs(mark.length - marks_.front().length) * rows / (mark.row - marks_.front().row);
}

double Travel::add(const Mark& mark) {
  const double travelled = since_last(mark);
  so_far_.push_back(so_far_.back() + travelled);
  marks_.push_back(mark);
  return travelled;
}

void Travel::restart() {
  marks_.resize(1);
  so_far_.resize(1);
}

}  // namespace rollfix::belief
