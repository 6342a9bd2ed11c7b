#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "draw/answer/answer_plan.hpp"
#include "draw/answer/densities.hpp"
#include "draw/labels.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostPairs = 4;  // pairs with their probability in the legend
constexpr double kLeastRest = 1e-3;    // less than this is not worth a line

std::string equals(double value) { return " = " + pretty(value); }

/// One finger's reading; `index` is that of its letters, if any.
Text reading_text(const Reading& reading, const std::string& index) {
  Text text = symbol("L", index);
  text.push_back({equals(reading.length[0]) + ", "});
  append(text, symbol("\u03b8", index));
  if (reading.is_exact()) {
    text.push_back({" = " + pretty_degrees(reading.turn)});
  } else {  // on a corner of the finger
    text.push_back({" = " + pretty_degrees(reading.turn - reading.pivot) + " ... " +
                    pretty_degrees(reading.turn + reading.pivot)});
  }
  return text;
}

/// Up to three readings in full, of more the last.
Text readings_text(const std::vector<Reading>& readings) {
  const std::size_t most = 3;
  Text text;
  if (readings.size() > most) {
    text.push_back({fmt::format("{} readings, the last ", readings.size())});
    append(text, reading_text(readings.back(), ""));
    return text;
  }
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (k > 0) text.push_back({";  "});
    append(text, reading_text(readings[k], readings.size() > 1 ? std::to_string(k + 1) : ""));
  }
  return text;
}

/// With noise: where it started, give or take, and how probable that is.
Text weighed_text(const AnswerPlan& plan, const Way& way) {
  const Placement& placement = plan.placement(way);
  const double sd = placement.sd[0];
  Text text = contact_name(plan, way, 0);
  text.push_back({": " + percent(placement.probability), false, true, false});
  if (plan.is_anywhere(way.placement, 0)) {
    text.push_back({", anywhere"});
    return text;
  }
  text.push_back({fmt::format(", likeliest {}, 95 % in {} to {}", as_sure_as(placement.start[0], sd),
                              as_sure_as(placement.interval[0].lo, sd),
                              as_sure_as(plan.part().boundary().base(placement.interval[0].hi), sd))});
  const std::size_t last = plan.roll(way).contacts.size();
  if (last > 0) {
    text.push_back({"; "});
    append(text, contact_name(plan, way, last));
    text.push_back({" " + with_sd(placement.end_mean[0], placement.end_sd[0])});
  }
  if (placement.kind == Kind::corner) text.push_back({"; corner"});
  return text;
}

Text placement_text(const AnswerPlan& plan, const Way& way) {
  if (plan.has_noise()) return weighed_text(plan, way);
  const Placement& placement = plan.placement(way);
  const std::size_t last = plan.roll(way).contacts.size();
  Text text = contact_name(plan, way, 0);
  if (placement.kind == Kind::stretch) {
    text.push_back({fmt::format(" in [{}, {}]", pretty_on(plan.part(), placement.extent[0].lo),
                                pretty_on(plan.part(), placement.extent[0].hi))});
  } else {
    text.push_back({" " + pretty_on(plan.part(), placement.start[0])});
  }
  if (last > 0) {
    text.push_back({" \u2192 "});
    append(text, contact_name(plan, way, last));
    text.push_back({" " + pretty_on(plan.part(), placement.end[0])});
  }
  if (placement.kind == Kind::touching) text.push_back({" touching"});
  if (placement.kind == Kind::corner) text.push_back({" corner"});
  return text;
}

/// With noise: how probable a pair is, and where each finger started.
Text pair_text(const AnswerPlan& plan, std::size_t k) {
  const Placement& placement = plan.placements()[k];
  Text text{{fmt::format("{}: {}", k, percent(placement.probability)), false, true, false}};
  text.push_back({", 95 %: "});
  for (const std::size_t finger : {0U, 1U}) {
    const Interval& held = placement.interval[finger];
    const double sd = placement.sd[finger];
    if (finger == 1) text.push_back({", "});
    append(text, contact_name(plan, {k, finger}, 0));
    text.push_back({plan.is_anywhere(k, finger) ? " anywhere"
                                                : fmt::format(" {} to {}", as_sure_as(held.lo, sd),
                                                              as_sure_as(plan.part().boundary().base(held.hi), sd))});
  }
  return text;
}

