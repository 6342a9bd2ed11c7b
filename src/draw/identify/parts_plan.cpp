#include "draw/identify/parts_plan.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix::draw {
namespace {

constexpr double kFaint = 0.9;              // strength that is seen to be less than that of others
constexpr std::size_t kMostNames = 30;      // more never fit
constexpr double kLeastRestOfParts = 1e-3;  // probability: less is not worth a word

double note_width(const std::string& text) { return text_width({{text}}, kNoteSize); }

/// With noise a place that is hardly probable is drawn, but doesn't count.
std::size_t that_count(const AnswerPlan& plan) {
  const Verdict& verdict = plan.figure->answer->verdict;
  const std::size_t all = plan.placements().size();
  if (verdict.name == Verdict::unique) return std::min<std::size_t>(all, 1);
  return verdict.name == Verdict::ambiguous ? std::min(all, verdict.places) : all;
}

bool is_anywhere(const AnswerPlan& plan, std::size_t k, std::size_t finger) {
  return plan.has_noise() ? plan.is_anywhere(k, finger) : plan.placements()[k].whole_loop[finger];
}

/// With noise as many digits as are known of both ends of a roll.
std::string place_text(const AnswerPlan& plan, double s, double sd) {
  return " " + (plan.has_noise() ? as_sure_as(s, sd) : pretty_on(plan.part(), s, 5));
}

/// Where a first contact was.
std::string start_text(const AnswerPlan& plan, std::size_t k, std::size_t finger, double sd) {
  const Placement& placement = plan.placements()[k];
  const Interval& extent = placement.extent[finger];
  if (is_anywhere(plan, k, finger)) return " anywhere";
  const bool is_range = !plan.has_noise() && !plan.has_pairs() && placement.kind == Kind::stretch;
  if (!is_range) return place_text(plan, placement.start[finger], sd);
  return fmt::format(" in [{}, {}]", pretty_on(plan.part(), extent.lo),
                     pretty_on(plan.part(), plan.part().boundary().base(extent.hi)));
}

std::string probability_text(const AnswerPlan& plan, std::size_t k) {
  const bool is_one_of_many = plan.has_noise() && plan.placements().size() > 1;
  return is_one_of_many ? " " + percent(plan.placements()[k].probability) + "," : "";
}

/// What is special about a placement.
Text kind_text(const Placement& placement) {
  return placement.kind == Kind::crossing ? Text{} : Text{{std::string(", ") + name_of(placement.kind)}};
}

/// As many of these, one behind the other, as there is room for; the first in any case.
Text fitting(const std::vector<Text>& pieces, double room) {
  Text text = pieces.front();
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    Text longer = text;
    append(longer, pieces[k]);
    if (text_width(longer, kLegendTextSize) > room) break;
    text = std::move(longer);
  }
  return text;
}

Text placement_text(const AnswerPlan& plan, std::size_t k, double room) {
  const Placement& placement = plan.placements()[k];
  const double sd = plan.has_noise() ? std::max(placement.sd[0], placement.end_sd[0]) : 0;
  Text start = contact_name(plan, {k, 0}, 0);
  start.push_back({":" + probability_text(plan, k) + start_text(plan, k, 0, sd)});
  if (is_anywhere(plan, k, 0) || placement.kind == Kind::stretch) return start;
  const std::size_t last = plan.roll({k, 0}).contacts.size();
  Text end;
  if (last > 0) {
    end.push_back({" \u2192 "});
    append(end, contact_name(plan, {k, 0}, last));
    end.push_back({place_text(plan, placement.end[0], sd)});
  }
  return fitting({start, end, kind_text(placement)}, room);
}

Text pair_text(const AnswerPlan& plan, std::size_t k, double room) {
  const Placement& placement = plan.placements()[k];
  std::vector<Text> pieces{{{fmt::format("{}:{} ", k, probability_text(plan, k))}}, {{", "}}};
  for (const std::size_t finger : {0U, 1U}) {
    append(pieces[finger], contact_name(plan, {k, finger}, 0));
    pieces[finger].push_back({start_text(plan, k, finger, plan.has_noise() ? placement.sd[finger] : 0)});
  }
  pieces.push_back(kind_text(placement));
  return fitting(pieces, room);
}

/// Of parts, what is not drawn.
std::vector<std::string> left_out(const PartsPlan& plan) {
  const PartsFigure& figure = *plan.figure;
  std::vector<std::string> sayings;
  const std::size_t drawn = plan.panels.size();
  if (figure.parts.size() > drawn) {
    double together = 0;
    for (std::size_t k = drawn; k < figure.parts.size(); ++k) together += figure.parts[k].probability;
    sayings.push_back(fmt::format("... and {} more", figure.parts.size() - drawn) +
                      (plan.has_noise() ? ", together " + percent(together) : ""));
  }
  if (plan.has_noise() && figure.rest >= kLeastRestOfParts) sayings.push_back("all others: " + percent(figure.rest));
  return sayings;
}

bool shows_band(const PanelPlan& panel) {
  const AnswerPlan& plan = panel.plan;
  for (std::size_t k = 0; plan.has_noise() && k < plan.placements().size(); ++k) {
    for (std::size_t finger = 0; finger < plan.figure->answer->finger_count(); ++finger) {
      if (plan.held(k, finger).width() * panel.scale >= kVisibleBand) return true;
    }
  }
  return false;
}

