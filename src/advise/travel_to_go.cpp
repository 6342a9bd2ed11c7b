#include "advise/travel_to_go.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rollfix/turning_function.hpp"

namespace rollfix::belief {
namespace {

// Of a wide placement, what is nearer to each other than this share of the perimeter need not be told apart: a region
// of a posterior that is twice as long is called a stretch.
constexpr double kOnePlace = 0.05;
constexpr double kNotTold = std::numeric_limits<double>::infinity();

}  // namespace

Travel::Travel(const std::vector<PartHypothesis>& hypotheses, const Comparison& back, const Comparison& forward)
    : hypotheses_(hypotheses), back_(back), forward_(forward) {
  const std::size_t n = hypotheses.size();
  others_.resize(n);
  for (const PartHypothesis& one : hypotheses) of_label_[one.hypothesis.label] += one.hypothesis.probability;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) add_other(i, j);
  }
}

bool Travel::tells_any() const {
  return std::any_of(others_.begin(), others_.end(), [](const auto& others) { return !others.empty(); });
}

double Travel::after(double x) const {
  double on = 0;
  double back = 0;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    const auto [if_on, if_back] = left_after(i, x);
    on += hypotheses_[i].hypothesis.probability * if_on;
    back += hypotheses_[i].hypothesis.probability * if_back;
  }
  return std::abs(x) + std::min(on, back);
}

double Travel::open_after(double x) const {
  double open = 0;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    if (is_open_after(i, x)) open += hypotheses_[i].hypothesis.probability;
  }
  return open;
}

bool Travel::matters(std::size_t i, std::size_t j) const { return i != j && !are_one_place(i, j) && counts(j); }

void Travel::add_other(std::size_t i, std::size_t j) {
  if (!matters(i, j)) return;
  for (std::size_t how = 0; how < 2; ++how) {
    const Other other{forward_.told(i, j)[how], back_.told(i, j)[how]};
    if (std::min(other.forward, other.back) == kNotTold) continue;
    others_[i].push_back(other);
    return;
  }
}

/// Of one placement, which need not get narrower than that.
bool Travel::are_one_place(std::size_t i, std::size_t j) const {
  const Part& part = *hypotheses_[i].part;
  const Hypothesis& one = hypotheses_[i].hypothesis;
  const Hypothesis& other = hypotheses_[j].hypothesis;
  if (one.label != other.label) return false;
  for (std::size_t k = 0; k < one.place.size(); ++k) {
    if (part.boundary().distance(one.place[k], other.place[k]) >= kOnePlace * part.perimeter()) return false;
  }
  return true;
}

bool Travel::is_open_after(std::size_t i, double x) const {
  return std::any_of(others_[i].begin(), others_[i].end(),
                     [&](const Other& other) { return x == 0 || (x > 0 ? other.forward : other.back) > std::abs(x); });
}

/// If i is the true one, the travel that is left: as far on as it takes and back only for what that alone tells, and
/// the reverse.
std::array<double, 2> Travel::left_after(std::size_t i, double x) const {
  const double rolled = std::abs(x);
  std::vector<Other> left;  // seen from here: those not told yet, on the same way and on the other one
  Other only{0, 0};         // ... those that one way alone tells
  for (Other other : others_[i]) {
    if (x < 0) std::swap(other.forward, other.back);
    if (x != 0 && other.forward <= rolled) continue;
    left.push_back(other);
    if (other.back == kNotTold) only.forward = std::max(only.forward, other.forward);
    if (other.forward == kNotTold) only.back = std::max(only.back, other.back);
  }
  if (left.empty()) return {0, 0};
  Other mostly_on = only;
  Other mostly_back = only;
  for (const Other& other : left) {
    if (other.back > only.back) mostly_on.forward = std::max(mostly_on.forward, other.forward);
    if (other.forward > only.forward) mostly_back.back = std::max(mostly_back.back, other.back);
  }
  return {shorter_way(mostly_on, rolled), shorter_way(mostly_back, rolled)};
}

/// To both ends, from a place that far ahead of where both are counted from.
double Travel::shorter_way(const Other& ends, double rolled) {
  const double on = std::max(ends.forward - rolled, 0.0);
  const double back = ends.back > 0 ? ends.back + rolled : 0;
  return on + back + std::min(on, back);
}

}  // namespace rollfix::belief
