#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "labels.hpp"
#include "outline/turn.hpp"
#include "plot.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/error.hpp"
#include "scene.hpp"
#include "text/text.hpp"

namespace rollfix::draw {

inline constexpr std::string_view kRowColour = kPalette[1];
inline constexpr std::string_view kGapColour = kBlocked;

/// What has to be seen of the rows.
Box bounds_of(const TaughtRows& taught, const Box& bounds);

/// The rows as they were added up, and the gap from the lap's end to its start.
void draw_rows(Svg& svg, const Scene& scene, const TaughtRows& taught, LabelSet& labels, Obstacles& obstacles);

/// How far the rows' turns are off the part's: places (s, degrees). None of a part that is stored the other way round.
std::vector<Vec2> turns_off(const Part& part, const TaughtRows& taught);
/// What of that is shown: the few that are far off, as within a pivot, are not.
Interval range_of_turns(const std::vector<Vec2>& off);
void draw_turns_off(Svg& svg, const Axes& axes, const std::vector<Vec2>& off);

/// What both are.
std::vector<LegendEntry> entries_of(const TaughtRows& taught, const Part& part);

namespace {

constexpr double kApart = 4;            // rows further apart than this are seen as dots, pixels
constexpr double kRowSize = 1.4;        // of a dot
constexpr double kTurnSize = 1.2;       // in the plot
constexpr double kSmallGap = 10;        // a shorter gap is circled
constexpr double kGapRing = 9;          // its radius
constexpr double kGapEnd = 3.4;         // the mark at either end of a longer one
constexpr double kMostRowsReach = 0.5;  // beyond the part, as a fraction of its size
constexpr double kUsual = 0.95;         // of the rows are off by no more than what is called usual
constexpr double kFarOff = 2;           // times the usual are still shown
constexpr double kLeastOff = 1e-6;      // degrees: less is rounding
constexpr std::size_t kMostDots = 4000;

/// Where the rows are when the lap ends.
Vec2 lap_end(const TaughtRows& taught) {
  const std::vector<ReckonedRow>& rows = taught.rows;
  const auto after =
      std::find_if(rows.begin(), rows.end(), [&](const ReckonedRow& row) { return row.s >= taught.lap; });
  if (after == rows.begin() || after == rows.end()) return rows.back().point;
  const ReckonedRow& before = *std::prev(after);
  const double step = after->s - before.s;
  const double share = step > 0 ? (taught.lap - before.s) / step : 0;
  return before.point + share * (after->point - before.point);
}

}  // namespace

Box bounds_of(const TaughtRows& taught, const Box& bounds) {
  const Vec2 reach = Vec2::Constant(kMostRowsReach * bounds.sizes().maxCoeff());
  Box box;
  for (const ReckonedRow& row : taught.rows) {
    box.extend(row.point.cwiseMax(bounds.min() - reach).cwiseMin(bounds.max() + reach));
  }
  return box;
}

void draw_rows(Svg& svg, const Scene& scene, const TaughtRows& taught, LabelSet& labels, Obstacles& obstacles) {
  if (taught.rows.empty()) return;
  std::vector<Vec2> path;
  for (const ReckonedRow& row : taught.rows) path.push_back(scene.view(row.point));
  const double length = scene.pixels(taught.rows.back().s - taught.rows.front().s);
  svg.open_group("rows");
  svg.polyline(pick(path, simplify(path, kInvisible, kMostVertices)), stroke(kRowColour, 0.9));
  if (length > kApart * static_cast<double>(path.size())) {
    for (const Vec2& at : path) svg.circle(at, kRowSize, filled(kRowColour));
  }
  svg.close_group();
  const Vec2 end = scene.view(lap_end(taught)), start = path.front();
  svg.open_group("gap");
  if ((end - start).norm() >= kSmallGap) {
    svg.segments({end, start}, stroke(kGapColour, 2.2, "5 3"));
    for (const Vec2& at : {start, end}) svg.circle(at, kGapEnd, with_rim(kPaper, kGapColour, 1.6));
    obstacles.add({end, start});
  } else if (taught.closes) {
    svg.circle(0.5 * (start + end), kGapRing, stroke(kGapColour, 1.4));
    obstacles.add_circle(0.5 * (start + end), kGapRing);
  }
  svg.close_group();
  labels.add({Vec2(0.5 * (start + end))}, scene.normal(0), {{"gap " + pretty(taught.gap, 3)}}, kGapColour, 11);
}

std::vector<Vec2> turns_off(const Part& part, const TaughtRows& taught) {
  if (taught.rows.empty() || part.reversed()) return {};  // then s runs the other way
  const TurningFunction& turning = part.turning();
  const double laps = std::round((turning.angle(0) - taught.rows.front().angle) / kFullTurn);
  std::vector<Vec2> off;
  const std::size_t stride = 1 + taught.rows.size() / kMostDots;
  for (std::size_t k = 0; k < taught.rows.size(); k += stride) {
    const ReckonedRow& row = taught.rows[k];
    const Wrapped place = part.boundary().reduced(row.s);
    const double there = turning.angle(place.base) + place.winding * turning.period_turn();
    off.emplace_back(place.base, (row.angle + laps * kFullTurn - there) / kDegree);
  }
  return off;
}

Interval range_of_turns(const std::vector<Vec2>& off) {
  std::vector<double> sizes;
  for (const Vec2& at : off) sizes.push_back(std::abs(at.y()));
  std::sort(sizes.begin(), sizes.end());
  const double usual = sizes[static_cast<std::size_t>(kUsual * static_cast<double>(sizes.size() - 1))];
  const double most = std::max(std::min(sizes.back(), kFarOff * usual), kLeastOff);
  return widened({-most, most}, 0.06);
}

void draw_turns_off(Svg& svg, const Axes& axes, const std::vector<Vec2>& off) {
  svg.open_clip(axes.corner.x() - 1, axes.corner.y() - 1, axes.size.x() + 2, axes.size.y() + 2);
  for (const Vec2& at : off) {
    if (std::abs(at.y()) <= axes.y.hi) svg.circle(axes(at.x(), at.y()), kTurnSize, filled(kRowColour));
  }
  svg.close_group();
}

std::vector<LegendEntry> entries_of(const TaughtRows& taught, const Part& part) {
  if (taught.rows.empty()) return {};
  const std::string rows = counted(taught.rows.size(), "row", "rows");
  return {{Sign::line, kRowColour, {{rows + ", added up as logged"}}},
          {Sign::line, kGapColour, {{"gap " + with_unit(pretty(taught.gap, 3), part) + ": " + taught.closing}}, "5 3"}};
}

}  // namespace rollfix::draw

// ---- the part
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
