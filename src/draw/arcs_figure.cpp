#include "rollfix/draw/answer_figure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "arcs_plan.hpp"
#include "arcs_texts.hpp"
#include "labels.hpp"
#include "legend.hpp"
#include "offset.hpp"
#include "roll_pen.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace draw {
namespace {

constexpr std::size_t kMostArcPoints = 100000;  // of all arcs together
constexpr double kStartSize = 3.1;              // pixels
constexpr double kArcLabelSize = 13;            // pixels

/// One plan on a page of its own, drawn from the bottom to the top.
class ArcsPicture {
 public:
  explicit ArcsPicture(const Plan& plan)
      : plan_(plan),
        legend_(legend_of(plan)),
        drawing_end_(kHeaderHeight + drawing_height(plan.framing)),
        svg_(width_of(*plan.figure), drawing_end_ + legend_.height() + 8),
        scene_(make_scene(plan.part(), plan.framing, Vec2(0, kHeaderHeight))),
        clearance_(scene_.boundary),
        obstacles_(svg_.width(), drawing_end_),
        pen_(svg_, scene_, clearance_, obstacles_) {}

  Svg draw() {
    const AnswerFigure& figure = *plan_.figure;
    draw_header(svg_, figure.title.empty() ? plan_.part().name() : figure.title, figure.answer->verdict.text(),
                readings_text(figure.answer->readings));
    svg_.open_clip(scene_.area.min().x(), scene_.area.min().y(), scene_.area.sizes().x(), scene_.area.sizes().y());
    draw_material(svg_, scene_, plan_.part());
    bands();
    fingers();
    draw_boundary(svg_, scene_, plan_.part());
    obstacles_.add(scene_.boundary.points);
    draw_corners(svg_, scene_, plan_.part(), obstacles_);
    draw_origin(svg_, scene_, obstacles_);
    if (plan_.has_arcs()) {
      placements();
    } else {
      starts();
    }
    draw_scale_bar(svg_, scene_);
    labels_.add({scene_.at(0)}, scene_.normal(0), {{"s", true, false, false}, {" = 0"}}, kSoftInk, 10);
    labels_.draw(svg_, obstacles_);
    svg_.close_group();
    legend_.draw(svg_, drawing_end_);
    return std::move(svg_);
  }

 private:
  // ---- under the boundary

  void bands() {
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
      const Placement& placement = plan_.placements()[i];
      const bool wide = scene_.pixels(placement.extent[0].width()) > kVisibleExtent;
      if (placement.kind == Kind::stretch || wide) band(placement.extent[0], plan_.colour_of(i), "extent", "");
    }
    for (const PerFinger<Interval>& interval : plan_.figure->answer->unresolved)
      band(interval[0], kSoftInk, "unresolved", "1 13");
  }

  void band(const Interval& extent, std::string_view colour, std::string_view name, const std::string& dash) {
    Paint paint = stroke(colour, 10);
    paint.stroke_opacity = 0.32;
    paint.dash = dash;
    svg_.open_group(name);
    svg_.polyline(slice(scene_.boundary, extent.lo, extent.hi).points, paint);
    svg_.close_group();
  }

