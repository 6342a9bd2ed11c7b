#include "rollfix/draw.hpp"

#include <utility>

#include "draw/answer/answer_plan.hpp"
#include "draw/identify/parts_plan.hpp"
#include "draw/labels.hpp"
#include "draw/plot.hpp"
#include "draw/rolls.hpp"
#include "draw/scene.hpp"

namespace rollfix::draw {
namespace {

constexpr double kNameSize = 12;      // pixels
constexpr double kNameBaseline = 19;  // from the top, ...
constexpr double kBarTop = 26;        // ... as all of these
constexpr double kBarHeight = 3.5;
constexpr double kNoteBaseline = 35;  // without a bar
constexpr double kNoteLine = 14;      // to the next
constexpr double kBarRoom = 7;        // that the bar takes
constexpr double kFrameWidth = 0.8;
constexpr double kLikeliestFrameWidth = 2;
constexpr double kFrameRoom = 4;  // kept free of labels within the frame
constexpr std::string_view kFrameColour = "#c8c8c8";
constexpr std::string_view kBarColour = "#e4e4e4";
constexpr std::string_view kLikeliest = kPalette[0];

class Panel {
 public:
  Panel(const PartsPlan& page, std::size_t index)
      : page_(page),
        panel_(page.panels[index]),
        row_(page.row_of(index)),
        width_(page.panel_width),
        svg_(width_, row_.height()),
        scene_(scene()),
        clearance_(scene_.boundary),
        obstacles_(width_, row_.height()),
        pen_(svg_, scene_, clearance_, obstacles_) {}

  Svg draw() {
    header();
    keep_free();
    const AnswerPlan& plan = panel_.plan;
    draw_material(svg_, scene_, plan.part());
    draw_bands(svg_, plan, scene_);
    draw_boundary(svg_, scene_, plan.part());
    obstacles_.add(scene_.boundary.points);
    draw_origin(svg_, scene_, obstacles_);
    PlacementPen(svg_, plan, scene_, pen_, labels_).draw();
    if (!page_.one_scale) draw_scale_bar(svg_, with_strip(scene_), plan.part());
    labels_.add({scene_.at(0)}, scene_.normal(0), {{"s", true, false, false}, {" = 0"}}, kSoftInk, 9);
    labels_.draw(svg_, obstacles_);
    panel_.legend.draw(svg_, drawing_end());
    frame();  // on the material, which is all around a hole
    svg_.describe(panel_.entry->name);
    return std::move(svg_);
  }

 private:
  double drawing_end() const { return row_.height() - panel_.legend_height(); }
  double strip() const { return page_.one_scale ? 0 : kScaleBarHeight; }

  Scene scene() const {
    const Box area(Vec2(0, row_.header), Vec2(width_, drawing_end() - strip()));
    return scene_at(panel_.plan.part(), panel_.plan.framing, panel_.scale, area);
  }

  /// With the room for its scale bar below it.
  Scene with_strip(Scene scene) const {
    scene.area.max().y() += strip();
    return scene;
  }

  void frame() {
    const bool strong = panel_.is_likeliest && page_.panels.size() > 1;
    const double line = strong ? kLikeliestFrameWidth : kFrameWidth;
    svg_.open_group(strong ? "likeliest" : "frame");
    svg_.rectangle(0.5 * line, 0.5 * line, width_ - line, row_.height() - line,
                   stroke(strong ? kLikeliest : kFrameColour, line));
    svg_.close_group();
  }

  void header() {
    const double right = width_ - kPageMargin, room = right - kPageMargin;
    const std::string probability = page_.has_noise() ? percent(panel_.entry->probability) : "";
    const double taken = probability.empty() ? 0 : text_width({{probability, false, true, false}}, kNameSize) + 12;
    const std::string name = shortened(panel_.entry->name, room - taken, kNameSize, true);
    svg_.open_group("name");
    svg_.text({kPageMargin, kNameBaseline}, {{name, false, true, false}}, {kNameSize});
    svg_.close_group();
    double note = kNoteBaseline;
    if (page_.has_noise()) {
      svg_.text({right, kNameBaseline}, {{probability, false, true, false}}, {kNameSize, Align::end});
      bar(room);
      note += kBarRoom;
    }
    const TextStyle style{kNoteSize, Align::start, std::string(kSoftInk)};
    svg_.text({kPageMargin, note}, {{shortened(places_text(panel_.plan), room, kNoteSize, false)}}, style);
    if (panel_.entry->congruent.empty()) return;
    svg_.text({kPageMargin, note + kNoteLine}, {{congruent_text(panel_.entry->congruent, room)}}, style);
  }