Text finger_text(const AnswerPlan& plan, std::size_t finger) {
  Text text{{finger == 0 ? "finger a" : "finger b"}};
  for (const Way& way : plan.ways) {
    if (way.finger != finger) continue;
    for (std::size_t k = 0; k <= plan.roll(way).contacts.size(); ++k) {
      if (!plan.is_named(k)) continue;
      text.push_back({k == 0 ? ": " : ", "});
      append(text, contact_name(plan, way, k));
      text.push_back({equals(plan.part().boundary().base(plan.place(way, k)))});
    }
  }
  return text;
}

Text line_text(const AnswerPlan& plan, const PairLine& line) {
  const Answer& answer = *plan.figure->answer;
  Text text = line.name;
  text.push_back({" = 0: "});
  if (!line.reading) {
    text.push_back({"facing " + pretty_degrees(*answer.facing)});
    return text;
  }
  const Reading& reading = answer.readings[*line.reading];
  append(text, symbol("L", "a"));
  text.push_back({equals(reading.length[0]) + ", "});
  append(text, symbol("L", "b"));
  text.push_back({equals(reading.length[1]) + ", "});
  append(text, symbol("\u03b8"));
  text.push_back({" = " + pretty_degrees(std::abs(reading.turn) < kTurnAccuracy ? 0 : reading.turn)});
  return text;
}

}  // namespace

Text contact_name(const AnswerPlan& plan, const Way& way, std::size_t k) {
  if (plan.has_pairs()) return symbol(way.finger == 0 ? "s" : "t", std::to_string(k));
  const char letter = static_cast<char>('a' + std::min<std::size_t>(k, 25));
  return symbol(std::string(1, letter), std::to_string(plan.number(way.placement)));
}

Text start_name(const AnswerPlan& plan, const Way& way) {
  Text text = contact_name(plan, way, 0);
  const bool is_one_of_many = plan.has_noise() && !plan.has_pairs() && plan.placements().size() > 1;
  if (is_one_of_many) text.push_back({" " + percent(plan.placement(way).probability)});
  return text;
}

Text small_print(const AnswerPlan& plan) {
  if (!plan.has_pairs()) return readings_text(plan.figure->answer->readings);
  if (!plan.shown) return {};
  const std::size_t count = plan.placements().size();
  const bool stretch = plan.placements()[*plan.shown].kind == Kind::stretch;
  std::string text = stretch ? "the rolls of one pair of a stretch" : "the rolls of both fingers";
  if (count > 1) {
    text += fmt::format(", placement {} of 0 to {}; dots: first contacts of the others", *plan.shown, count - 1);
  }
  return {{text}};
}

Legend legend_of(const AnswerPlan& plan) {
  std::vector<LegendEntry> entries;
  if (plan.has_pairs()) {
    for (std::size_t finger = 0; finger < 2 && !plan.ways.empty(); ++finger) {
      entries.push_back({Sign::line, kFingerColours[finger], finger_text(plan, finger)});
    }
    for (std::size_t k = 0; plan.has_noise() && k < std::min(plan.placements().size(), kMostPairs); ++k) {
      entries.push_back({Sign::area, kEllipseFill, pair_text(plan, k)});
    }
    for (const PairLine& line : plan.lines) {
      entries.push_back({Sign::line, line.colour, line_text(plan, line), line.dash});
    }
  } else if (plan.has_list()) {
    for (const Way& way : plan.ways) {
      entries.push_back({Sign::line, plan.colour_of(way), placement_text(plan, way)});
    }
  }
  if (plan.has_noise() && plan.figure->answer->weighing->rest >= kLeastRest) {
    entries.push_back({Sign::line, kSoftInk, {{"elsewhere: " + percent(plan.figure->answer->weighing->rest)}}});
  }
  return {std::move(entries), plan.width()};
}

}  // namespace rollfix::draw

// ---- the figure
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