  void fingers() {
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
      if (!plan_.has_finger(i)) continue;
      const Placement& placement = plan_.placements()[i];
      const double radius = *radius_of(*plan_.figure, 0);
      // The spoke is fixed to the finger; at the first contact it points at the part.
      const double inward = placement.tangent[0] + 0.5 * std::numbers::pi;
      svg_.open_group("finger");
      pen_.finger(plan_.part(), placement.start[0], radius, inward);
      if (!plan_.figure->answer->readings.empty()) {
        const Reading& last = plan_.figure->answer->readings.back();
        // L = -r du and theta = du + dpsi give the finger's own turn dpsi.
        pen_.finger(plan_.part(), placement.end[0], radius, inward + last.turn + last.length[0] / radius);
      }
      svg_.close_group();
    }
  }

  // ---- the placements

  /// The path of one run on the page, in the direction of the roll.
  struct Arc {
    std::size_t placement;
    const Run* run;
    std::vector<Vec2> path;
  };

  void placements() {
    std::vector<Arc> arcs;
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
      for (const Run& run : plan_.roll.runs) arcs.push_back({i, &run, path_of(i, run)});
    }
    svg_.open_group("stems");
    for (const Arc& arc : arcs) {
      pen_.stems(plan_.placements()[arc.placement].start[0], *arc.run, arc.path, plan_.colour_of(arc.placement));
    }
    svg_.close_group();
    for (const Arc& arc : arcs) {
      pen_.arc(arc.path, plan_.colour_of(arc.placement), plan_.line_width(arc.placement), !plan_.roll.tangled);
    }
    // The starts lie on the ends, and are smaller: both can be seen where they meet.
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) ends(i);
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) start(i);
    if (plan_.has_labels()) labels(arcs);
  }

  std::vector<Vec2> path_of(std::size_t i, const Run& run) const {
    const auto offset = [&](double travelled) { return plan_.offset(i, run, travelled); };
    return pen_.path(plan_.placements()[i].start[0], run, offset, kMostArcPoints / plan_.placements().size());
  }

  void ends(std::size_t i) {
    const Placement& placement = plan_.placements()[i];
    const std::vector<double>& contacts = plan_.roll.contacts;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const bool last = k + 1 == contacts.size();
      if (!plan_.is_lettered(k)) continue;
      pen_.contact(last ? placement.end[0] : placement.start[0] + contacts[k], plan_.colour_of(i),
                   marker_size(last ? 3.9 : 2.6));
    }
  }

  void start(std::size_t i) { pen_.start(plan_.placements()[i].start[0], plan_.colour_of(i), marker_size(kStartSize)); }

  /// Smaller where the lanes are close together.
  double marker_size(double radius) const {
    return std::min(radius, (1.2 + 0.35 * plan_.spacing) * radius / kStartSize);
  }

  /// More placements than arcs can show: a tick at each start.
  void starts() {
    std::vector<Vec2> ticks;
    for (const Placement& placement : plan_.placements()) {
      const Vec2 at = scene_.at(placement.start[0]), normal = scene_.normal(placement.start[0]);
      ticks.emplace_back(at + 2 * normal);
      ticks.emplace_back(at + 9 * normal);
    }
    svg_.open_group("starts");
    svg_.segments(ticks, stroke(colour(0), 1));
    svg_.close_group();
  }

  /// At both ends of every arc; each may stand at the boundary or at the arc.
  void labels(const std::vector<Arc>& arcs) {
    const std::vector<double>& contacts = plan_.roll.contacts;
    for (std::size_t i = 0; i < plan_.placements().size(); ++i) {
      const Placement& placement = plan_.placements()[i];
      label(i, 0, placement.start[0], arcs);
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        const bool last = k + 1 == contacts.size();
        if (plan_.is_lettered(k)) label(i, k + 1, last ? placement.end[0] : placement.start[0] + contacts[k], arcs);
      }
    }
  }

  void label(std::size_t i, std::size_t k, double s, const std::vector<Arc>& arcs) {
    const double travelled = k == 0 ? 0 : plan_.roll.contacts[k - 1];
    std::vector<Vec2> anchors = {scene_.at(s)};
    for (const Arc& arc : arcs) {
      if (arc.placement != i) continue;
      if (arc.run->from == travelled) anchors.push_back(arc.path.front());
      if (arc.run->to == travelled) anchors.push_back(arc.path.back());
    }
    labels_.add(std::move(anchors), scene_.normal(s), contact_name(k, plan_.number(i)), plan_.colour_of(i),
                kArcLabelSize);
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

Svg draw_arcs(const AnswerFigure& figure) {
  const Plan plan = arcs_plan_of(figure);
  return ArcsPicture(plan).draw();
}

}  // namespace draw

Svg side_by_side(const std::vector<AnswerFigure>& figures) {
  if (figures.empty()) throw InputError("a row of figures needs at least one, found none");
  std::vector<draw::Plan> plans;
  for (const AnswerFigure& figure : figures) {
    draw::require_valid(figure);
    plans.push_back(draw::arcs_plan_of(figure));
  }
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
    pictures.push_back(draw::ArcsPicture(plan).draw());
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