  /// As long as the part is probable.
  void bar(double room) {
    const double filled_to = room * panel_.entry->probability;
    svg_.open_group("probability");
    svg_.rectangle(kPageMargin, kBarTop, room, kBarHeight, filled(kBarColour));
    svg_.rectangle(kPageMargin, kBarTop, filled_to, kBarHeight, filled(panel_.is_likeliest ? kLikeliest : kSoftInk));
    svg_.close_group();
  }

  /// Labels keep to the drawing.
  void keep_free() {
    const Vec2 all(width_, row_.height()), aside(kFrameRoom, all.y());
    obstacles_.add_box(Vec2::Zero(), Vec2(all.x(), row_.header));
    obstacles_.add_box(Vec2(0, drawing_end() - strip()), all);
    obstacles_.add_box(Vec2::Zero(), aside);
    obstacles_.add_box(all - aside, all);
  }

  const PartsPlan& page_;
  const PanelPlan& panel_;
  const RowPlan& row_;
  double width_;
  Svg svg_;
  Scene scene_;
  Clearance clearance_;
  Obstacles obstacles_;
  RollPen pen_;
  LabelSet labels_;
};

/// One part of a figure of parts as a picture of its own, as large as its place on the page.
Svg draw_panel(const PartsPlan& plan, std::size_t panel) { return Panel(plan, panel).draw(); }

}  // namespace

}  // namespace rollfix::draw

namespace rollfix {

namespace draw {
namespace {

constexpr double kScaleBarRow = 26;  // pixels
constexpr double kFooterLine = 15;
constexpr double kFooterGap = 8;
constexpr double kEmpty = 60;  // where no part is shown

bool has_scale_bar(const PartsPlan& plan) { return plan.one_scale && !plan.panels.empty(); }

double height_of(const PartsPlan& plan) {
  const double body = plan.panels.empty() ? kEmpty : has_scale_bar(plan) ? kScaleBarRow : 0;
  return plan.grid_end() + body + kFooterLine * static_cast<double>(plan.footer.size()) + kFooterGap;
}

/// For all panels, below them at the left.
void draw_common_scale(Svg& svg, const PartsPlan& plan, double top) {
  Scene scene;
  scene.area = Box(Vec2(0, top), Vec2(plan.panel_width, top + kScaleBarRow));
  scene.view.scale = plan.panels.front().scale;
  draw_scale_bar(svg, scene, plan.panels.front().plan.part());
}

}  // namespace
}  // namespace draw

Svg draw_parts(const PartsFigure& figure) {
  using namespace draw;
  const PartsPlan plan = plan_of(figure);
  Svg svg(plan.width, height_of(plan));
  draw_header(svg, figure.verdict, fit_text(figure), roll_text(plan));
  for (std::size_t k = 0; k < plan.panels.size(); ++k) {
    const Vec2 corner = plan.corner_of(k);
    svg.embed(draw_panel(plan, k), corner.x(), corner.y());
  }
  double y = plan.grid_end();
  if (plan.panels.empty()) {
    svg.text({0.5 * plan.width, y + 0.5 * kEmpty},
             {{figure.verdict == "none" ? "The roll fits no part." : "No part is listed."}},
             {12, Align::middle, std::string(kSoftInk)});
    y += kEmpty;
  } else if (has_scale_bar(plan)) {
    draw_common_scale(svg, plan, y);
    y += kScaleBarRow;
  }
  svg.open_group("footer");
  for (const std::string& line : plan.footer) {
    y += kFooterLine;
    svg.text({kPageMargin, y}, {{line}}, {kNoteSize, Align::start, std::string(kSoftInk)});
  }
  svg.close_group();
  return svg;
}

}  // namespace rollfix
