#pragma once

// Figures of parts, answers, advice and plans, as SVG, PNG or PDF.
//
//     const Part part = load_part("gallery:ellipse,a=2,b=1");
//     const Svg figure = draw_answer(solve({part, Reading(1.0, 0.5)}));
//     encode(figure, FigureFormat::svg).substr(0, 5);  // "<?xml"
//
// PNG and PDF need librsvg when they are written; without it they are an InputError.

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/advise.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/plan.hpp"
#include "rollfix/question.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

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

/// The roll that a part was taught by.
struct TaughtRows {
  std::vector<ReckonedRow> rows;  // see dead_reckoned
  double lap = 0;                 // how much of their length is in the part
  double gap = 0;                 // from the lap's end to its start, length
  bool closes = true;             // a lap was looked for
  std::string closing;            // what was done about the gap, in words
};

/// What a part is: its shape with inflections, vertices, corners and a scale of arc length, and below it the
/// curvature and the turning function by arc length. A curvature with peaks far above the rest is cut, and the plot
/// says so.
struct PartFigure {
  const Part* part = nullptr;     // not owned; required
  std::string title;              // empty: the part's name
  double width = 640;             // pixels
  std::optional<Reach> reach{};   // of a finger: where it can't touch is marked
  std::vector<Outline> others{};  // of a drawing: its other loops, drawn thin
  TaughtRows taught{};            // of a part that was taught: the rows and the gap are drawn as well
};

/// Throws InputError: no part.
Svg draw_part(const PartFigure& figure);

/// What a figure of an answer shows.
///
/// Of one finger, the paper's Figure 7 for any part: placement i is an arc beside the boundary from its start a_i to
/// its contact at the last reading, b_i (one reading), c_i (two) and so on; arcs that would overlap are stacked
/// outward. A translucent band is a placement's extent, where that is wide enough to see: every start in it fits.
/// Labels up to 20 placements, a legend up to 12; beyond 120 only the starts.
///
/// With noise the extents make way for what is probable: areas outside of the boundary are as high as the first contact
/// is dense there, bands hold 95 % of each placement, and the legend has the probabilities. Below lie the density over
/// s, and up to four narrow placements of it enlarged.
///
/// With `log`, where it tells of the fingers' places, the part and the fingers as they were in the world; with noise
/// also the ellipse and the fan that hold 95 % of the part's place and heading, and its outline at the ends of its
/// pose's spread. What would be too small to see is drawn larger, and the figure says how many times.
///
/// Of two fingers, Figure 8: at the left the part with one placement's rolls as arcs beside the boundary, finger a's
/// from s_0 over s_1 to s_2 and finger b's from t_0 over t_1 to t_2, and the first contacts of the other placements as
/// numbered dots. At the right all pairs (s, t) as a square: a line for each equation, f_k(s, t) = 0, and the
/// placements, by the same numbers, where the lines meet. A stretch is a broad line there. Numbers up to 20 placements.
/// With noise an ellipse holds 95 % of each pair; the likeliest are enlarged below, with the ellipse that holds a half,
/// and what each finger has by itself at the sides.
///
/// What is left out where there is too much of it, the figure says.
struct AnswerFigure {
  const Answer* answer = nullptr;          // not owned; required
  std::optional<std::size_t> highlight{};  // of one finger the placement drawn stronger, with the finger; of two the
                                           // one whose rolls are drawn, none: the first
  std::vector<std::size_t> numbers{};      // of the placements, in labels and colours; empty: 0, 1, 2, ...
  std::string title{};                     // empty: the part's name
  double width = 0;                        // pixels; 0: 640 of one finger, 960 of two or with the world
  const Log* log = nullptr;                // of the roll, not owned: draws the part and the fingers in the world
  std::vector<Outline> others{};           // of a drawing: its other loops, drawn thin
};

/// Throws InputError: no answer, or an index that is out of range.
Svg draw_answer(const AnswerFigure& figure);
inline Svg draw_answer(const Answer& answer) { return draw_answer(AnswerFigure{&answer}); }

/// Several figures of one finger in a row, to one scale when they are of the same part.
Svg side_by_side(const std::vector<AnswerFigure>& figures);

