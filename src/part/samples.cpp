#include "rollfix/part.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace rollfix {
namespace {

/// Curvatures that are this much alike, by the larger of them or by that of a circle as long as the part, do not jump.
constexpr double kAlike = 1e-6;
/// No stretch is halved more often: the turn of one so short is its rounding.
constexpr int kMostHalvings = 40;

class Sampler {
 public:
  explicit Sampler(const Part& part) : part_(part), longest_(kSampleShare * part.perimeter()) {}

  std::vector<BoundarySample> samples() {
    for (const Spiral& spiral : part_.turning().spirals()) {
      if (out_.empty() || jumps(out_.back(), spiral.start)) add(spiral.lo, spiral.start);
      fill(spiral, {spiral.lo, spiral.hi}, spiral.start, spiral.end, 0);
      add(spiral.hi, spiral.end);
    }
    return std::move(out_);
  }

 private:
  void add(double s, const Turning& at) { out_.push_back({s, part_.point(s), at.angle, at.curvature}); }

  bool jumps(const BoundarySample& before, const Turning& after) const {
    const double size =
        std::max({std::abs(before.curvature), std::abs(after.curvature), 2 * std::numbers::pi / part_.perimeter()});
    return std::abs(after.angle - before.tangent) > kAlike ||
           std::abs(after.curvature - before.curvature) > kAlike * size;
  }

  /// What lies between two samples, halved until they are near enough.
  void fill(const Spiral& spiral, const Interval& range, const Turning& first, const Turning& last, int halvings) {
    const bool is_near = range.width() <= longest_ && std::abs(last.angle - first.angle) <= kSampleTurn;
    if (is_near || halvings == kMostHalvings) return;
    const double middle = range.middle();
    if (!(range.lo < middle && middle < range.hi)) return;  // a bend so small that its places are one number
    const Turning at = part_.turning().on_spiral(spiral, middle);
    fill(spiral, {range.lo, middle}, first, at, halvings + 1);
    add(middle, at);
    fill(spiral, {middle, range.hi}, at, last, halvings + 1);
  }

  const Part& part_;
  double longest_;
  std::vector<BoundarySample> out_;
};

}  // namespace

std::vector<BoundarySample> samples_of(const Part& part) { return Sampler(part).samples(); }

}  // namespace rollfix
