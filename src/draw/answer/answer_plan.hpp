#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "draw/labels.hpp"
#include "draw/plot.hpp"
#include "draw/rolls.hpp"
#include "draw/scene.hpp"
#include "rollfix/draw.hpp"

namespace rollfix::draw {

/// A placement's roll of one finger, drawn beside the boundary.
struct Way {
  std::size_t placement = 0;
  std::size_t finger = 0;
};

/// One equation f(s, t) = 0 of two fingers: a reading's, or the facing.
struct PairLine {
  std::optional<std::size_t> reading;  // none: the facing
  std::string_view colour;
  std::string dash;
  Text name;
};

/// More placements than these get less: no arcs, no labels, of one finger no list.
struct Most {
  std::size_t arcs = 120;
  std::size_t labels = 20;
  std::size_t listed = 12;
};

/// Everything about a figure of an answer that is decided before it is drawn: what is shown, and on which lane.
struct AnswerPlan {
  const AnswerFigure* figure = nullptr;
  std::optional<std::size_t> shown;  // of two fingers the placement whose rolls are drawn
  std::vector<Reading> readings;     // along the outline as stored: of a part that lies face down with other signs
  std::optional<double> facing;      // likewise
  std::array<Roll, 2> rolls;         // of either finger
  Roll clockwise_roll;               // of one, where placements are of either way round
  std::vector<Way> ways;             // of one finger every placement's, of two those of the shown one
  Lanes lanes;                       // of the ways
  double spacing = kLaneSpacing;     // between lanes, pixels
  Framing framing;                   // of the part; beside it is the square of two fingers
  std::vector<PairLine> lines;       // what the square shows
  Most most;
  double label_size = 13;    // of contacts, pixels
  bool cuts_finger = false;  // one is so much larger than the part
  bool fades = false;        // with noise: rolls are as strong as they are probable, and labels don't say how probable

  bool has_pairs() const { return figure->answer->finger_count() == 2; }
  const Part& part() const { return figure->answer->part; }
  const std::vector<Placement>& placements() const { return figure->answer->placements; }
  const Placement& placement(const Way& way) const { return placements()[way.placement]; }
  const Roll& roll(const Way& way) const { return placement(way).clockwise ? clockwise_roll : rolls[way.finger]; }
  /// What holds 95 % of a placement, with noise; nearly all of a closed boundary is all of it.
  Interval held(std::size_t placement, std::size_t finger) const;
  bool is_anywhere(std::size_t placement, std::size_t finger) const;
  /// How probable a placement is beside the likeliest: 0 to 1.
  double strength(std::size_t placement) const;
  double start(const Way& way) const { return placement(way).start[way.finger]; }

  /// With probabilities.
  bool has_noise() const { return figure->answer->weighing.has_value(); }
  bool has_arcs() const;
  /// The log says where the fingers were in the world, and the answer where the part was.
  bool has_world() const;
  /// The placement that is looked at there.
  std::size_t world_placement() const;
  bool has_labels() const;
  bool has_list() const;
  bool has_finger(const Way& way) const;
  /// What areas and bands mean, and what the figure leaves out because there is too much of it; empty: nothing.
  std::string key() const;
  /// Whether contact k = 0, 1, 2, ... has a name of its own (the first and the last have in any case).
  bool is_named(std::size_t k) const;

  std::size_t number(std::size_t placement) const;
  std::string_view colour_of(const Way& way) const;
  /// Of a placement's mark or its area: of one finger its own colour, of two the finger's.
  std::string_view colour_of(std::size_t placement, std::size_t finger) const {
    return colour_of(Way{placement, finger});
  }
  double line_width(const Way& way) const;
  /// Of a finger that is a disk and known.
  std::optional<double> radius(std::size_t finger) const;
  double width() const;  // of the page, pixels, as given or by the number of fingers