/// For placements that are left after rolling on: which of the earlier ones each continues, by the nearest start.
/// Give it to the later figure as `numbers`, so that a placement keeps its label and its colour.
std::vector<std::size_t> numbers_of(const Answer& later, const Answer& earlier);

/// Which of many parts a roll can have been on: those that remain side by side, each with its outline and its
/// placements as in AnswerFigure, though smaller. Up to 12 are drawn, and it is said how many more there are.
///
/// All are drawn to one scale, so that their sizes compare, unless they differ by more than 5 times: then each has a
/// scale of its own. With noise each has its probability, its rolls are drawn as strong as they are probable beside the
/// likeliest on that part, and the likeliest part is framed. Of two fingers the rolls of a part's first pair are drawn,
/// dots for the others.
struct PartsFigure {
  struct Entry {
    std::string name;
    double probability = std::numeric_limits<double>::quiet_NaN();  // that it is this part; NaN: no noise
    const Answer* answer = nullptr;                                 // of this part alone, not owned; required
    std::vector<std::string> congruent{};                           // parts that can't be told from it
  };

  std::vector<Entry> parts;  // with noise the likeliest first; none: nothing fits
  std::string verdict;
  std::size_t of = 0;  // so many parts were asked; 0: not said
  double rest = 0;     // with noise: probability of all parts that are not here
  double width = 0;    // pixels, at least 640; 0: 640 of one part, 960 of several
};

/// Throws InputError: an entry without an answer, a page that is too narrow.
Svg draw_parts(const PartsFigure& figure);

/// The world: the part in each pose that touches leave (the likeliest drawn strong, up to six), the touches as dots
/// with their normals, and the finger around them.
struct TouchFigure {
  const TouchAnswer* answer = nullptr;  // not owned; required
  std::string title{};                  // empty: the part's name
  double width = 640;                   // pixels
  std::vector<Outline> others{};        // of a drawing: its other loops, drawn thin in the likeliest pose
  const NextTouch* next = nullptr;      // the advised approach is drawn as well; not owned
};

/// Throws InputError: no answer.
Svg draw_touches(const TouchFigure& figure);

/// The world: the part at the last instant in each placement (the likeliest drawn strong, up to six), where it was at
/// the first one in the likeliest, and the ways of the fingers' centres with the fingers where they are at the end.
/// Where that is one of a continuum, a first contact that is free is no point but a broad line, on the outline as it
/// was at first: with noise what holds 95 % of it.
struct HoldFigure {
  const HoldAnswer* answer = nullptr;  // not owned; required
  std::string title{};                 // empty: the part's name
  double width = 640;                  // pixels
  std::vector<Outline> others{};       // of a drawing: its other loops, drawn thin in the likeliest placement
};

/// Throws InputError: no answer.
Svg draw_hold(const HoldFigure& figure);

/// The figure of a solution of whichever kind: see AnswerFigure, TouchFigure, HoldFigure.
struct SolutionFigure {
  const Question* question = nullptr;  // not owned; required: of one roll its log is drawn
  const Solution* solution = nullptr;  // to it; not owned; required
  std::vector<Outline> others{};       // of a drawing: its other loops, drawn thin
  std::string title{};                 // empty: the part's name
};

/// Throws InputError as the figure of its kind does.
Svg draw_solution(const SolutionFigure& figure);

/// What is to be expected of rolling on: the placements that remain and the bits gained, by the roll's length, and the
/// roll that is advised.
struct AdviceFigure {
  Advice advice;
  std::string title;
  std::string outcome;
  double width = 640;  // pixels
};

Svg draw_advice(const AdviceFigure& figure);

/// The world: the part and the fingers where a plan ends, or where it first fails, with the friction cones and the line
/// of the force there; dashed where they start; the ways of the fingers' frames.
struct PlanFigure {
  const Plan* plan = nullptr;            // not owned; required
  const PlanProblem* problem = nullptr;  // that it is of; required
  std::string title{};                   // empty: the part's name
  double width = 640;                    // pixels
};

/// Throws InputError: no plan.
Svg draw_plan(const PlanFigure& figure);

}  // namespace rollfix
