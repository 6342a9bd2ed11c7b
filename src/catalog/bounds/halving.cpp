#include "halving.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "least_cost.hpp"
#include "part/turning_range.hpp"
#include "rounding.hpp"

// Notation:
//   s, L            starts on a stretch of one part; a reading's length with its slack gives the interval of ends
//   tau             the tangent at the start: what Theta on the stretch and every reading leave of it: `tangent`
//   slack, box      how far a reading's turn may be off as if it had no error of its own, and with the most that it can
//                   have
//   cost            least sum of squares of all errors, in standard deviations: `least_cost`
// Follows docs/identify.md, "How parts are ruled out": the last step, with exact bounds on Theta (turning_range.hpp).
// Idea: the same as cells.cpp, on stretches that are halved down to `kShortest` of the perimeter: there the search
// takes over.
namespace rollfix {
namespace {

// A stretch is not halved below this share of the perimeter: the search takes over.
constexpr double kShortest = 1.0 / 4096;

/// One start at a time.
using One = Eigen::Array<double, 1, 1>;

/// The halves of stretches of one part.
class Halving {
 public:
  Halving(const Part& part, const Clues& clues) : part_(part), turning_(part.turning()), clues_(clues) {
    for (const Clue& clue : clues.clues) {
      slack_.push_back(clue.slack(turning_.most_curvature()) + kTurnRounding);
      box_.push_back(slack_.back() + std::sqrt(clues.most_cost) * (clue.turn_sd + clues.shared_sd));
    }
  }

  bool may_start(const Interval& stretch) const {
    if (!fits(stretch)) return false;
    if (stretch.width() <= kShortest * part_.perimeter()) return true;
    const double middle = stretch.lo + 0.5 * stretch.width();
    return may_start({stretch.lo, middle}) || may_start({middle, stretch.hi});
  }

 private:
  bool fits(const Interval& stretch) const {
    const Interval start = angles_over(turning_, stretch);
    Interval tangent = start;
    std::vector<Asked<One>> asked;
    for (std::size_t k = 0; k < slack_.size(); ++k) {
      const Clue& clue = clues_.clues[k];
      const double off = clue.length_slack + kShareRounding * (std::abs(clue.length[0]) + part_.perimeter());
      Interval end{stretch.lo + clue.length[0] - off, stretch.hi + clue.length[0] + off};
      if (!part_.closed()) {
        end = {std::max(end.lo, 0.0), std::min(end.hi, part_.perimeter())};
        if (end.hi < end.lo) return false;
      }
      const Interval angles = angles_over(turning_, end);
      tangent = {std::max(tangent.lo, angles.lo - clue.turn - box_[k]),
                 std::min(tangent.hi, angles.hi - clue.turn + box_[k])};
      if (!(tangent.lo <= tangent.hi)) return false;
      if (clue.turn_sd <= 0) continue;
      asked.push_back({One(angles.lo - clue.turn - slack_[k]), One(angles.hi - clue.turn + slack_[k]),
                       1 / (clue.turn_sd * clue.turn_sd)});
    }
    if (clues_.most_cost == 0) return true;
    const Start<One> one{One(start.lo), One(start.hi), clues_.shared_sd};
    return least_cost(one, asked, clues_.most_cost)[0] <= clues_.most_cost;
  }

  const Part& part_;
  const TurningFunction& turning_;
  const Clues& clues_;
  std::vector<double> slack_;
  std::vector<double> box_;
};

}  // namespace

bool may_start(const Part& part, const Clues& clues, const Cells<kFineCells>& cells) {
  const Halving halving(part, clues);
  const double step = part.perimeter() / kFineCells;
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const auto at = static_cast<double>(k);
    if (cells[k] && halving.may_start({step * at, step * (at + 1)})) return true;
  }
  return false;
}

}  // namespace rollfix
