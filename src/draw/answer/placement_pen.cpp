#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "draw/answer/answer_plan.hpp"
#include "draw/answer/densities.hpp"

// Along the boundary: under its line stretches of what fits with a placement, and with noise what holds 95 % of it;
// outside of it areas as high as the first contacts are dense there.
namespace rollfix::draw {
namespace {

constexpr double kFaintest = 0.2;   // opacity of the interval of an improbable place, ...
constexpr double kStrongest = 0.6;  // ... and of the only one

class Bands {
 public:
  Bands(Svg& svg, const AnswerPlan& plan, const Scene& scene) : svg_(svg), plan_(plan), scene_(scene) {}

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
  const AnswerPlan& plan_;
  const Scene& scene_;
};

constexpr double kRibbonHeight = 34;   // of the highest, pixels
constexpr double kRibbonBin = 1.5;     // along the boundary, pixels
constexpr double kRibbonSmooth = 2.5;  // bins: a sharper peak would be seen as a line, and a broad one not at all
constexpr double kLeastHeight = 0.4;   // pixels
constexpr std::size_t kMostBins = 6000;

class Ribbons {
 public:
  Ribbons(Svg& svg, const AnswerPlan& plan, const Scene& scene, const Clearance& clearance, Obstacles& obstacles,
          std::size_t finger)
      : svg_(svg),
        plan_(plan),
        scene_(scene),
        clearance_(clearance),
        obstacles_(obstacles),
        finger_(finger),
        places_(plan.part().boundary()) {
    const double wanted = std::ceil(scene.pixels(places_.perimeter) / kRibbonBin);
    const std::size_t count = std::clamp(static_cast<std::size_t>(wanted), std::size_t{8}, kMostBins);
    const Density& density = plan.figure->answer->weighing->density[finger];
    heights_ = smoothed(binned(density, places_, places_.full_arc(), count), kRibbonSmooth, places_.closed);
    step_ = places_.perimeter / static_cast<double>(count);
  }

  double most() const { return *std::max_element(heights_.begin(), heights_.end()); }

  void draw(double most) {
    if (!(most > 0)) return;
    for (double& height : heights_) height *= kRibbonHeight / most;
    const std::size_t first = valley();
    std::size_t begin = first;
    for (std::size_t k = first; k < first + heights_.size(); ++k) {
      const bool is_last = k + 1 == first + heights_.size();
      if (!is_last && is_drawn(k) == is_drawn(k + 1) && owner(k) == owner(k + 1)) continue;
      if (is_drawn(k)) area(begin, k + 1);
      begin = k + 1;
    }
  }

 private:
  double height(std::size_t k) const { return heights_[k % heights_.size()]; }
  bool is_drawn(std::size_t k) const { return height(k) > kLeastHeight; }

  /// Where to begin on a closed boundary: where nothing is cut in two.
  std::size_t valley() const {
    if (!places_.closed) return 0;
    return static_cast<std::size_t>(std::min_element(heights_.begin(), heights_.end()) - heights_.begin());
  }

  /// The placement that a bin belongs to: the nearest.
  std::size_t owner(std::size_t k) const {
    const double s = (static_cast<double>(k) + 0.5) * step_;
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
      const double off = places_.distance(plan_.placements()[i].interval[finger_], places_.base(s));
      if (off >= least) continue;
      least = off;
      nearest = i;
    }
    return nearest;
  }

  void area(std::size_t begin, std::size_t end) {
    const double lo = static_cast<double>(begin) * step_, hi = static_cast<double>(end) * step_;
    const Trace stretch = slice(scene_.boundary, lo, hi);
    const auto offset = [&](double s) {
      const double at = std::clamp((s - lo) / step_ - 0.5, 0.0, static_cast<double>(end - begin - 1));
      const auto k = static_cast<std::size_t>(at);
      const std::size_t next = std::min(begin + k + 1, end - 1);
      return std::lerp(height(begin + k), height(next), at - static_cast<double>(k));
    };
    const std::vector<Vec2> rim = path_beside(stretch, clearance_, offset);
    std::vector<Vec2> polygon = stretch.points;
    polygon.insert(polygon.end(), rim.rbegin(), rim.rend());
    polygon = pick(polygon, simplify(polygon, kInvisible, kMostVertices));
    const std::string_view colour = plan_.colour_of(owner(begin), finger_);
    svg_.open_group("density");
    svg_.polygon(polygon, filled(colour, 0.28));
    svg_.polyline(pick(rim, simplify(rim, kInvisible, kMostVertices)), stroke(colour, 0.9, "", 0.8));
    svg_.close_group();
    obstacles_.add(rim);
    obstacles_.add(path_beside(stretch, clearance_, [&](double s) { return 0.5 * offset(s); }));
  }

