#include "rollfix/draw/answer_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "labels.hpp"
#include "legend.hpp"
#include "offset.hpp"
#include "pair_plan.hpp"
#include "roll_pen.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostPairArcPoints = 20000;  // of an arc
constexpr double kArcWidth = 2.6;                  // pixels
constexpr double kPairLabelSize = 13.5;
constexpr double kPairNumberSize = 10;
constexpr double kSameDot = 3;          // dots that are closer together get one label
constexpr std::size_t kMostListed = 4;  // numbers in a label

/// The whole page, drawn from the bottom to the top.
class PairPicture {
 public:
  explicit PairPicture(const PairPlan& plan)
      : plan_(plan),
        legend_(pair_legend(plan)),
        drawing_end_(kHeaderHeight + drawing_height(plan.framing)),
        svg_(width_of(*plan.figure), drawing_end_ + legend_.height() + 8),
        scene_(make_scene(plan.part(), plan.framing, Vec2(0, kHeaderHeight))),
        clearance_(scene_.boundary),
        obstacles_(scene_.area.max().x(), drawing_end_),
        pen_(svg_, scene_, clearance_, obstacles_) {}

  Svg draw() {
    const AnswerFigure& figure = *plan_.figure;
    draw_header(svg_, figure.title.empty() ? plan_.part().name() : figure.title, figure.answer->verdict.text(),
                small_print());
    svg_.open_clip(scene_.area.min().x(), scene_.area.min().y(), scene_.area.sizes().x(), scene_.area.sizes().y());
    draw_material(svg_, scene_, plan_.part());
    bands();
    fingers();
    draw_boundary(svg_, scene_, plan_.part());
    obstacles_.add(scene_.boundary.points);
    draw_corners(svg_, scene_, plan_.part(), obstacles_);
    draw_origin(svg_, scene_, obstacles_);
    dots();
    rolls();
    draw_scale_bar(svg_, scene_);
    labels_.add({scene_.at(0)}, scene_.normal(0), {{"s", true, false, false}, {" = 0"}}, kSoftInk, 10);
    labels_.draw(svg_, obstacles_);
    svg_.close_group();
    draw_pair_plane(svg_, plan_);
    legend_.draw(svg_, drawing_end_);
    return std::move(svg_);
  }

 private:
  Text small_print() const {
    if (!plan_.shown) return {};
    const std::size_t count = plan_.placements().size();
    const bool stretch = plan_.placements()[*plan_.shown].kind == Kind::stretch;
    std::string text = stretch ? "the rolls of one pair of a stretch" : "the rolls of both fingers";
    if (count > 1)
      text += fmt::format(", placement {} of 0 to {}; dots: first contacts of the others", *plan_.shown, count - 1);
    return {{text}};
  }

  // ---- under the boundary

  void bands() {
    for (std::size_t finger = 0; finger < 2; ++finger) {
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
        Paint paint = stroke(kFingerColours[finger], finger == 0 ? 11 : 7);  // both are seen where they overlap
        paint.stroke_opacity = 0.25;
        svg_.open_group("extent");
        svg_.polyline(slice(scene_.boundary, extent.lo, extent.hi).points, paint);
        svg_.close_group();
      }
    }
  }

  void fingers() {
    for (std::size_t finger = 0; plan_.shown && finger < 2; ++finger) {
      if (!radius_of(*plan_.figure, finger)) continue;
      const double radius = *radius_of(*plan_.figure, finger);
      const Placement& placement = plan_.placements()[*plan_.shown];
      const double start = placement.start[finger];
      // The spoke is fixed to the finger; at the first contact it points at the part.
      const double inward = placement.tangent[finger] + 0.5 * std::numbers::pi;
      svg_.open_group("finger");
      pen_.finger(plan_.part(), start, radius, inward);
      if (!plan_.rolls[finger].contacts.empty()) {
        const double length = plan_.rolls[finger].contacts.back();
        const double turn = plan_.part().turning().angle(start + length) - plan_.part().turning().angle(start);
        // L = -r du and Phi = du + dpsi give the finger's own turn dpsi.
        pen_.finger(plan_.part(), placement.end[finger], radius, inward + turn + length / radius);
      }
      svg_.close_group();
    }
  }

  // ---- the placements

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
        if (!plan_.has_numbers()) continue;
        labels_.add({scene_.at(s)}, scene_.normal(s), {{listed(numbers)}}, kFingerColours[finger], kPairNumberSize);
      }
    }
    svg_.close_group();
  }

  static std::string listed(const std::vector<std::size_t>& numbers) {
    const std::size_t count = std::min(numbers.size(), kMostListed);
    std::string text = fmt::format("{}", fmt::join(numbers.begin(), numbers.begin() + static_cast<long>(count), ","));
    return numbers.size() > count ? text + "\u2026" : text;
  }

  void rolls() {
    if (!plan_.shown) return;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const Roll& roll = plan_.rolls[finger];
      const double start = plan_.placements()[*plan_.shown].start[finger];
      std::vector<std::vector<Vec2>> paths;
      for (const Run& run : roll.runs) {
        const auto offset = [&](double travelled) { return plan_.offset(finger, run, travelled); };
        paths.push_back(pen_.path(start, run, offset, kMostPairArcPoints));
        pen_.stems(start, run, paths.back(), kFingerColours[finger]);
      }
      for (const std::vector<Vec2>& path : paths) pen_.arc(path, kFingerColours[finger], kArcWidth, !roll.tangled);
      contacts(finger, start, paths);
    }
  }

  void contacts(std::size_t finger, double start, const std::vector<std::vector<Vec2>>& paths) {
    const Roll& roll = plan_.rolls[finger];
    const auto travelled = [&](std::size_t k) { return k == 0 ? 0 : roll.contacts[k - 1]; };
    for (std::size_t k = roll.contacts.size() + 1; k-- > 0;) {
      if (!plan_.is_named(k)) continue;
      const double s = start + travelled(k);
      if (k > 0) {
        pen_.contact(s, kFingerColours[finger], finger == 0 ? 4.2 : 2.4);
      } else {
        pen_.start(s, kFingerColours[finger], finger == 0 ? 4.8 : 3.2);
      }
      std::vector<Vec2> anchors{scene_.at(s)};
      for (std::size_t i = 0; i < paths.size(); ++i) {
        if (roll.runs[i].from == travelled(k)) anchors.push_back(paths[i].front());
        if (roll.runs[i].to == travelled(k)) anchors.push_back(paths[i].back());
      }
      labels_.add(std::move(anchors), scene_.normal(s), pair_contact(finger, k), kFingerColours[finger],
                  kPairLabelSize);
    }
  }

  const PairPlan& plan_;
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

Svg draw_pairs(const AnswerFigure& figure) {
  const PairPlan plan = pair_plan_of(figure);
  return PairPicture(plan).draw();
}

}  // namespace rollfix::draw
