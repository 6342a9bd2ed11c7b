#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/outline/curve.hpp"

namespace rollfix {

/// How a shape is painted. Colours are SVG colours ("#0072B2"); "none" paints nothing.
struct Paint {
  std::string fill = "none";
  std::string stroke = "none";
  double width = 1;         // of the stroke, pixels
  double fill_opacity = 1;  // 0 (invisible) to 1
  double stroke_opacity = 1;
  std::string dash;  // as stroke-dasharray; empty: a solid line
};

/// A piece of text in one style.
struct Span {
  std::string text;
  bool italic = false;
  bool bold = false;
  bool subscript = false;
};

/// Size of a subscript's letters, as a fraction of those around it.
inline constexpr double kSubscriptSize = 0.72;

/// A line of text: pieces one after the other.
using Text = std::vector<Span>;

/// Where a text's anchor point is on it.
enum class Align { start, middle, end };

struct TextStyle {
  double size = 11;  // pixels
  Align align = Align::start;
  std::string fill = "#222222";
  bool halo = false;  // a white rim keeps it legible on lines
  double turn = 0;    // degrees, clockwise as seen
};

/// A picture in Scalable Vector Graphics, written shape by shape. The same calls give the same bytes; text
/// stays text. Coordinates are pixels with y pointing down, printed to a hundredth. Names and captions from
/// users are escaped, so the document is always well formed.
/// Throws InternalError: a coordinate that is not finite.
class Svg {
 public:
  Svg(double width, double height);

  double width() const { return width_; }
  double height() const { return height_; }

  /// Groups nest; `name` becomes the class, so that pictures can be restyled and searched.
  void open_group(std::string_view name);
  void close_group();

  /// Everything up to the matching close_group is cut off at this rectangle. Coordinates stay those of the page.
  void open_clip(double x, double y, double width, double height);

  void polyline(const std::vector<Vec2>& points, const Paint& paint);
  void polygon(const std::vector<Vec2>& points, const Paint& paint);
  /// Several closed loops as one shape: what an even number of them encloses is a hole.
  void loops(const std::vector<std::vector<Vec2>>& loops, const Paint& paint);
  /// Line segments from each even point to the odd one after it.
  void segments(const std::vector<Vec2>& ends, const Paint& paint);
  void circle(const Vec2& centre, double radius, const Paint& paint);
  void rectangle(double x, double y, double width, double height, const Paint& paint);
  void text(const Vec2& anchor, const Text& text, const TextStyle& style = {});

  /// Another picture with its upper left corner at (x, y), cut off at its own edges.
  void embed(const Svg& picture, double x, double y);

  /// What screen readers and tool tips say.
  void describe(std::string_view title) { title_ = title; }
  const std::string& description() const { return title_; }

  /// The whole document.
  std::string str() const;

 private:
  double width_;
  double height_;
  std::string title_;
  std::string body_;
  std::vector<std::string_view> open_;  // closing tags still owed
};

/// Width in pixels of a text set in DejaVu Sans, the first font asked for; others differ by some percent.
double text_width(const Text& text, double size);

/// A user's text made fit for XML: control characters and broken UTF-8 replaced, markup escaped.
std::string escape_xml(std::string_view text);

enum class FigureFormat { svg, png, pdf };

/// The format that a file name's ending asks for, upper case or lower.
/// Throws InputError listing the known endings; `besides`: what it says of others that the caller takes.
FigureFormat figure_format(const std::filesystem::path& file, std::string_view besides = "");

/// The figure as the bytes of a file. PNG: white background, two pixels for each of the figure's.
/// The same figure gives the same bytes on the same machine (PNG and PDF depend on its fonts).
/// Throws InternalError: the renderer failed.
std::string encode(const Svg& figure, FigureFormat format);

/// Writes the figure in the format that the file's ending asks for. It is written beside the file under a
/// temporary name and then renamed: an older file is replaced whole or not at all.
/// Throws InputError: unknown ending, or a place that can't be written to.
void save_figure(const Svg& figure, const std::filesystem::path& file);

}  // namespace rollfix
