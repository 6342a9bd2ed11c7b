#include "labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

// What is written, and its colours and signs. Notation of labels:
//   a, n            anchors of a label and the direction away from the lines there: LabelRequest
//   candidate       a place at a distance d from an anchor, by an angle off n or -n; its cost in pixels is d, what the
//                   angle is worth, and what is covered of the box: `candidates`
//   N               of the raster of what is taken, sums over all cells above and to the left: `taken_`
//   covered         N at the box's four corners, added and subtracted: F. C. Crow, "Summed-area tables for texture
//                   mapping" (1984)
// Idea: each label takes its cheapest place; then, a few times over, each in turn the cheapest in view of where the
// others are now.
namespace rollfix::draw {
namespace {

constexpr double kRowHeight = 17;  // pixels
constexpr double kTextIndent = 26;
constexpr double kColumnGap = 20;
constexpr double kMostColumns = 4;

constexpr double kCell = 2;             // pixels
constexpr double kRim = 1.5;            // kept free around a label, pixels
constexpr double kMostSteps = 4096;     // along one edge: longer ones are mostly beyond the page
constexpr int kSweeps = 4;              // times that every label may move in view of the others
constexpr double kCellPenalty = 9;      // pixels of distance that a covered cell is worth
constexpr double kOverlapPenalty = 2;   // ... that a square pixel of another label is worth
constexpr double kSidewaysPenalty = 5;  // ... that a radian off the normal is worth
constexpr std::array<double, 9> kAngles = {0, 0.4, -0.4, 0.8, -0.8, 1.2, -1.2, 1.57, -1.57};
constexpr int kDistances = 14;
constexpr double kNearest = 3.5;  // from the anchor to the label's edge, pixels
constexpr double kDistanceStep = 4;

Box rimmed(const Vec2& centre, const Vec2& size) {
  return {centre - 0.5 * size - Vec2(kRim, kRim), centre + 0.5 * size + Vec2(kRim, kRim)};
}

double overlap(const Box& a, const Box& b) {
  const Vec2 common = a.max().cwiseMin(b.max()) - a.min().cwiseMax(b.min());
  return common.x() > 0 && common.y() > 0 ? common.x() * common.y() : 0;
}

/// Distance from a box's centre to its edge in a direction.
double reach(const Vec2& size, const Vec2& direction) {
  const double x = std::abs(direction.x()), y = std::abs(direction.y());
  return 0.5 * std::min(x > 1e-9 ? size.x() / x : 1e9, y > 1e-9 ? size.y() / y : 1e9);
}

struct Candidate {
  LabelPlace place;
  double cost;
};

Vec2 turned(const Vec2& direction, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * direction.x() - s * direction.y(), s * direction.x() + c * direction.y()};
}

/// All places to try for a label with what each costs in view of the obstacles alone, cheapest first.
std::vector<Candidate> candidates(const LabelRequest& request, const Obstacles& obstacles) {
  std::vector<Candidate> out;
  for (const Vec2& anchor : request.anchors) {
    for (const double side : {1.0, -1.0}) {
      for (const double angle : kAngles) {
        const Vec2 direction = turned(side * request.normal, angle);
        for (int i = 0; i < kDistances; ++i) {
          const double distance = kNearest + kDistanceStep * i;
          const Vec2 centre = anchor + (distance + reach(request.size, direction)) * direction;
          const double cost = distance + kSidewaysPenalty * std::abs(angle) +
                              kCellPenalty * obstacles.covered(rimmed(centre, request.size));
          out.push_back({{centre, anchor}, cost});
        }
      }
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return out;
}

/// The cheapest candidate of label i in view of where the others are.
LabelPlace cheapest(std::size_t i, const std::vector<Candidate>& choices, const std::vector<LabelRequest>& requests,
                    const std::vector<LabelPlace>& places) {
  double least = 1e300;
  LabelPlace best = places[i];
  for (const Candidate& choice : choices) {
    if (choice.cost >= least) break;
    double cost = choice.cost;
    const Box box = rimmed(choice.place.centre, requests[i].size);
    for (std::size_t k = 0; k < requests.size() && cost < least; ++k) {
      if (k != i) cost += kOverlapPenalty * overlap(box, rimmed(places[k].centre, requests[k].size));
    }
    if (cost >= least) continue;
    least = cost;
    best = choice.place;
  }
  return best;
}

constexpr double kLongestGap = 8;       // pixels between anchor and label that need no line
constexpr double kLetterHeight = 1.05;  // of a label's box, as a fraction of the font size
constexpr double kBaseline = 0.32;      // below the box's centre, likewise

void draw_leader(Svg& svg, const LabelPlace& place, const Vec2& size, std::string_view colour) {
  const Vec2 lo = place.centre - 0.5 * size, hi = place.centre + 0.5 * size;
  const Vec2 nearest = place.anchor.cwiseMax(lo).cwiseMin(hi);
  if ((nearest - place.anchor).norm() <= kLongestGap) return;
  svg.segments({place.anchor, nearest}, stroke(colour, 0.6));
}

}  // namespace

std::string shortened(const std::string& text, double width, double size, bool bold) {
  const auto fits = [&](const std::string& candidate) {
    return text_width({{candidate, false, bold, false}}, size) <= width;
  };
  const auto starts_letter = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xc0) != 0x80; };
  if (fits(text)) return text;
  // A letter can't be narrower than a tenth of the size, so that more than these are hopeless.
  const auto most = static_cast<std::size_t>(std::max(1.0, 10 * width / size));
  for (std::size_t kept = std::min(text.size(), most); kept > 1; --kept) {
    std::size_t head = (kept + 1) / 2, tail = text.size() - kept / 2;
    while (head > 0 && !starts_letter(head)) --head;
    while (tail < text.size() && !starts_letter(tail)) ++tail;
    std::string candidate = text.substr(0, head) + "\u2026" + text.substr(tail);
    if (fits(candidate)) return candidate;
  }
  return "\u2026";
}

