#include "rollfix/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "labels.hpp"
#include "outline/turn.hpp"
#include "plot.hpp"
#include "rollfix/error.hpp"
#include "scene.hpp"
#include "taught_rows.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace draw {
namespace {

constexpr std::size_t kMostEvents = 150;      // more events of one sort than that are left unmarked
constexpr std::size_t kMostLargeEvents = 40;  // more events in all get small signs
constexpr std::size_t kMostCutMarks = 60;     // more peaks than that are cut without a mark
constexpr double kMargin = 40;                // around the part, pixels
constexpr double kPlotLeft = 58;
constexpr double kPlotRight = 16;
constexpr double kPlotHeight = 120;
constexpr double kPlotGap = 44;  // above each plot, for its title and the numbers of the one above
constexpr double kPlotEnd = 40;  // below the last one
constexpr std::string_view kGraphColour = "#1f3b57";
constexpr double kBlockedWidth = 4.5;
constexpr double kBlockedBand = 5;  // above a plot, pixels

struct Event {
  Sign sign;
  double s;
};

std::vector<Event> events_of(const Part& part) {
  std::vector<Event> events;
  const auto add = [&](Sign sign, const std::vector<double>& at) {
    if (at.size() > kMostEvents) return;
    for (const double s : at) events.push_back({sign, s});
  };
  std::vector<double> corners;
  for (const Corner& corner : part.corners()) corners.push_back(corner.s);
  add(Sign::vertex, part.vertices());
  add(Sign::inflection, part.inflections());
  add(Sign::corner, corners);
  return events;
}

std::string blocked_text(const Reach& reach) {
  const std::string finger =
      reach.curvature > 0 ? fmt::format("a disk of radius {}", pretty(1 / reach.curvature, 4)) : "a flat jaw";
  return fmt::format("out of reach of {}: {} % of the boundary", finger, pretty(100 * (1 - reach.share()), 3));
}

Legend legend_of(const PartFigure& figure) {
  const Part& part = *figure.part;
  const std::optional<Reach>& reach = figure.reach;
  std::vector<LegendEntry> entries = entries_of(figure.taught, part);
  const auto add = [&](Sign sign, std::size_t count, const std::string& one, const std::string& many) {
    if (count == 0) return;
    std::string text = counted(count, one, many);
    if (count > kMostEvents) text += ", not marked";
    entries.push_back({sign, sign_colour(sign), {{text}}});
  };
  add(Sign::inflection, part.inflections().size(), "inflection (\u03ba changes sign)",
      "inflections (\u03ba changes sign)");
  add(Sign::vertex, part.vertices().size(), "vertex (\u03ba\u2032 changes sign)",
      "vertices (\u03ba\u2032 changes sign)");
  add(Sign::corner, part.corners().size(), "corner (\u0398 jumps)", "corners (\u0398 jumps)");
  if (reach) entries.push_back({Sign::line, kBlocked, {{blocked_text(*reach)}}});
  return {std::move(entries), figure.width};
}

/// The part above, its curvature and turning function below.
class PartPicture {
 public:
  explicit PartPicture(const PartFigure& figure)
      : figure_(figure),
        part_(*figure.part),
        framing_(framing()),
        legend_(legend_of(figure)),
        turns_off_(turns_off(part_, figure.taught)),
        plots_top_(kHeaderHeight + drawing_height(framing_) + legend_.height()),
        svg_(figure.width, plots_top_ + plots() * (kPlotGap + kPlotHeight) + kPlotEnd),
        scene_(make_scene(part_, framing_, Vec2(0, kHeaderHeight))),
        obstacles_(figure.width, scene_.area.max().y()),
        events_(events_of(part_)),
        s_ticks_(round_ticks({0, part_.perimeter()}, 10)) {}

  Svg draw() {
    draw_header(
        svg_, figure_.title.empty() ? part_.name() : figure_.title,
        fmt::format("{} {}", part_.closed() ? "perimeter" : "length", with_unit(pretty(part_.perimeter(), 6), part_)),
        {{summary()}});
    shape();
    legend_.draw(svg_, scene_.area.max().y());
    curvature_plot();
    turning_plot();
    rows_plot();
    return std::move(svg_);
  }

 private:
  double plots() const { return turns_off_.empty() ? 2 : 3; }

  Framing framing() const {
    Framing framing;
    framing.part = part_bounds(part_);
    framing.extras = bounds_of(figure_.others, framing.part);
    framing.extras.extend(bounds_of(figure_.taught, framing.part));
    framing.margin = kMargin;
    framing.width = figure_.width;
    framing.least_height = 0.22 * figure_.width;
    framing.most_height = 0.62 * figure_.width;
    return framing;
  }

