#include "label_set.hpp"

#include <utility>

namespace rollfix::draw {
namespace {

constexpr double kLongestGap = 8;       // pixels between anchor and label that need no line
constexpr double kLetterHeight = 1.05;  // of a label's box, as a fraction of the font size
constexpr double kBaseline = 0.32;      // below the box's centre, likewise

void draw_leader(Svg& svg, const LabelPlace& place, const Vec2& size, std::string_view colour) {
  const Vec2 lo = place.centre - 0.5 * size, hi = place.centre + 0.5 * size;
  const Vec2 nearest = place.anchor.cwiseMax(lo).cwiseMin(hi);
  if ((nearest - place.anchor).norm() <= kLongestGap) return;
  Paint paint;
  paint.stroke = colour;
  paint.width = 0.6;
  svg.segments({place.anchor, nearest}, paint);
}

}  // namespace

void LabelSet::add(std::vector<Vec2> anchors, const Vec2& normal, Text text, std::string_view colour, double size) {
  requests_.push_back({std::move(anchors), normal, Vec2(text_width(text, size), kLetterHeight * size)});
  labels_.push_back({std::move(text), colour, size});
}

void LabelSet::draw(Svg& svg, Obstacles& obstacles) const {
  obstacles.finish();
  const std::vector<LabelPlace> places = place_labels(requests_, obstacles);
  svg.open_group("labels");
  for (std::size_t i = 0; i < labels_.size(); ++i) draw_leader(svg, places[i], requests_[i].size, labels_[i].colour);
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    TextStyle style;
    style.size = labels_[i].size;
    style.align = Align::middle;
    style.fill = labels_[i].colour;
    style.halo = true;
    svg.text(places[i].centre + Vec2(0, kBaseline * style.size), labels_[i].text, style);
  }
  svg.close_group();
}

}  // namespace rollfix::draw