double fitting_size(const Text& text, double size, double room) {
  const double width = text_width(text, size);
  return width <= room ? size : size * room / width;
}

Paint stroke(std::string_view colour, double width, std::string_view dash, double opacity) {
  Paint paint;
  paint.stroke = colour;
  paint.width = width;
  paint.dash = dash;
  paint.stroke_opacity = opacity;
  return paint;
}

Paint filled(std::string_view colour, double opacity) {
  Paint paint;
  paint.fill = colour;
  paint.fill_opacity = opacity;
  return paint;
}

Paint with_rim(std::string_view colour, std::string_view rim, double width) {
  Paint paint = stroke(rim, width);
  paint.fill = colour;
  return paint;
}

void draw_sign(Svg& svg, Sign sign, const Vec2& at, std::string_view colour, double size, std::string_view dash) {
  const auto moved = [&](double x, double y) { return Vec2(at + size * Vec2(x, y)); };
  Paint paint = with_rim(kPaper, colour, 0.6 + 0.6 * size);
  switch (sign) {
    case Sign::line:
      paint.width = 2.4;
      paint.dash = dash;
      svg.segments({moved(-8, 0), moved(8, 0)}, paint);
      break;
    case Sign::area: {
      paint = with_rim(colour, kInk, 1);
      std::vector<Vec2> rim;
      for (int k = 0; k < 32; ++k) {
        const double angle = 2 * std::numbers::pi * k / 32;
        rim.push_back(moved(8 * std::cos(angle), 4.5 * std::sin(angle)));
      }
      svg.polygon(rim, paint);
      break;
    }
    case Sign::inflection:
      svg.polygon({moved(0, -4), moved(4, 0), moved(0, 4), moved(-4, 0)}, paint);
      break;
    case Sign::vertex:
      paint.fill = colour;
      svg.polygon({moved(0, -3.6), moved(3.4, 2.4), moved(-3.4, 2.4)}, paint);
      break;
    case Sign::corner:
      svg.rectangle(moved(-2.5, 0).x(), moved(0, -2.5).y(), 5 * size, 5 * size, paint);
      break;
  }
}

