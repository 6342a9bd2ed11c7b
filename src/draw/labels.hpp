#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "outline/box.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/draw.hpp"
#include "trace.hpp"

namespace rollfix::draw {

/// Colours that the colour-blind can tell apart as well: Okabe and Ito's without the pale ones first, then darker
/// ones from Paul Tol's muted scheme.
constexpr std::array<std::string_view, 12> kPalette = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                       "#E69F00", "#56B4E9", "#882255", "#332288",
                                                       "#999933", "#117733", "#AA4499", "#7f7f7f"};

inline std::string_view colour(std::size_t number) { return kPalette[number % kPalette.size()]; }

constexpr std::string_view kInk = "#222222";       // text and the boundary
constexpr std::string_view kSoftInk = "#666666";   // text of less weight
constexpr std::string_view kBlocked = "#b2182b";   // where a finger can't go
constexpr std::string_view kMaterial = "#f3efe6";  // the part's inside

constexpr std::string_view kPaper = "#ffffff";

/// The size at which a text takes no more than this room: its own, or a smaller one.
double fitting_size(const Text& text, double size, double room);

/// A plain line's paint.
Paint stroke(std::string_view colour, double width, std::string_view dash = "", double opacity = 1);
/// An area's, without a rim and with one.
Paint filled(std::string_view colour, double opacity = 1);
Paint with_rim(std::string_view colour, std::string_view rim, double width);

/// Signs for points of a boundary, to be told apart without colour as well.
enum class Sign { line, area, inflection, vertex, corner };

/// A diamond, a triangle or a square at a point; for Sign::line a short stroke with the line's own dashes, for
/// Sign::area a filled oval. `size` is 1
/// for the usual one.
void draw_sign(Svg& svg, Sign sign, const Vec2& at, std::string_view colour, double size = 1,
               std::string_view dash = "");

/// The colour that goes with a sign of a point.
std::string_view sign_colour(Sign sign);

inline void append(Text& text, const Text& more) { text.insert(text.end(), more.begin(), more.end()); }

/// A letter with an index, if any.
inline Text symbol(const std::string& letter, const std::string& index = "") {
  Text text{{letter, true, false, false}};
  if (!index.empty()) text.push_back({index, false, false, true});
  return text;
}

struct LegendEntry {
  Sign sign = Sign::line;
  std::string_view colour;
  Text text;
  std::string dash{};  // of a line
};

inline constexpr double kLegendTextSize = 11;  // pixels

/// Entries in as many columns as fit, filled column by column.
class Legend {
 public:
  Legend() = default;
  Legend(std::vector<LegendEntry> entries, double width);

  /// For the text of an entry, where there is one column.
  static double room(double width);

  double height() const;  // 0 where there is no entry
  void draw(Svg& svg, double top) const;

 private:
  std::vector<LegendEntry> entries_;
  double width_ = 0;
  std::size_t columns_ = 1;
  std::size_t rows_ = 0;
};

/// `text` cut in its middle so that it is at most `width` pixels wide.
std::string shortened(const std::string& text, double width, double size, bool bold);

constexpr double kHeaderHeight = 46;  // pixels
constexpr double kPageMargin = 12;

/// The lines above a drawing: what it is, at the right what came out, and the small print below.
void draw_header(Svg& svg, const std::string& title, const std::string& outcome, const Text& small_print);

/// What labels should keep clear of, as a raster of the page.
class Obstacles {
 public:
  Obstacles(double width, double height);

  void add(const std::vector<Vec2>& polyline);
  void add_box(const Vec2& lo, const Vec2& hi);
  void add_circle(const Vec2& centre, double radius);

  /// To be called between the last `add` and the first `covered`.
  void finish();

  /// How many of the raster's cells in this box are taken; those beyond the page are.
  double covered(const Box& box) const;

  /// Where no label may stand at all, not even for want of a better place: other texts.
  void forbid(const Vec2& lo, const Vec2& hi);
  /// On the page, and nowhere forbidden.
  bool allows(const Box& box) const;

 private:
  void mark(double x, double y);

  std::ptrdiff_t columns_;
  std::ptrdiff_t rows_;
  std::vector<int> taken_;  // then the sums over all cells above and to the left
  std::vector<Box> forbidden_;
};

/// A label to be placed near one of its anchors, best straight along `normal` or against it.
struct LabelRequest {
  std::vector<Vec2> anchors;
  Vec2 normal;
  Vec2 size;
};

/// Where a label goes, and the anchor it is nearest to.
struct LabelPlace {
  Vec2 centre;
  Vec2 anchor;
};

/// Places for the labels: close to their anchors, clear of the obstacles and of one another as far as that goes.
std::vector<LabelPlace> place_labels(const std::vector<LabelRequest>& requests, const Obstacles& obstacles);

/// Labels that wait until everything they have to keep clear of is drawn.
class LabelSet {
 public:
  /// `anchors`: the places the label may stand at; `normal`: a direction away from the lines there.
  void add(std::vector<Vec2> anchors, const Vec2& normal, Text text, std::string_view colour, double size);

  /// Draws all that there is room for, those that were added first before others, with a thin line to the anchor where
  /// one had to stand off.
  void draw(Svg& svg, Obstacles& obstacles) const;

 private:
  struct Label {
    Text text;
    std::string_view colour;
    double size;
  };
  std::vector<Label> labels_;
  std::vector<LabelRequest> requests_;
};

}  // namespace rollfix::draw
