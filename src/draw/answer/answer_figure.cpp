#include "rollfix/draw.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "draw/answer/answer_plan.hpp"
#include "draw/labels.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace {

/// With the roll in the world, without its stray rows; a part face down is not drawn there.
Svg draw_roll(const SolutionFigure& asked, const Answer& answer) {
  AnswerFigure figure{&answer};
  figure.others = asked.others;
  figure.title = asked.title;
  const Problem problem = roll_problem(*asked.question);
  std::optional<Log> log = problem.measured.log;
  if (!answer.strays.empty()) log = without_strays(*log, problem.part, problem.fingers, *problem.noise);
  if (log && !answer.mirrored) figure.log = &*log;
  return draw_answer(figure);
}

}  // namespace

namespace draw {
namespace {

constexpr double kScaleBarShare = 0.38;  // of the drawing's width, with its number, at the lower left
constexpr double kWorldHeight = 340;     // below two fingers' square, pixels

/// One plan on a page of its own, drawn from the bottom to the top.
class AnswerPicture {
 public:
  explicit AnswerPicture(const AnswerPlan& plan)
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
    if (plan_.has_noise()) draw_ribbons(svg_, plan_, scene_, clearance_, obstacles_);
    draw_bands(svg_, plan_, scene_);
    for (const Way& way : plan_.ways) finger(way);
    draw_boundary(svg_, scene_, plan_.part());
    obstacles_.add(scene_.boundary.points);
    draw_corners(svg_, scene_, plan_.part(), obstacles_);
    draw_origin(svg_, scene_, obstacles_);
    PlacementPen(svg_, plan_, scene_, pen_, labels_).draw();
    draw_scale_bar(svg_, scene_, plan_.part());
    draw_key();
    const Box& area = scene_.area;
    obstacles_.forbid({0, 0}, {svg_.width(), kHeaderHeight - 4});
    obstacles_.forbid({area.min().x(), area.max().y() - kStripHeight + 4}, area.max());
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
  static double below_height(const AnswerPlan& plan) {
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

  /// At the lower right.
  void draw_key() {
    const std::string text = plan_.key();
    if (text.empty()) return;
    const Vec2 at = scene_.area.max() + Vec2(-kPageMargin, -7);
    const double room = (1 - kScaleBarShare) * scene_.area.sizes().x() - kPageMargin;
    svg_.text(at, {{text}}, {fitting_size({{text}}, 10, room), Align::end, std::string(kSoftInk)});
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
    if (!plan_.has_pairs()) return plan_.readings.back().turn;
    const TurningFunction& turning = plan_.part().turning();
    return turning.angle(plan_.start(way) + length) - turning.angle(plan_.start(way));
  }

  const AnswerPlan& plan_;
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
  const draw::AnswerPlan plan = draw::plan_of(figure);
  return draw::AnswerPicture(plan).draw();
}

Svg side_by_side(const std::vector<AnswerFigure>& figures) {
  if (figures.empty()) throw InputError("a row of figures needs at least one, found none");
  std::vector<draw::AnswerPlan> plans;
  for (const AnswerFigure& figure : figures) plans.push_back(draw::plan_of(figure));
  for (draw::AnswerPlan& plan : plans) {
    for (const draw::AnswerPlan& other : plans) {
      if (&plan.part().turning() != &other.part().turning()) continue;
      plan.framing.extras.extend(other.framing.extras);
      plan.framing.margin = std::max(plan.framing.margin, other.framing.margin);
    }
  }
  std::vector<Svg> pictures;
  double width = 0, height = 0;
  std::string titles;
  for (const draw::AnswerPlan& plan : plans) {
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

Svg draw_solution(const SolutionFigure& figure) {
  const Solution& solution = *figure.solution;
  if (const TouchAnswer* const answer = solution.at_rest()) {
    TouchFigure of_touches{answer};
    of_touches.others = figure.others;
    of_touches.title = figure.title;
    return draw_touches(of_touches);
  }
  if (const HoldAnswer* const answer = solution.moving()) {
    HoldFigure of_hold{answer};
    of_hold.others = figure.others;
    of_hold.title = figure.title;
    return draw_hold(of_hold);
  }
  return draw_roll(figure, *solution.roll());
}

}  // namespace rollfix
