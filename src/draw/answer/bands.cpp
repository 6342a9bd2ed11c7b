// Stretches of the boundary, under its line: what fits with a placement, and with noise what holds 95 % of it.

#include <algorithm>
#include <cmath>

#include "draw/answer/answer_plan.hpp"

namespace rollfix::draw {
namespace {

constexpr double kFaintest = 0.2;   // opacity of the interval of an improbable place, ...
constexpr double kStrongest = 0.6;  // ... and of the only one

class Bands {
 public:
  Bands(Svg& svg, const Plan& plan, const Scene& scene) : svg_(svg), plan_(plan), scene_(scene) {}

  void of_placements() {
    const auto broad = [](std::string_view colour, std::string_view dash = "") {
      return stroke(colour, 10, dash, 0.32);
    };
    for (const Way& way : plan_.ways) {
      const Interval& extent = plan_.placement(way).extent[0];
      const bool wide = scene_.pixels(extent.width()) > kVisibleExtent;
      if (plan_.placement(way).kind == Kind::stretch || wide) band(extent, broad(plan_.colour_of(way)), "extent");
    }
    for (const PerFinger<Interval>& stretch : plan_.figure->answer->unresolved) {
      band(stretch[0], broad(kSoftInk, "1 13"), "unresolved");
    }
  }

  void of_modes() {
    for (std::size_t finger = 0; finger < plan_.figure->answer->finger_count(); ++finger) {
      for (std::size_t k = 0; k < plan_.placements().size(); ++k) {
        if (scene_.pixels(plan_.held(k, finger).width()) < kVisibleBand) continue;
        const double opacity = std::lerp(kFaintest, kStrongest, plan_.placements()[k].probability);
        band(plan_.held(k, finger), stroke(plan_.colour_of(k, finger), 6, "", opacity), "interval");
      }
    }
  }

  void of_fingers() {
    for (std::size_t finger = 0; finger < 2; ++finger) {
      // Both are seen where they overlap.
      const Paint paint = stroke(kFingerColours[finger], finger == 0 ? 11 : 7, "", 0.25);
      std::vector<Interval> drawn;  // several placements may have one in common
      for (const Placement& placement : plan_.placements()) {
        const Interval& extent = placement.extent[finger];
        // All of a loop needs no band: the square says so.
        if (placement.whole_loop[finger] || scene_.pixels(extent.width()) <= kVisibleExtent) continue;
        const auto same = [&](const Interval& other) {
          return scene_.pixels(std::abs(other.lo - extent.lo) + std::abs(other.hi - extent.hi)) < 1;
        };
        if (std::any_of(drawn.begin(), drawn.end(), same)) continue;
        drawn.push_back(extent);
        band(extent, paint, "extent");
      }
    }
  }

 private:
  void band(const Interval& extent, const Paint& paint, std::string_view name) {
    svg_.open_group(name);
    svg_.polyline(slice(scene_.boundary, extent.lo, extent.hi).points, paint);
    svg_.close_group();
  }

  Svg& svg_;
  const Plan& plan_;
  const Scene& scene_;
};

}  // namespace

void draw_bands(Svg& svg, const Plan& plan, const Scene& scene) {
  Bands bands(svg, plan, scene);
  if (plan.has_noise()) {
    bands.of_modes();
  } else if (plan.has_pairs()) {
    bands.of_fingers();
  } else {
    bands.of_placements();
  }
}

}  // namespace rollfix::draw