bool has_faint_roll(const PanelPlan& panel) {
  const AnswerPlan& plan = panel.plan;
  for (std::size_t k = 0; plan.has_noise() && k < plan.placements().size(); ++k) {
    if (plan.strength(k) < kFaint) return true;
  }
  return false;
}

/// What the signs mean.
std::vector<std::string> key(const PartsPlan& plan) {
  std::vector<std::string> sayings;
  if (plan.panels.size() > 1) {
    sayings.emplace_back(plan.one_scale ? "all parts to the same scale"
                                        : "each part to its own scale, as their sizes differ too much");
  }
  const auto is_any = [&](const auto& is_so) { return std::any_of(plan.panels.begin(), plan.panels.end(), is_so); };
  if (is_any([](const PanelPlan& panel) { return !panel.plan.has_arcs(); })) sayings.emplace_back("tick: a start");
  if (is_any(shows_band)) sayings.emplace_back("band: 95 % of a place");
  if (is_any(has_faint_roll)) sayings.emplace_back("faint: less likely than the strongest on the same part");
  return sayings;
}

constexpr std::size_t kMostPanels = 12;
constexpr std::size_t kMostPanelColumns = 3;
constexpr double kLeastPage = 640;    // pixels
constexpr double kLeastPanel = 210;   // wide, if there is more than one in a row
constexpr double kGap = 12;           // between panels
constexpr double kMostRatio = 5;      // of sizes that are seen at one scale
constexpr double kMostHeight = 440;   // of a drawing
constexpr double kMostSlender = 0.8;  // likewise, as a fraction of its width
constexpr double kLeastPanelHeight = 70;
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
  return std::max<std::size_t>(1, std::min({best, fitting, kMostPanelColumns}));
}

/// Of a few rolls beside a small part.
void make_small(AnswerPlan& plan) {
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
    row.body = std::max(row.body, std::max(drawing, kLeastPanelHeight) + panel.legend_height());
  }
  return rows;
}

}  // namespace

Legend panel_legend(const AnswerPlan& plan, double width) {
  const double room = Legend::room(width);
  std::vector<LegendEntry> entries;
  const std::size_t listed = plan.has_labels() ? std::min(that_count(plan), plan.most.listed) : 0;
  for (std::size_t k = 0; k < listed; ++k) {
    const bool pairs = plan.has_pairs();
    const std::string_view colour = pairs ? kSoftInk : plan.colour_of(k, 0);
    entries.push_back({Sign::line, colour, pairs ? pair_text(plan, k, room) : placement_text(plan, k, room)});
  }
  return {std::move(entries), width};
}

std::string places_text(const AnswerPlan& plan) {
  const Answer& answer = *plan.figure->answer;
  const std::size_t count = that_count(plan);
  std::string text = counted(count, "place", "places");
  if (answer.verdict.name == Verdict::ambiguous && count == 1) text = "one stretch";
  if (answer.verdict.name == Verdict::unique) text = "unique place";
  if (answer.verdict.name == Verdict::unobservable) text = "any place";
  if (plan.has_labels() && plan.most.listed < count) text += fmt::format(", {} listed", plan.most.listed);
  if (answer.verdict.fits_badly) text += ", the rows fit badly";
  if (answer.status == Status::incomplete) text += ", search incomplete";
  return text;
}

std::string congruent_text(const std::vector<std::string>& names, double width) {
  std::string text = "can't be told from ";
  for (std::size_t shown = std::min(names.size(), kMostNames); shown > 1; --shown) {
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(shown);
    std::string candidate = text + fmt::format("{}", fmt::join(names.begin(), end, ", "));
    if (shown < names.size()) candidate += fmt::format(" and {} more", names.size() - shown);
    if (note_width(candidate) <= width) return candidate;
  }
  const std::string more = names.size() > 1 ? fmt::format(" and {} more", names.size() - 1) : "";
  return text + shortened(names.front(), width - note_width(text + more), kNoteSize, false) + more;
}

std::string fit_text(const PartsFigure& figure) {
  if (figure.of == 0) return "";
  return fmt::format("{} of {} {}", figure.parts.size(), counted(figure.of, "part", "parts"),
                     figure.parts.size() == 1 ? "fits" : "fit");
}

Text roll_text(const PartsPlan& plan) {
  if (plan.panels.empty()) return {};
  if (!plan.panels.front().plan.has_pairs()) return small_print(plan.panels.front().plan);
  return {{"blue: finger a, orange: finger b; arcs: the rolls of the first pair, dots: other pairs\u2019 starts"}};
}

std::vector<std::string> footer_of(const PartsPlan& plan) {
  std::vector<std::string> sayings = left_out(plan);
  for (std::string& saying : key(plan)) sayings.push_back(std::move(saying));
  std::vector<std::string> lines;
  const double width = plan.width - 2 * kPageMargin;
  for (const std::string& saying : sayings) {
    if (!lines.empty() && note_width(lines.back() + "; " + saying) <= width) {
      lines.back() += "; " + saying;
    } else {
      lines.push_back(shortened(saying, width, kNoteSize, false));
    }
  }
  return lines;
}

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
