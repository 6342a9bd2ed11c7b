#include "rollfix/draw/answer_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "draw/answer/answer_plan.hpp"
#include "draw/labels.hpp"
#include "draw/legend.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace draw {
namespace {

constexpr std::size_t kMostArcPoints = 100000;     // of all arcs of one finger together
constexpr std::size_t kMostPairArcPoints = 20000;  // of each arc of two
constexpr double kStartSize = 3.1;                 // pixels
constexpr double kPairArcWidth = 2.6;
constexpr double kDotNumberSize = 10;
constexpr double kWorldHeight = 340;    // below two fingers' square, pixels
constexpr double kVisibleBand = 2;      // a narrower interval is its contact's mark, pixels
constexpr double kFaintest = 0.2;       // opacity of the interval of an improbable place, ...
constexpr double kStrongest = 0.6;      // ... and of the only one
constexpr double kSameDot = 3;          // dots that are closer together get one label
constexpr std::size_t kMostListed = 4;  // numbers in a label

/// One plan on a page of its own, drawn from the bottom to the top.
class AnswerPicture {
 public:
  explicit AnswerPicture(const Plan& plan)
      : plan_(plan),
        legend_(legend_of(plan)),
        drawing_end_(kHeaderHeight + drawing_height(plan.framing)),
        svg_(plan.width(), drawing_end_ + legend_.height() + below_height(plan) + 8),
        scene_(make_scene(plan.part(), plan.framing, Vec2(0, kHeaderHeight))),
        clearance_(scene_.boundary),
        obstacles_(scene_.area.max().x(), drawing_end_),
        pen_(svg_, scene_, clearance_, obstacles_) {}

  Svg draw() {
    const AnswerFigure& figure = *plan_.figure;
    draw_header(svg_, figure.title.empty() ? plan_.part().name() : figure.title, figure.answer->verdict.text(),
                small_print(plan_));
    svg_.open_clip(scene_.area.min().x(), scene_.area.min().y(), scene_.area.sizes().x(), scene_.area.sizes().y());
    draw_material(svg_, scene_, plan_.part());
    draw_others(svg_, scene_, figure.others);
    if (plan_.has_noise()) {
      draw_ribbons(svg_, plan_, scene_, clearance_, obstacles_);
      bands_of_modes();
    } else if (plan_.has_pairs()) {
      bands_of_fingers();
    } else {
      bands_of_placements();
    }
    for (const Way& way : plan_.ways) finger(way);
    draw_boundary(svg_, scene_, plan_.part());
    obstacles_.add(scene_.boundary.points);
    draw_corners(svg_, scene_, plan_.part(), obstacles_);
    draw_origin(svg_, scene_, obstacles_);
    if (plan_.has_pairs()) {
      dots();
      rolls_of_both();
    } else if (plan_.has_arcs()) {
      rolls_of_all();
    } else {
      ticks();
    }
    draw_scale_bar(svg_, scene_, plan_.part());
    draw_key();
    labels_.add({scene_.at(0)}, scene_.normal(0), {{"s", true, false, false}, {" = 0"}}, kSoftInk, 10);
    labels_.draw(svg_, obstacles_);
    svg_.close_group();
    if (plan_.has_pairs()) draw_pair_plane(svg_, plan_);
    legend_.draw(svg_, drawing_end_);
    const double below = drawing_end_ + legend_.height();
    draw_spread(svg_, plan_, below);
    if (plan_.has_world()) draw_world(svg_, plan_, world_area(below));
    return std::move(svg_);
  }

 private:
  static double below_height(const Plan& plan) {
    const bool has_world_below = plan.has_pairs() && plan.has_world();
    return std::max(spread_height(plan), has_world_below ? kWorldHeight : 0);
  }

  Box world_area(double below) const {
    const double left = svg_.width() - world_width(plan_);
    if (plan_.has_pairs()) {
      const double from = spread_height(plan_) > 0 ? left : 0;
      return {Vec2(from, below), Vec2(svg_.width(), below + below_height(plan_))};
    }
    return {Vec2(left, kHeaderHeight), Vec2(svg_.width(), drawing_end_)};
  }

  // ---- under the boundary

  void band(const Interval& extent, const Paint& paint, std::string_view name) {
    svg_.open_group(name);
    svg_.polyline(slice(scene_.boundary, extent.lo, extent.hi).points, paint);
    svg_.close_group();
  }