  Svg& svg_;
  const AnswerPlan& plan_;
  const Scene& scene_;
  const Clearance& clearance_;
  Obstacles& obstacles_;
  std::size_t finger_;
  Boundary places_;
  std::vector<double> heights_;
  double step_ = 1;
};

}  // namespace

void draw_bands(Svg& svg, const AnswerPlan& plan, const Scene& scene) {
  Bands bands(svg, plan, scene);
  if (plan.has_noise()) {
    bands.of_modes();
  } else if (plan.has_pairs()) {
    bands.of_fingers();
  } else {
    bands.of_placements();
  }
}

void draw_ribbons(Svg& svg, const AnswerPlan& plan, const Scene& scene, const Clearance& clearance,
                  Obstacles& obstacles) {
  std::vector<Ribbons> fingers;
  double most = 0;
  for (std::size_t finger = 0; finger < plan.figure->answer->finger_count(); ++finger) {
    if (plan.figure->answer->weighing->density[finger].empty()) return;
    fingers.emplace_back(svg, plan, scene, clearance, obstacles, finger);
    most = std::max(most, fingers.back().most());
  }
  for (Ribbons& ribbons : fingers) ribbons.draw(most);
}

// ---- placements

namespace {

constexpr std::size_t kMostArcPoints = 100000;     // of all arcs of one finger together
constexpr std::size_t kMostPairArcPoints = 20000;  // of each arc of two
constexpr double kStartSize = 3.1;                 // pixels
constexpr double kPairArcWidth = 2.6;
constexpr double kDotNumberSize = 10;
constexpr double kSameDot = 3;          // dots that are closer together get one label
constexpr std::size_t kMostListed = 4;  // numbers in a label
constexpr double kFaintestInk = 0.25;   // of an improbable place's colour, the rest is paper

std::string listed(const std::vector<std::size_t>& numbers) {
  const std::size_t count = std::min(numbers.size(), kMostListed);
  std::string text = fmt::format("{}", fmt::join(numbers.begin(), numbers.begin() + static_cast<long>(count), ","));
  return numbers.size() > count ? text + "\u2026" : text;
}

/// "#rrggbb" with so much of it left on white paper. A mixed colour rather than a translucent one: where arcs and their
/// heads overlap nothing shows through.
std::string on_paper(std::string_view colour, double strength) {
  std::string mixed = "#";
  for (const std::size_t at : {1U, 3U, 5U}) {
    int channel = 0;
    std::from_chars(colour.data() + at, colour.data() + at + 2, channel, 16);
    mixed += fmt::format("{:02x}", std::lround(std::lerp(255.0, static_cast<double>(channel), strength)));
  }
  return mixed;
}

}  // namespace

void PlacementPen::draw() {
  if (plan_.has_pairs()) {
    dots();
    rolls_of_both();
  } else if (plan_.has_arcs()) {
    rolls_of_all();
  } else {
    ticks();
  }
}

std::string PlacementPen::ink(const Way& way) const { return ink(way, plan_.colour_of(way)); }

std::string PlacementPen::ink(const Way& way, std::string_view colour) const {
  if (!plan_.fades || !plan_.has_noise()) return std::string(colour);
  return on_paper(colour, std::lerp(kFaintestInk, 1, plan_.strength(way.placement)));
}

// ---- the rolls

void PlacementPen::add_arcs(std::size_t way, std::size_t most_points, std::vector<Arc>& arcs) const {
  for (const Run& run : plan_.roll(plan_.ways[way]).runs) {
    const auto offset = [&](double travelled) { return plan_.offset(way, run, travelled); };
    arcs.push_back({way, &run, pen_.path(plan_.start(plan_.ways[way]), run, offset, most_points)});
  }
}

void PlacementPen::stems(const std::vector<Arc>& arcs) {
  for (const Arc& arc : arcs) {
    const Way& way = plan_.ways[arc.way];
    pen_.stems(plan_.start(way), *arc.run, arc.path, ink(way));
  }
}

void PlacementPen::lines(const std::vector<Arc>& arcs) {
  for (const Arc& arc : arcs) {
    const Way& way = plan_.ways[arc.way];
    const double width = plan_.has_pairs() ? kPairArcWidth : plan_.line_width(way);
    pen_.arc(arc.path, ink(way), width, !plan_.roll(way).tangled);
  }
}

