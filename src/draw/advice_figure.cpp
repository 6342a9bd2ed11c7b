#include "rollfix/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>

#include "legend.hpp"
#include "plot.hpp"
#include "scene.hpp"

namespace rollfix {
namespace draw {
namespace {

constexpr double kGainLeft = 58;  // pixels
constexpr double kGainRight = 16;
constexpr double kGainHeight = 150;
constexpr double kGainGap = 46;  // above each plot
constexpr double kGainEnd = 44;  // below the last one

/// One quantity by the roll's length.
struct GainPlot {
  Text title;
  std::function<double(const ExpectedGain&)> value;
  double most = 1;
  std::string_view colour;
};

void draw_gains(Svg& svg, const Advice& advice, const GainPlot& plot, double top, double width) {
  Axes axes;
  axes.corner = {kGainLeft, top};
  axes.size = {width - kGainLeft - kGainRight, kGainHeight};
  axes.x = widened({advice.gains.front().length, advice.gains.back().length}, 0.02);
  axes.y = widened({0, plot.most}, 0.06);
  axes.y.lo = 0;
  draw_axes(svg, axes, round_ticks(axes.x, 8), round_ticks(axes.y, 5), plot.title, "");
  std::vector<Vec2> points;
  for (const ExpectedGain& gain : advice.gains) points.push_back(axes(gain.length, plot.value(gain)));
  svg.segments({axes(0, axes.y.lo), axes(0, axes.y.hi)}, stroke(kSoftInk, 0.8));
  draw_graph(svg, axes, points, stroke(plot.colour, 1.6));
  if (!advice.helps) return;
  const ExpectedGain& advised = advice.advised();
  svg.segments({axes(advised.length, axes.y.lo), axes(advised.length, axes.y.hi)}, stroke(kInk, 1, "4 3"));
  svg.circle(axes(advised.length, plot.value(advised)), 4, filled(plot.colour));
}

/// What the length along the plots means.
std::string about_way(const PerFinger<double>& way) {
  if (way.size() == 1) return "rolling on from where the contact is now; below 0: backwards";
  const auto of = [&](std::size_t finger) {
    const char* const name = finger == 0 ? "a" : "b";
    if (way[finger] == 0) return fmt::format("{} stays", name);
    return way[finger] == 1 ? fmt::format("{} rolls on", name)
                            : fmt::format("{} by {:g} times as far", name, way[finger]);
  };
  return fmt::format("from where the contacts are now: finger {}, finger {}; below 0: backwards", of(0), of(1));
}

}  // namespace
}  // namespace draw

Svg draw_advice(const AdviceFigure& figure) {
  using namespace draw;
  const double top = kHeaderHeight + 30;
  const double second = top + kGainHeight + kGainGap;
  Svg svg(figure.width, second + kGainHeight + kGainEnd);
  svg.describe(figure.title + ": " + figure.outcome);
  svg.rectangle(0, 0, svg.width(), svg.height(), filled(kPaper));
  draw_header(svg, figure.title, figure.outcome, {{about_way(figure.advice.way)}});
  double most = 1;
  for (const ExpectedGain& gain : figure.advice.gains) most = std::max(most, gain.placements);
  draw_gains(
      svg, figure.advice,
      {{{"placements that remain, expected"}}, [](const ExpectedGain& p) { return p.placements; }, most, colour(0)},
      top, figure.width);
  draw_gains(svg, figure.advice,
             {{{"information gained, bits"}},
              [](const ExpectedGain& p) { return p.bits; },
              std::max(figure.advice.bits_wanted, 0.1),
              colour(1)},
             second, figure.width);
  Axes last;
  last.corner = {kGainLeft, second};
  last.size = {figure.width - kGainLeft - kGainRight, kGainHeight};
  draw_x_name(svg, last, {{"length rolled"}});
  return svg;
}

}  // namespace rollfix