  void bands_of_placements() {
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

  /// With noise: what holds 95 % of each.
  void bands_of_modes() {
    for (std::size_t finger = 0; finger < figure_fingers(); ++finger) {
      for (std::size_t k = 0; k < plan_.placements().size(); ++k) {
        if (scene_.pixels(plan_.held(k, finger).width()) < kVisibleBand) continue;
        const double opacity = std::lerp(kFaintest, kStrongest, plan_.placements()[k].probability);
        band(plan_.held(k, finger), stroke(plan_.colour_of(k, finger), 6, "", opacity), "interval");
      }
    }
  }

  std::size_t figure_fingers() const { return plan_.figure->answer->finger_count(); }

  /// At the lower right.
  void draw_key() {
    const std::string text = plan_.key();
    if (text.empty()) return;
    const Vec2 at = scene_.area.max() + Vec2(-kPageMargin, -7);
    svg_.text(at, {{text}}, {10, Align::end, std::string(kSoftInk)});
  }

  void bands_of_fingers() {
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

  /// The finger at both ends of a way. Its spoke is fixed to it; at the first contact it points at the part.
  void finger(const Way& way) {
    if (!plan_.has_finger(way)) return;
    const Placement& placement = plan_.placement(way);
    const double radius = *plan_.radius(way.finger);
    const double inward = placement.tangent[way.finger] + 0.5 * std::numbers::pi;
    svg_.open_group("finger");
    pen_.finger(plan_.part(), plan_.start(way), radius, inward);
    if (!plan_.roll(way).contacts.empty()) {
      const double length = plan_.roll(way).contacts.back();
      // L = -r du and Phi = du + dpsi give the finger's own turn dpsi.
      pen_.finger(plan_.part(), placement.end[way.finger], radius, inward + turn(way, length) + length / radius);
    }
    svg_.close_group();
  }

  /// Of the part's tangent over a way; the reading's own turn, where it is of one finger.
  double turn(const Way& way, double length) const {
    if (!plan_.has_pairs()) return plan_.figure->answer->readings.back().turn;
    const TurningFunction& turning = plan_.part().turning();
    return turning.angle(plan_.start(way) + length) - turning.angle(plan_.start(way));
  }

  // ---- the rolls

  /// The path of one run on the page, in the direction of the roll.
  struct Arc {
    std::size_t way;
    const Run* run;
    std::vector<Vec2> path;
  };

  void add_arcs(std::size_t way, std::size_t most_points, std::vector<Arc>& arcs) const {
    for (const Run& run : plan_.roll(plan_.ways[way]).runs) {
      const auto offset = [&](double travelled) { return plan_.offset(way, run, travelled); };
      arcs.push_back({way, &run, pen_.path(plan_.start(plan_.ways[way]), run, offset, most_points)});
    }
  }

  void stems(const std::vector<Arc>& arcs) {
    for (const Arc& arc : arcs) {
      const Way& way = plan_.ways[arc.way];
      pen_.stems(plan_.start(way), *arc.run, arc.path, plan_.colour_of(way));
    }
  }

  void lines(const std::vector<Arc>& arcs) {
    for (const Arc& arc : arcs) {
      const Way& way = plan_.ways[arc.way];
      const double width = plan_.has_pairs() ? kPairArcWidth : plan_.line_width(way);
      pen_.arc(arc.path, plan_.colour_of(way), width, !plan_.roll(way).tangled);
    }
  }

  void rolls_of_all() {
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

  void rolls_of_both() {
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
  void marker(const Way& way, std::size_t k) {
    if (!plan_.is_named(k)) return;
    const double s = plan_.place(way, k);
    if (k == 0) {
      pen_.start(s, plan_.colour_of(way), marker_size(way, k));
    } else {
      pen_.contact(s, plan_.colour_of(way), marker_size(way, k));
    }
  }

  double marker_size(const Way& way, std::size_t k) const {
    if (plan_.has_pairs() && k == 0) return way.finger == 0 ? 4.8 : 3.2;
    if (plan_.has_pairs()) return way.finger == 0 ? 4.2 : 2.4;
    const double size = k == 0 ? kStartSize : k == plan_.roll(way).contacts.size() ? 3.9 : 2.6;
    return std::min(size, (1.2 + 0.35 * plan_.spacing) * size / kStartSize);  // smaller where lanes are close together
  }

  /// The name of contact k, at the boundary or at the end of an arc that meets it there.
  void label(std::size_t i, std::size_t k, const std::vector<Arc>& arcs) {
    if (!plan_.is_named(k)) return;
    const Way& way = plan_.ways[i];
    const double s = plan_.place(way, k), travelled = plan_.travelled(way, k);
    std::vector<Vec2> anchors = {scene_.at(s)};
    for (const Arc& arc : arcs) {
      if (arc.way != i) continue;
      if (arc.run->from == travelled) anchors.push_back(arc.path.front());
      if (arc.run->to == travelled) anchors.push_back(arc.path.back());
    }
    const Text name = k == 0 ? start_name(plan_, way) : contact_name(plan_, way, k);
    labels_.add(std::move(anchors), scene_.normal(s), name, plan_.colour_of(way), plan_.has_pairs() ? 13.5 : 13);
  }

  // ---- without rolls

  /// More placements than arcs can show: a tick at each start.
  void ticks() {
    std::vector<Vec2> ends;
    for (const Way& way : plan_.ways) {
      const Vec2 at = scene_.at(plan_.start(way)), normal = scene_.normal(plan_.start(way));
      ends.emplace_back(at + 2 * normal);
      ends.emplace_back(at + 9 * normal);
    }
    svg_.open_group("starts");
    svg_.segments(ends, stroke(colour(0), 1));
    svg_.close_group();
  }

  /// First contacts of those whose rolls are not shown; numbers of dots on top of each other share a label.
  void dots() {
    svg_.open_group("starts");
    for (std::size_t finger = 0; finger < 2; ++finger) {
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
        if (finger == 0) {
          pen_.start(s, kFingerColours[finger], 3.6);
        } else {
          pen_.contact(s, kFingerColours[finger], 2.4);
        }
        if (!plan_.has_labels()) continue;
        labels_.add({scene_.at(s)}, scene_.normal(s), {{listed(numbers)}}, kFingerColours[finger], kDotNumberSize);
      }
    }
    svg_.close_group();
  }

  static std::string listed(const std::vector<std::size_t>& numbers) {
    const std::size_t count = std::min(numbers.size(), kMostListed);
    std::string text = fmt::format("{}", fmt::join(numbers.begin(), numbers.begin() + static_cast<long>(count), ","));
    return numbers.size() > count ? text + "\u2026" : text;
  }

  const Plan& plan_;
  Legend legend_;
  double drawing_end_;
  Svg svg_;
  Scene scene_;
  Clearance clearance_;
  Obstacles obstacles_;
  RollPen pen_;
  LabelSet labels_;
};

}  // namespace
}  // namespace draw

Svg draw_answer(const AnswerFigure& figure) {
  const draw::Plan plan = draw::plan_of(figure);
  return draw::AnswerPicture(plan).draw();
}

Svg side_by_side(const std::vector<AnswerFigure>& figures) {
  if (figures.empty()) throw InputError("a row of figures needs at least one, found none");
  std::vector<draw::Plan> plans;
  for (const AnswerFigure& figure : figures) plans.push_back(draw::plan_of(figure));
  for (draw::Plan& plan : plans) {
    for (const draw::Plan& other : plans) {
      if (&plan.part().turning() != &other.part().turning()) continue;
      plan.framing.extras.extend(other.framing.extras);
      plan.framing.margin = std::max(plan.framing.margin, other.framing.margin);
    }
  }
  std::vector<Svg> pictures;
  double width = 0, height = 0;
  std::string titles;
  for (const draw::Plan& plan : plans) {
    pictures.push_back(draw::AnswerPicture(plan).draw());
    width += pictures.back().width();
    height = std::max(height, pictures.back().height());
    titles += (titles.empty() ? "" : "; ") + pictures.back().description();
  }
  Svg row(width, height);
  row.describe(titles);
  double x = 0;
  for (const Svg& picture : pictures) {
    row.embed(picture, x, 0);
    x += picture.width();
  }
  return row;
}

std::vector<std::size_t> numbers_of(const Answer& later, const Answer& earlier) {
  std::vector<std::size_t> numbers;
  for (const Placement& placement : later.placements) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < earlier.placements.size(); ++i) {
      const double here = later.part.boundary().distance(placement.start[0], earlier.placements[i].start[0]);
      if (here >= least) continue;
      least = here;
      nearest = i;
    }
    numbers.push_back(nearest);
  }
  return numbers;
}

}  // namespace rollfix
