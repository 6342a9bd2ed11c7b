#include "residuals.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

// Notation:
//   f_k(s)          Theta(s + L_k) - Theta(s) - theta_k of reading k: `f_[k]`
//   f_j - f_k       does not know the tangent at s; where both fit it is within twice the tolerance: `exclusion_by_two`
//   excluded        the bound that |f| has to be outside of: `excluded()`
//   step            the least distance between places: `step_`
// Follows docs/certificates.md, "What is in it": the cell `apart`, by one reading or by two.
// Idea: of all readings the one that is furthest off at the nearer end is tried first. At a convex corner where the
// roll starts all readings share one pivot, which each of them alone may fit, and two together can exclude.
namespace rollfix {
namespace {

// A row on the edge of what is excluded is off by more than the tolerance by at least this share of it.
constexpr double kLeastMiss = 1e-3;
// Two readings are tried together on what is narrower than so many steps: around a corner.
constexpr double kManySteps = 20;

/// The stretches that are in a list and in another one, both by rising s.
std::vector<Interval> common(const std::vector<Interval>& some, const std::vector<Interval>& others) {
  std::vector<Interval> result;
  for (const Interval& one : some) {
    for (const Interval& other : others) {
      const Interval both{std::max(one.lo, other.lo), std::min(one.hi, other.hi)};
      if (both.lo < both.hi) result.push_back(both);
    }
  }
  return result;
}

}  // namespace

Residuals::Residuals(const Part& part, const std::vector<Reading>& readings, double tolerance)
    : part_(part), readings_(readings), tolerance_(tolerance), step_(least_step(part)) {
  for (const Reading& reading : readings) {
    f_.emplace_back(part, reading);
    lengths_.push_back(reading.length[0]);
  }
}

double Residuals::size(double s) const {
  double largest = 0;
  for (const Residual& f : f_) largest = std::max(largest, f.size(s));
  return largest;
}

bool Residuals::jumps(double lo, double hi) const {
  return std::any_of(f_.begin(), f_.end(), [&](const Residual& f) { return f.jumps(lo, hi); });
}

double Residuals::edge() const { return (1 + kLeastMiss) * tolerance_ + (f_.size() > 1 ? kTurnAccuracy : 0); }

double Residuals::excluded() const { return f_.size() > 1 ? edge() : tolerance_; }

/// Where f is outside of that bound all the way.
std::optional<Exclusion> Residuals::exclusion(const Residual& f, double bound, double lo, double hi) const {
  const double ends = std::min(f.size(lo), f.size(hi));
  if (ends <= bound) return std::nullopt;
  const double nearest = clear(f.nearest(lo, hi), 1);
  if (f.size(nearest) <= bound || f.is_near_at_joints(bound, lo, hi)) return std::nullopt;
  const bool is_inside = nearest > lo + step_ && nearest < hi - step_;
  return is_inside && f.size(nearest) < ends ? Exclusion{{}, nearest} : Exclusion{};
}

/// The readings that are furthest off at the nearer end come first.
std::optional<Exclusion> Residuals::exclusion_by_one(double lo, double hi) const {
  const auto miss = [&](std::size_t k) { return std::min(f_[k].size(lo), f_[k].size(hi)); };
  std::vector<std::size_t> order(f_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::size_t one, std::size_t other) { return miss(one) > miss(other); });
  for (const std::size_t k : order) {
    if (const auto found = exclusion(f_[k], excluded(), lo, hi)) return Exclusion{{k}, found->row};
  }
  return std::nullopt;
}

/// At a corner where the roll starts all readings pivot by one angle, which each of them alone may fit.
std::optional<Exclusion> Residuals::exclusion_by_two(double lo, double hi) const {
  for (std::size_t k = 0; k < f_.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      const Residual f = Residual::difference(part_, readings_[j], readings_[k]);
      if (const auto found = exclusion(f, 2 * excluded(), lo, hi)) return Exclusion{{j, k}, found->row};
    }
  }
  return std::nullopt;
}

std::optional<Exclusion> Residuals::exclusion(double lo, double hi) const {
  const auto found = exclusion_by_one(lo, hi);
  return found || hi - lo >= kManySteps * step_ ? found : exclusion_by_two(lo, hi);
}

double Residuals::split(double lo, double hi) const {
  const double period = part_.perimeter();
  const double beside = 4 * step_;
  const auto is_inside = [&](double s) { return s > lo + step_ && s < hi - step_; };
  for (const Corner& corner : part_.corners()) {
    if (corner.is_concave()) continue;
    const double s = corner.s + (part_.closed() ? period * std::ceil((lo - corner.s) / period) : 0);
    if (is_inside(s + beside)) return clear(s + beside, 1);
    if (is_inside(s - beside)) return clear(s - beside, -1);
  }
  return clear(0.5 * (lo + hi), 1);
}

std::vector<Interval> Residuals::flat(double lo, double hi) const {
  std::vector<Interval> all = f_[0].flat(lo, hi);
  for (std::size_t k = 1; k < f_.size(); ++k) all = common(all, f_[k].flat(lo, hi));
  return all;
}

}  // namespace rollfix