  std::string summary() const {
    const std::string kind = part_.closed() ? fmt::format("closed, turns {}", counted_turns()) : "open";
    return fmt::format("{}, {}{}", kind, counted(part_.turning().spirals().size(), "spiral", "spirals"),
                       part_.reversed() ? given() : "");
  }

  std::string given() const {
    return fmt::format(", reversed: it was given {}clockwise", part_.outline().hole ? "counter-" : "");
  }

  std::string counted_turns() const {
    const int turns = part_.turns();
    if (turns == 1) return "once";
    return turns == -1 ? "once backwards (a hole)" : fmt::format("{} times", turns);
  }

  double sign_size() const { return events_.size() > kMostLargeEvents ? 0.6 : 1; }

  // ---- the shape

  void shape() {
    svg_.open_clip(scene_.area.min().x(), scene_.area.min().y(), scene_.area.sizes().x(), scene_.area.sizes().y());
    draw_material(svg_, scene_, part_);
    draw_others(svg_, scene_, figure_.others);
    draw_boundary(svg_, scene_, part_);
    draw_rows(svg_, scene_, figure_.taught, labels_, obstacles_);
    blocked_arcs();
    obstacles_.add(scene_.boundary.points);
    draw_origin(svg_, scene_, obstacles_);
    arc_length_ticks();
    svg_.open_group("events");
    for (const Event& event : events_) {
      const Vec2 at = scene_.at(event.s), half(4, 4);
      draw_sign(svg_, event.sign, at, sign_colour(event.sign), sign_size());
      obstacles_.add_box(at - half, at + half);
    }
    svg_.close_group();
    draw_scale_bar(svg_, scene_, part_);
    labels_.draw(svg_, obstacles_);
    svg_.close_group();
  }

  /// Where the finger can't touch.
  void blocked_arcs() {
    if (!figure_.reach) return;
    svg_.open_group("out-of-reach");
    for (const Interval& gap : figure_.reach->gaps()) {
      svg_.polyline(slice(scene_.boundary, gap.lo, gap.hi).points, stroke(kBlocked, kBlockedWidth));
    }
    svg_.close_group();
  }

  /// The same above a plot.
  void blocked_bands(const Axes& frame) {
    if (!figure_.reach) return;
    const double period = part_.perimeter();
    std::vector<Vec2> ends;
    const auto add = [&](double lo, double hi) {
      ends.emplace_back(frame.page_x(lo), frame.corner.y() + 0.5 * kBlockedBand);
      ends.emplace_back(frame.page_x(hi), frame.corner.y() + 0.5 * kBlockedBand);
    };
    for (const Interval& gap : figure_.reach->gaps()) {
      add(gap.lo, std::min(gap.hi, period));
      if (gap.hi > period) add(0, gap.hi - period);
    }
    svg_.segments(ends, stroke(kBlocked, kBlockedBand));
  }

  /// The plots' marks of arc length along the boundary itself.
  void arc_length_ticks() {
    std::vector<Vec2> ends;
    for (const double s : s_ticks_.at) {
      const Vec2 at = scene_.at(s), normal = scene_.normal(s);
      const bool seam = part_.closed() && s > part_.perimeter() * (1 - 1e-9);
      if (seam) continue;
      Text text = {{tick_text(s, s_ticks_.decimals)}};
      if (s == 0) text = {{"s", true, false, false}, {" = 0"}};
      labels_.add({at + 4 * normal}, normal, text, kSoftInk, 9.5);
      if (s == 0) continue;
      ends.push_back(at);
      ends.emplace_back(at + 5 * normal);
    }
    svg_.open_group("arc-length");
    svg_.segments(ends, stroke(kInk, 1));
    svg_.close_group();
    for (std::size_t i = 0; i < ends.size(); i += 2) obstacles_.add({ends[i], ends[i + 1]});
  }

  // ---- the plots

  Axes axes(int row, const Interval& range) const {
    Axes axes;
    axes.corner = Vec2(kPlotLeft, plots_top_ + kPlotGap + row * (kPlotGap + kPlotHeight));
    axes.size = Vec2(figure_.width - kPlotLeft - kPlotRight, kPlotHeight);
    axes.x = {0, part_.perimeter()};
    axes.y = range;
    return axes;
  }

