#include "rollfix/draw.hpp"

#include "draw/identify/part_panel.hpp"
#include "draw/identify/parts_plan.hpp"
#include "draw/identify/parts_texts.hpp"
#include "draw/scene.hpp"

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
