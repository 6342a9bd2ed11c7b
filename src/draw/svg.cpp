#include "rollfix/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

constexpr double kSubscriptDrop = 0.22;
constexpr std::string_view kFont = "'DejaVu Sans', Verdana, sans-serif";

/// A hundredth of a pixel is enough for a print at ten times the size, and short.
std::string number(double value) {
  if (!std::isfinite(value)) throw InternalError(fmt::format("a figure's coordinate must be finite, found {}", value));
  std::string text = fmt::format("{:.2f}", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string attributes(const Paint& paint) {
  std::string text = fmt::format(" fill=\"{}\"", paint.fill);
  if (paint.fill != "none" && paint.fill_opacity < 1)
    text += fmt::format(" fill-opacity=\"{}\"", number(paint.fill_opacity));
  if (paint.stroke == "none") return text;
  text += fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", paint.stroke, number(paint.width));
  if (paint.stroke_opacity < 1) text += fmt::format(" stroke-opacity=\"{}\"", number(paint.stroke_opacity));
  if (!paint.dash.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", paint.dash);
  return text;
}

void append_points(std::string& path, const std::vector<Vec2>& points) {
  char command = 'M';
  for (const Vec2& point : points) {
    path += fmt::format("{}{} {}", command, number(point.x()), number(point.y()));
    command = 'L';
  }
}

std::string tspan(const Span& span, double size, double shift) {
  std::string attribute;
  if (span.italic) attribute += " font-style=\"italic\"";
  if (span.bold) attribute += " font-weight=\"bold\"";
  if (span.subscript) attribute += fmt::format(" font-size=\"{}\"", number(kSubscriptSize * size));
  if (shift != 0) attribute += fmt::format(" dy=\"{}\"", number(shift));
  if (attribute.empty()) return escape_xml(span.text);
  return fmt::format("<tspan{}>{}</tspan>", attribute, escape_xml(span.text));
}

/// The text's pieces; a subscript moves the pen down, what follows it moves it up again.
std::string tspans(const Text& text, double size) {
  std::string out;
  bool lowered = false;
  for (const Span& span : text) {
    const double drop = kSubscriptDrop * size;
    const double shift = span.subscript == lowered ? 0 : (span.subscript ? drop : -drop);
    lowered = span.subscript;
    out += tspan(span, size, shift);
  }
  return out;
}

std::string_view anchor_name(Align align) {
  switch (align) {
    case Align::middle:
      return "middle";
    case Align::end:
      return "end";
    case Align::start:
      break;
  }
  return "start";
}

}  // namespace

Svg::Svg(double width, double height) : width_(width), height_(height) {
  if (!(width > 0 && height > 0)) {
    throw InternalError(fmt::format("a figure's size must be positive, found {} x {}", width, height));
  }
}

void Svg::open_group(std::string_view name) {
  body_ += fmt::format("<g class=\"{}\">\n", escape_xml(name));
  open_.emplace_back("</g>\n");
}

void Svg::close_group() {
  if (open_.empty()) throw InternalError("a figure's group was closed that had not been opened");
  body_ += open_.back();
  open_.pop_back();
}

void Svg::open_clip(double x, double y, double width, double height) {
  // A nested viewport clips without an id, so pictures can be put side by side without clashes.
  const std::string box = fmt::format("{} {} {} {}", number(x), number(y), number(width), number(height));
  body_ += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" viewBox=\"{}\">\n", number(x), number(y),
                       number(width), number(height), box);
  open_.emplace_back("</svg>\n");
}

void Svg::polyline(const std::vector<Vec2>& points, const Paint& paint) {
  if (points.empty()) return;
  body_ += "<path d=\"";
  append_points(body_, points);
  body_ += fmt::format("\"{}/>\n", attributes(paint));
}

void Svg::polygon(const std::vector<Vec2>& points, const Paint& paint) { loops({points}, paint); }

void Svg::loops(const std::vector<std::vector<Vec2>>& loops, const Paint& paint) {
  body_ += "<path d=\"";
  for (const std::vector<Vec2>& loop : loops) {
    if (loop.empty()) continue;
    append_points(body_, loop);
    body_ += "Z";
  }
  body_ += fmt::format("\" fill-rule=\"evenodd\"{}/>\n", attributes(paint));
}

void Svg::segments(const std::vector<Vec2>& ends, const Paint& paint) {
  if (ends.size() < 2) return;
  body_ += "<path d=\"";
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) append_points(body_, {ends[i], ends[i + 1]});
  body_ += fmt::format("\"{}/>\n", attributes(paint));
}

void Svg::circle(const Vec2& centre, double radius, const Paint& paint) {
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", number(centre.x()), number(centre.y()),
                       number(radius), attributes(paint));
}

