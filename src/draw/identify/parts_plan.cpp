#include "draw/identify/parts_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "draw/identify/parts_texts.hpp"
#include "rollfix/error.hpp"

namespace rollfix::draw {
namespace {

constexpr std::size_t kMostPanels = 12;
constexpr std::size_t kMostColumns = 3;
constexpr double kLeastPage = 640;    // pixels
constexpr double kLeastPanel = 210;   // wide, if there is more than one in a row
constexpr double kGap = 12;           // between panels
constexpr double kMostRatio = 5;      // of sizes that are seen at one scale
constexpr double kMostHeight = 440;   // of a drawing
constexpr double kMostSlender = 0.8;  // likewise, as a fraction of its width
constexpr double kLeastHeight = 70;
constexpr double kHeader = 42;         // the name and a line below it
constexpr double kHeaderLine = 14;     // one more line
constexpr double kProbabilityBar = 7;  // between name and line
constexpr double kNoLegend = 8;
constexpr double kAsLikely = 0.99;  // of the largest probability: nobody could say which is the likeliest

// A panel has room for less than a page.
constexpr Most kMostInPanel = {24, 6, 4};
constexpr double kPanelLaneSpacing = 5.5;
constexpr double kMostPanelLanes = 28;   // of all lanes together
constexpr double kLeastLaneSpacing = 2;  // arcs that are closer together are not drawn
constexpr double kLabelRoom = 20;
constexpr double kPanelLabelSize = 11;
constexpr double kLeastOnPage = 40;  // pixels that a part is taken for, at least, where gaps between arcs are decided

void require_valid(const PartsFigure& figure) {
  for (const PartsFigure::Entry& entry : figure.parts) {
    if (entry.answer == nullptr) throw InputError(fmt::format("a figure of parts: `{}` has no answer", entry.name));
  }
  if (figure.width != 0 && !(figure.width >= kLeastPage)) {
    throw InputError(fmt::format("a figure of parts is at least {} pixels wide, found {}", kLeastPage, figure.width));
  }
}

std::size_t columns_for(std::size_t panels, double width) {
  const auto fitting = static_cast<std::size_t>((width - 2 * kPageMargin + kGap) / (kLeastPanel + kGap));
  const std::size_t best = panels == 4 ? 2 : panels;  // rather two rows of two than one panel by itself
  return std::max<std::size_t>(1, std::min({best, fitting, kMostColumns}));
}

/// Of a few rolls beside a small part.
void make_small(Plan& plan) {
  const int count = plan.lanes.count * std::max(plan.rolls[0].lanes, plan.rolls[1].lanes);
  plan.most = kMostInPanel;
  if (!plan.has_pairs()) {
    plan.spacing = std::min(kPanelLaneSpacing, kMostPanelLanes / std::max(count, 1));
    if (plan.spacing < kLeastLaneSpacing) plan.most.arcs = 0;
  }
  const bool has_lanes = plan.has_arcs();
  plan.framing.margin = kFirstLane + (has_lanes ? plan.spacing * count : 0) + kLabelRoom;
  plan.framing.extras = Box();  // fingers are not drawn
  plan.label_size = kPanelLabelSize;
  plan.fades = true;
}

/// Plans of all panels for parts that are `pixels` large.
std::vector<PanelPlan> panels_of(const PartsFigure& figure, const std::vector<double>& pixels) {
  std::vector<PanelPlan> panels;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    PanelPlan panel;
    panel.entry = &figure.parts[k];
    panel.figure = std::make_unique<AnswerFigure>();
    panel.figure->answer = panel.entry->answer;
    panel.figure->width = std::max(pixels[k], kLeastOnPage);  // by which arcs on a lane keep their distance
    panel.plan = plan_of(*panel.figure);
    make_small(panel.plan);
    panel.is_likeliest = panel.entry->probability >= kAsLikely * figure.parts.front().probability;
    panels.push_back(std::move(panel));
  }
  return panels;
}

/// Whether all are drawn to one scale, and how large that makes each of them, near enough.
bool sizes_on_page(const PartsFigure& figure, double panel_width, std::vector<double>& pixels) {
  std::vector<double> sizes;
  for (std::size_t k = 0; k < std::min(figure.parts.size(), kMostPanels); ++k) {
    sizes.push_back(part_bounds(figure.parts[k].answer->part).sizes().maxCoeff());
  }
  if (sizes.empty()) return true;
  const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
  const bool one_scale = *most <= kMostRatio * *least;
  for (const double size : sizes) pixels.push_back(one_scale ? panel_width * size / *most : panel_width);
  return one_scale;
}

void choose_scales(PartsPlan& plan) {
  const double most_height = std::min(kMostHeight, kMostSlender * plan.panel_width);
  double least = std::numeric_limits<double>::infinity();
  for (PanelPlan& panel : plan.panels) {
    panel.scale = fitting_scale(panel.plan.framing, plan.panel_width, most_height);
    least = std::min(least, panel.scale);
  }
  if (!plan.one_scale) return;
  for (PanelPlan& panel : plan.panels) panel.scale = least;
}

std::vector<RowPlan> rows_of(const PartsPlan& plan) {
  std::vector<RowPlan> rows((plan.panels.size() + plan.columns - 1) / plan.columns);
  const double header = kHeader + (plan.has_noise() ? kProbabilityBar : 0);
  for (std::size_t k = 0; k < plan.panels.size(); ++k) {
    const PanelPlan& panel = plan.panels[k];
    RowPlan& row = rows[k / plan.columns];
    row.header = std::max(row.header, header + (panel.entry->congruent.empty() ? 0 : kHeaderLine));
    const double drawing = size_at(panel.plan.framing, panel.scale).y() + (plan.one_scale ? 0 : kScaleBarHeight);
    row.body = std::max(row.body, std::max(drawing, kLeastHeight) + panel.legend_height());
  }
  return rows;
}

}  // namespace

double PanelPlan::legend_height() const { return std::max(legend.height(), kNoLegend); }

bool PartsPlan::has_noise() const { return !figure->parts.empty() && !std::isnan(figure->parts.front().probability); }

Vec2 PartsPlan::corner_of(std::size_t panel) const {
  double y = kHeaderHeight;
  for (std::size_t row = 0; row < panel / columns; ++row) y += rows[row].height() + kGap;
  return {kPageMargin + static_cast<double>(panel % columns) * (panel_width + kGap), y};
}

double PartsPlan::grid_end() const {
  return panels.empty() ? kHeaderHeight : corner_of(panels.size() - 1).y() + rows.back().height();
}

PartsPlan plan_of(const PartsFigure& figure) {
  require_valid(figure);
  PartsPlan plan;
  plan.figure = &figure;
  plan.width = figure.width > 0 ? figure.width : figure.parts.size() > 1 ? 960 : 640;
  plan.columns = columns_for(std::min(figure.parts.size(), kMostPanels), plan.width);
  const auto columns = static_cast<double>(plan.columns);
  plan.panel_width = (plan.width - 2 * kPageMargin - (columns - 1) * kGap) / columns;
  std::vector<double> pixels;
  plan.one_scale = sizes_on_page(figure, plan.panel_width, pixels);
  plan.panels = panels_of(figure, pixels);
  choose_scales(plan);
  for (PanelPlan& panel : plan.panels) panel.legend = panel_legend(panel.plan, plan.panel_width);
  plan.rows = rows_of(plan);
  plan.footer = footer_of(plan);
  return plan;
}

}  // namespace rollfix::draw