std::string_view sign_colour(Sign sign) {
  switch (sign) {
    case Sign::inflection:
      return kPalette[1];
    case Sign::vertex:
      return kPalette[0];
    case Sign::line:
    case Sign::area:
    case Sign::corner:
      break;
  }
  return kInk;
}

Legend::Legend(std::vector<LegendEntry> entries, double width) : entries_(std::move(entries)), width_(width) {
  if (entries_.empty()) return;
  double widest = 0;
  for (const LegendEntry& entry : entries_) widest = std::max(widest, text_width(entry.text, kLegendTextSize));
  const double fitting = std::floor((width_ - 2 * kPageMargin) / (widest + kTextIndent + kColumnGap));
  columns_ = static_cast<std::size_t>(std::clamp(fitting, 1.0, kMostColumns));
  rows_ = (entries_.size() + columns_ - 1) / columns_;
}

double Legend::room(double width) { return width - 2 * kPageMargin - kTextIndent; }

double Legend::height() const { return rows_ == 0 ? 0 : static_cast<double>(rows_) * kRowHeight + 14; }

void Legend::draw(Svg& svg, double top) const {
  if (rows_ == 0) return;
  const double column_width = (width_ - 2 * kPageMargin) / static_cast<double>(columns_);
  svg.open_group("legend");
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::size_t column = i / rows_, row = i % rows_;
    const Vec2 at(kPageMargin + column_width * static_cast<double>(column),
                  top + 14 + kRowHeight * static_cast<double>(row));
    draw_sign(svg, entries_[i].sign, at + Vec2(10, 0), entries_[i].colour, 1, entries_[i].dash);
    const double room = column_width - kTextIndent - (columns_ > 1 ? 0.5 * kColumnGap : 0);
    svg.text(at + Vec2(kTextIndent, 4), entries_[i].text, {fitting_size(entries_[i].text, kLegendTextSize, room)});
  }
  svg.close_group();
}

void draw_header(Svg& svg, const std::string& title, const std::string& outcome, const Text& small_print) {
  const double right = svg.width() - kPageMargin;
  const double outcome_width = text_width({{outcome, false, true, false}}, 12);
  const double title_size = 13;
  const std::string fitting = shortened(title, right - kPageMargin - outcome_width - 16, title_size, true);
  svg.open_group("header");
  svg.text({kPageMargin, 20}, {{fitting, false, true, false}}, {title_size});
  svg.text({right, 20}, {{outcome, false, true, false}}, {12, Align::end});
  const double small = fitting_size(small_print, 11, right - kPageMargin);
  if (!small_print.empty()) svg.text({kPageMargin, 37}, small_print, {small, Align::start, std::string(kSoftInk)});
  svg.close_group();
  svg.describe(title + ": " + outcome);
}

Obstacles::Obstacles(double width, double height)
    : columns_(static_cast<std::ptrdiff_t>(width / kCell) + 1),
      rows_(static_cast<std::ptrdiff_t>(height / kCell) + 1),
      taken_(static_cast<std::size_t>(columns_ * rows_), 0) {}

void Obstacles::mark(double x, double y) {
  const auto column = static_cast<std::ptrdiff_t>(std::floor(x / kCell));
  const auto row = static_cast<std::ptrdiff_t>(std::floor(y / kCell));
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return;
  taken_[static_cast<std::size_t>(row * columns_ + column)] = 1;
}

void Obstacles::add(const std::vector<Vec2>& polyline) {
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
    const Vec2 edge = polyline[i + 1] - polyline[i];
    const double count = std::min(std::ceil(edge.norm() / kCell) + 1, kMostSteps);
    for (double k = 0; k <= count; ++k) {
      const Vec2 point = polyline[i] + k / count * edge;
      mark(point.x(), point.y());
    }
  }
}

void Obstacles::add_box(const Vec2& lo, const Vec2& hi) {
  for (double y = lo.y(); y < hi.y() + kCell; y += kCell) {
    for (double x = lo.x(); x < hi.x() + kCell; x += kCell) mark(std::min(x, hi.x()), std::min(y, hi.y()));
  }
}

