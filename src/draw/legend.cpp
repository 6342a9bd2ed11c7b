#include "legend.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace rollfix::draw {
namespace {

constexpr double kRowHeight = 17;  // pixels
constexpr double kTextIndent = 26;
constexpr double kColumnGap = 20;
constexpr double kMostColumns = 4;

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

}  // namespace rollfix::draw