  /// The length travelled at contact k, and where it is.
  double travelled(const Way& way, std::size_t k) const { return k == 0 ? 0 : roll(way).contacts[k - 1]; }
  double place(const Way& way, std::size_t k) const;
  /// Distance in pixels from the boundary of a run of ways[way], `travelled` along the run.
  double offset(std::size_t way, const Run& run, double travelled) const;
};

/// Throws InputError: no answer, or an index that is out of range. The figure has to outlive the plan.
AnswerPlan plan_of(const AnswerFigure& figure);

inline constexpr std::array<std::string_view, 2> kFingerColours = {kPalette[0], kPalette[1]};

/// The name of contact k: of one finger a0, b0, with the placement's number, of two s0, s1 and t0, t1.
Text contact_name(const AnswerPlan& plan, const Way& way, std::size_t k);

/// The name of a first contact, with noise and its probability where there are several.
Text start_name(const AnswerPlan& plan, const Way& way);

/// The line below the title: the readings of one finger, or whose rolls of two are shown.
Text small_print(const AnswerPlan& plan);

/// What lies below the drawing: of one finger the placements with their contacts, unless there are many; of two both
/// fingers' contacts and the equations.
Legend legend_of(const AnswerPlan& plan);

/// What the square of all pairs takes of a page of this width, at the right of the part: pixels.
double plane_width(double page_width);
double plane_height(double page_width);

/// With noise an interval narrower than this is its contact's mark, pixels.
inline constexpr double kVisibleBand = 2;

/// What fits with the placements, or holds 95 % of each, under the boundary.
void draw_bands(Svg& svg, const AnswerPlan& plan, const Scene& scene);

/// How dense the first contacts are, as areas outside of the boundary.
void draw_ribbons(Svg& svg, const AnswerPlan& plan, const Scene& scene, const Clearance& clearance,
                  Obstacles& obstacles);

/// Below the legend, with noise: the density over s, of two fingers the likeliest pairs. Pixels.
double spread_width(const AnswerPlan& plan);
double spread_height(const AnswerPlan& plan);
void draw_spread(Svg& svg, const AnswerPlan& plan, double top);

/// The part and the fingers in the world: beside the part, of two fingers below it at the right. 0: not shown.
double world_width(const AnswerPlan& plan);
void draw_world(Svg& svg, const AnswerPlan& plan, const Box& area);

/// The square of all pairs with its lines and placements.
void draw_pair_plane(Svg& svg, const AnswerPlan& plan);

/// Draws an answer's placements at the boundary: each roll as an arc beside it with its marks and their names, of two
/// fingers those of the shown pair and dots for the others. Where there are too many for arcs, a tick at each start.
class PlacementPen {
 public:
  /// All of them have to outlive the pen.
  PlacementPen(Svg& svg, const AnswerPlan& plan, const Scene& scene, RollPen& pen, LabelSet& labels)
      : svg_(svg), plan_(plan), scene_(scene), pen_(pen), labels_(labels) {}

  void draw();

 private:
  /// The path of one run on the page, in the direction of the roll.
  struct Arc {
    std::size_t way;
    const Run* run;
    std::vector<Vec2> path;
  };

  void rolls_of_all();
  void rolls_of_both();
  void ticks();
  void dots();
  void dots_of(std::size_t finger);
  void add_arcs(std::size_t way, std::size_t most_points, std::vector<Arc>& arcs) const;
  void stems(const std::vector<Arc>& arcs);
  void lines(const std::vector<Arc>& arcs);
  void marker(const Way& way, std::size_t k);
  double marker_size(const Way& way, std::size_t k) const;
  void label(std::size_t i, std::size_t k, const std::vector<Arc>& arcs);
  /// The colour that a way is drawn in: its own, or this one; as strong as the plan says.
  std::string ink(const Way& way) const;
  std::string ink(const Way& way, std::string_view colour) const;

  Svg& svg_;
  const AnswerPlan& plan_;
  const Scene& scene_;
  RollPen& pen_;
  LabelSet& labels_;
};

}  // namespace rollfix::draw
