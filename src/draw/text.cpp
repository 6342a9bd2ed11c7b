#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "rollfix/draw/svg.hpp"
#include "text/text.hpp"

namespace rollfix {
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
      out += text.substr(0, length);
    } else if (text[0] == '&') {
      out += "&amp;";
    } else if (text[0] == '<') {
      out += "&lt;";
    } else if (text[0] == '>') {
      out += "&gt;";
    } else if (text[0] == '"') {
      out += "&quot;";
    } else {
      const auto byte = static_cast<unsigned char>(text[0]);
      out += byte < 0x20 || byte == 0x7f ? ' ' : text[0];
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return out;
}

}  // namespace rollfix