  void curvature_plot() {
    const CurvatureRange range = shown_curvature(part_);
    const Axes frame = axes(0, range.shown);
    const Ticks ticks = round_ticks(range.shown, 5);
    std::string note;
    if (!part_.corners().empty()) note = "infinite at corners";
    if (range.cut) {
      note += fmt::format("{}peaks cut: |\u03ba| reaches {}", note.empty() ? "" : "; ", pretty(range.most, 3));
    }
    const auto value = [](const Turning& turning) { return turning.curvature; };
    const std::vector<Vec2> points = graph(part_, frame, value);
    svg_.open_group("curvature");
    draw_axes(svg_, frame, s_ticks_, ticks, curvature_name(), note);
    blocked_bands(frame);
    corner_lines(frame);
    draw_graph(svg_, frame, points, stroke(kGraphColour, 1.4));
    cut_marks(frame, points);
    events_on(frame, value);
    svg_.close_group();
  }

  Text curvature_name() const {
    Text name = {{"curvature "}, {"\u03ba", true, false, false}};
    if (!part_.unit().empty()) name.push_back({", 1/" + part_.unit()});
    return name;
  }

  void turning_plot() {
    Axes frame = axes(1, {0, 1});
    const auto value = [](const Turning& turning) { return turning.angle / kDegree; };
    frame.y = turning_range(part_);
    svg_.open_group("turning");
    draw_axes(svg_, frame, s_ticks_, degree_ticks(frame.y, 5),
              {{"turning function "}, {"\u0398", true, false, false}, {", degrees"}}, "");
    blocked_bands(frame);
    corner_lines(frame);
    draw_graph(svg_, frame, graph(part_, frame, value), stroke(kGraphColour, 1.4));
    events_on(frame, value);
    if (turns_off_.empty()) name_s(frame);
    svg_.close_group();
  }

  void name_s(const Axes& frame) {
    draw_x_name(svg_, frame, with_unit(Text{{"arc length "}, {"s", true, false, false}}, part_));
  }

  /// Of a part that was taught.
  void rows_plot() {
    if (turns_off_.empty()) return;
    const Axes frame = axes(2, range_of_turns(turns_off_));
    svg_.open_group("row-turns");
    draw_axes(svg_, frame, s_ticks_, round_ticks(frame.y, 5),
              {{"turn of the rows as logged, less "}, {"\u0398", true, false, false}, {", degrees"}}, "");
    draw_turns_off(svg_, frame, turns_off_);
    name_s(frame);
    svg_.close_group();
  }

  void corner_lines(const Axes& frame) {
    std::vector<Vec2> ends;
    for (const Event& event : events_) {
      if (event.sign != Sign::corner) continue;
      ends.emplace_back(frame.page_x(event.s), frame.corner.y());
      ends.emplace_back(frame.page_x(event.s), frame.corner.y() + frame.size.y());
    }
    svg_.segments(ends, stroke("#9a9a9a", 0.8, "2 3"));
  }

  /// Arrowheads where the graph leaves the frame.
  void cut_marks(const Axes& frame, const std::vector<Vec2>& points) {
    const double top = frame.corner.y(), bottom = top + frame.size.y();
    std::vector<Vec2> tips;
    for (std::size_t i = 0; i < points.size();) {
      const int side = points[i].y() < top ? -1 : points[i].y() > bottom ? 1 : 0;
      std::size_t peak = i;
      for (; i < points.size() && (points[i].y() < top ? -1 : points[i].y() > bottom ? 1 : 0) == side; ++i) {
        if (side * points[i].y() > side * points[peak].y()) peak = i;
      }
      if (side != 0) tips.emplace_back(points[peak].x(), side < 0 ? top - 1 : bottom + 1);
    }
    if (tips.size() > kMostCutMarks) return;
    for (const Vec2& tip : tips) {
      const double back = tip.y() < top ? 5 : -5;
      svg_.polygon({tip, tip + Vec2(3, back), tip + Vec2(-3, back)}, filled(kGraphColour));
    }
  }

  template <class Value>
  void events_on(const Axes& frame, Value value) {
    const double top = frame.corner.y(), bottom = top + frame.size.y();
    for (const Event& event : events_) {
      Vec2 at = frame(event.s, value(part_.turning().at(event.s)));
      if (event.sign == Sign::corner) at.y() = top;
      if (at.y() < top || at.y() > bottom) continue;
      draw_sign(svg_, event.sign, at, sign_colour(event.sign), sign_size());
    }
  }

  const PartFigure& figure_;
  const Part& part_;
  Framing framing_;
  Legend legend_;
  std::vector<Vec2> turns_off_;
  double plots_top_;
  Svg svg_;
  Scene scene_;
  Obstacles obstacles_;
  std::vector<Event> events_;
  Ticks s_ticks_;
  LabelSet labels_;
};

}  // namespace
}  // namespace draw

Svg draw_part(const PartFigure& figure) {
  if (figure.part == nullptr) throw InputError("a figure of a part needs one, found none: set PartFigure::part");
  return draw::PartPicture(figure).draw();
}

}  // namespace rollfix