void PlacementPen::rolls_of_all() {
  std::vector<Arc> arcs;
  for (std::size_t i = 0; i < plan_.ways.size(); ++i) add_arcs(i, kMostArcPoints / plan_.ways.size(), arcs);
  svg_.open_group("stems");
  stems(arcs);
  svg_.close_group();
  lines(arcs);
  // The starts lie on the ends, and are smaller: both can be seen where they meet.
  for (const Way& way : plan_.ways) {
    for (std::size_t k = 1; k <= plan_.roll(way).contacts.size(); ++k) marker(way, k);
  }
  for (const Way& way : plan_.ways) marker(way, 0);
  for (std::size_t i = 0; plan_.has_labels() && i < plan_.ways.size(); ++i) {
    for (std::size_t k = 0; k <= plan_.roll(plan_.ways[i]).contacts.size(); ++k) label(i, k, arcs);
  }
}

void PlacementPen::rolls_of_both() {
  for (std::size_t i = 0; i < plan_.ways.size(); ++i) {
    std::vector<Arc> arcs;
    add_arcs(i, kMostPairArcPoints, arcs);
    stems(arcs);
    lines(arcs);
    for (std::size_t k = plan_.roll(plan_.ways[i]).contacts.size() + 1; k-- > 0;) {
      marker(plan_.ways[i], k);
      label(i, k, arcs);
    }
  }
}

/// At contact k of a way, if it has a name.
void PlacementPen::marker(const Way& way, std::size_t k) {
  if (!plan_.is_named(k)) return;
  const double s = plan_.place(way, k);
  if (k == 0) {
    pen_.start(s, ink(way), marker_size(way, k));
  } else {
    pen_.contact(s, ink(way), marker_size(way, k));
  }
}

double PlacementPen::marker_size(const Way& way, std::size_t k) const {
  if (plan_.has_pairs() && k == 0) return way.finger == 0 ? 4.8 : 3.2;
  if (plan_.has_pairs()) return way.finger == 0 ? 4.2 : 2.4;
  const double size = k == 0 ? kStartSize : k == plan_.roll(way).contacts.size() ? 3.9 : 2.6;
  return std::min(size, (1.2 + 0.35 * plan_.spacing) * size / kStartSize);  // smaller where lanes are close together
}

/// The name of contact k, at the boundary or at the end of an arc that meets it there.
void PlacementPen::label(std::size_t i, std::size_t k, const std::vector<Arc>& arcs) {
  if (!plan_.is_named(k)) return;
  const Way& way = plan_.ways[i];
  const double s = plan_.place(way, k), travelled = plan_.travelled(way, k);
  std::vector<Vec2> anchors = {scene_.at(s)};
  for (const Arc& arc : arcs) {
    if (arc.way != i) continue;
    if (arc.run->from == travelled) anchors.push_back(arc.path.front());
    if (arc.run->to == travelled) anchors.push_back(arc.path.back());
  }
  const Text name = k == 0 && !plan_.fades ? start_name(plan_, way) : contact_name(plan_, way, k);
  labels_.add(std::move(anchors), scene_.normal(s), name, plan_.colour_of(way), plan_.label_size);
}

// ---- without rolls

void PlacementPen::ticks() {
  std::map<std::string, std::vector<Vec2>> all;  // by their ink: a path each
  for (const Way& way : plan_.ways) {
    std::vector<Vec2>& ends = all[ink(way, colour(0))];
    const Vec2 at = scene_.at(plan_.start(way)), normal = scene_.normal(plan_.start(way));
    ends.emplace_back(at + 2 * normal);
    ends.emplace_back(at + 9 * normal);
  }
  svg_.open_group("starts");
  for (const auto& [shade, ends] : all) svg_.segments(ends, stroke(shade, 1));
  svg_.close_group();
}

/// First contacts of those whose rolls are not shown.
void PlacementPen::dots() {
  svg_.open_group("starts");
  for (std::size_t finger = 0; finger < 2; ++finger) dots_of(finger);
  svg_.close_group();
}

/// Numbers of dots on top of each other share a label.
void PlacementPen::dots_of(std::size_t finger) {
  std::vector<std::pair<double, std::vector<std::size_t>>> places;
  for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
    if (plan_.shown == i) continue;
    const double s = plan_.placements()[i].start[finger];
    const auto same = std::find_if(places.begin(), places.end(), [&](const auto& place) {
      return (scene_.at(place.first) - scene_.at(s)).norm() < kSameDot;
    });
    if (same != places.end()) {
      same->second.push_back(i);
    } else {
      places.push_back({s, {i}});
    }
  }
  for (const auto& [s, numbers] : places) {
    const std::string colour = ink({numbers.front(), finger});
    if (finger == 0) {
      pen_.start(s, colour, 3.6);
    } else {
      pen_.contact(s, colour, 2.4);
    }
    if (!plan_.has_labels()) continue;
    labels_.add({scene_.at(s)}, scene_.normal(s), {{listed(numbers)}}, kFingerColours[finger], kDotNumberSize);
  }
}

}  // namespace rollfix::draw