void Obstacles::add_circle(const Vec2& centre, double radius) {
  std::vector<Vec2> rim;
  for (int k = 0; k <= 72; ++k) rim.emplace_back(centre + turned(Vec2(radius, 0), 2 * std::numbers::pi * k / 72));
  add(rim);
}

void Obstacles::finish() {
  for (std::ptrdiff_t row = 0; row < rows_; ++row) {
    int sum = 0;
    for (std::ptrdiff_t column = 0; column < columns_; ++column) {
      const auto here = static_cast<std::size_t>(row * columns_ + column);
      sum += taken_[here];
      taken_[here] = sum + (row > 0 ? taken_[here - static_cast<std::size_t>(columns_)] : 0);
    }
  }
}

void Obstacles::forbid(const Vec2& lo, const Vec2& hi) {
  add_box(lo, hi);
  forbidden_.emplace_back(lo, hi);
}

bool Obstacles::allows(const Box& box) const {
  const Vec2 page(static_cast<double>(columns_) * kCell, static_cast<double>(rows_) * kCell);
  if (box.min().minCoeff() < 0 || (page - box.max()).minCoeff() < 0) return false;
  return std::none_of(forbidden_.begin(), forbidden_.end(), [&](const Box& one) { return overlap(box, one) > 0; });
}

double Obstacles::covered(const Box& box) const {
  const auto column = [&](double x) {
    return std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(x / kCell)), -1, columns_ - 1);
  };
  const auto row = [&](double y) {
    return std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(y / kCell)), -1, rows_ - 1);
  };
  const std::ptrdiff_t left = column(box.min().x() - kCell), right = column(box.max().x());
  const std::ptrdiff_t top = row(box.min().y() - kCell), bottom = row(box.max().y());
  const auto sum = [&](std::ptrdiff_t r, std::ptrdiff_t c) {
    return r < 0 || c < 0 ? 0 : taken_[static_cast<std::size_t>(r * columns_ + c)];
  };
  const double inside = sum(bottom, right) - sum(top, right) - sum(bottom, left) + sum(top, left);
  // What sticks out of the page counts as covered.
  const Vec2 size = box.sizes();
  const Vec2 kept =
      box.max().cwiseMin(Vec2(static_cast<double>(columns_) * kCell, static_cast<double>(rows_) * kCell)) -
      box.min().cwiseMax(Vec2(0, 0));
  const double lost = size.x() * size.y() - std::max(0.0, kept.x()) * std::max(0.0, kept.y());
  return inside + lost / (kCell * kCell);
}

std::vector<LabelPlace> place_labels(const std::vector<LabelRequest>& requests, const Obstacles& obstacles) {
  std::vector<std::vector<Candidate>> choices;
  std::vector<LabelPlace> places;
  for (const LabelRequest& request : requests) {
    choices.push_back(candidates(request, obstacles));
    places.push_back(choices.back().front().place);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < requests.size(); ++i) places[i] = cheapest(i, choices[i], requests, places);
  }
  return places;
}

void LabelSet::add(std::vector<Vec2> anchors, const Vec2& normal, Text text, std::string_view colour, double size) {
  requests_.push_back({std::move(anchors), normal, Vec2(text_width(text, size), kLetterHeight * size)});
  labels_.push_back({std::move(text), colour, size});
}

void LabelSet::draw(Svg& svg, Obstacles& obstacles) const {
  obstacles.finish();
  const std::vector<LabelPlace> places = place_labels(requests_, obstacles);
  std::vector<std::size_t> kept;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    const Box box = rimmed(places[i].centre, requests_[i].size);
    const bool is_free =
        std::none_of(boxes.begin(), boxes.end(), [&](const Box& one) { return overlap(box, one) > 0; });
    if (!is_free || !obstacles.allows(box)) continue;
    kept.push_back(i);
    boxes.push_back(box);
  }
  svg.open_group("labels");
  for (const std::size_t i : kept) draw_leader(svg, places[i], requests_[i].size, labels_[i].colour);
  for (const std::size_t i : kept) {
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