void Svg::rectangle(double x, double y, double width, double height, const Paint& paint) {
  body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", number(x), number(y), number(width),
                       number(height), attributes(paint));
}

void Svg::text(const Vec2& anchor, const Text& text, const TextStyle& style) {
  const std::string x = number(anchor.x()), y = number(anchor.y());
  std::string attribute = fmt::format(" x=\"{}\" y=\"{}\" font-size=\"{}\"", x, y, number(style.size));
  if (style.align != Align::start) attribute += fmt::format(" text-anchor=\"{}\"", anchor_name(style.align));
  if (style.turn != 0) attribute += fmt::format(" transform=\"rotate({} {} {})\"", number(style.turn), x, y);
  const std::string content = tspans(text, style.size);
  // Two copies rather than paint-order, which some viewers do not know.
  if (style.halo) {
    body_ += fmt::format(
        "<text{} fill=\"none\" stroke=\"#ffffff\" stroke-width=\"3\" stroke-opacity=\"0.85\" aria-hidden=\"true\">"
        "{}</text>\n",
        attribute, content);
  }
  body_ += fmt::format("<text{} fill=\"{}\">{}</text>\n", attribute, style.fill, content);
}

void Svg::embed(const Svg& picture, double x, double y) {
  body_ += fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">\n", number(x), number(y),
                       number(picture.width_), number(picture.height_));
  if (!picture.title_.empty()) body_ += fmt::format("<title>{}</title>\n", escape_xml(picture.title_));
  body_ += picture.body_;
  for (auto tag = picture.open_.rbegin(); tag != picture.open_.rend(); ++tag) body_ += *tag;
  body_ += "</svg>\n";
}

std::string Svg::str() const {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
      "font-family=\"{2}\" stroke-linecap=\"round\" stroke-linejoin=\"round\" xml:space=\"preserve\">\n",
      number(width_), number(height_), kFont);
  if (!title_.empty()) out += fmt::format("<title>{}</title>\n", escape_xml(title_));
  out += fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n", number(width_), number(height_));
  out += body_;
  for (auto tag = open_.rbegin(); tag != open_.rend(); ++tag) out += *tag;
  return out + "</svg>\n";
}

namespace {

// Advance widths of DejaVu Sans from space to '~', thousandths of the font size.
constexpr std::array<int, 95> kRegular = {
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};
constexpr std::array<int, 95> kBold = {
    348, 456,  521, 838, 696, 1002, 872, 306, 457, 457, 523, 838, 380, 415,  380, 365, 696, 696,  696,
    696, 696,  696, 696, 696, 696,  696, 400, 400, 838, 838, 838, 580, 1000, 774, 762, 734, 830,  683,
    683, 821,  837, 372, 372, 775,  637, 995, 837, 850, 733, 850, 770, 720,  682, 812, 774, 1103, 771,
    724, 725,  457, 365, 457, 838,  500, 500, 675, 716, 593, 716, 678, 435,  716, 712, 343, 343,  665,
    343, 1042, 712, 687, 716, 716,  493, 595, 478, 712, 652, 924, 645, 652,  582, 712, 365, 712,  838};
constexpr int kOtherLetter = 640;  // Greek letters and the like
constexpr int kOtherWide = 1000;   // what takes three or more bytes: arrows, ellipses, ideographs

int advance(char32_t first_byte, std::size_t length, bool bold) {
  if (length == 1) {
    if (first_byte < 0x20 || first_byte > 0x7e) return 0;
    return (bold ? kBold : kRegular)[first_byte - 0x20];
  }
  return length == 2 ? kOtherLetter : kOtherWide;
}

}  // namespace

double text_width(const Text& text, double size) {
  double width = 0;
  for (const Span& span : text) {
    int thousandths = 0;
    for (std::size_t i = 0; i < span.text.size();) {
      const std::string_view rest = std::string_view(span.text).substr(i);
      const std::size_t length = std::max<std::size_t>(1, utf8_length(rest));
      thousandths += advance(static_cast<unsigned char>(rest[0]), length, span.bold);
      i += length;
    }
    width += 1e-3 * thousandths * size * (span.subscript ? kSubscriptSize : 1);
  }
  return width;
}

std::string escape_xml(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      out += "\xef\xbf\xbd";  // the replacement character
    } else if (length > 1) {
      out += is_control(text.substr(0, length)) ? " " : text.substr(0, length);
    } else if (text[0] == '&') {
      out += "&amp;";
    } else if (text[0] == '<') {
      out += "&lt;";
    } else if (text[0] == '>') {
      out += "&gt;";
    } else if (text[0] == '"') {
      out += "&quot;";
    } else {
      out += is_control(text.substr(0, 1)) ? ' ' : text[0];
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return out;
}

}  // namespace rollfix
