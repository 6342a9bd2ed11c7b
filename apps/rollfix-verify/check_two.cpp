#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "check.hpp"
#include "document.hpp"
#include "pair_boxes.hpp"

// Notation, as in docs/certificates.md, "Two fingers":
//   (s, t)          a pair of first contacts: `start[0]`, `start[1]`
//   F(s, t)         A(s) - B(t), an equation for each reading, then the facing: `equations_`
//   X               the pairs at which every equation is off by no more than the tolerance
//   box, leaf       a stretch of s times one of t; a cell of the tree with its claim, and `whole_` holds all pairs
//   remains         convex sets that hold all of X in a cell: Placement::remains
// Follows docs/certificates.md, "What 'proved' means" and "Two fingers". read_cover walks through boxes that hold all
// pairs. T1, nothing else: check_cell, and look_at_pieces for what remains of the cells of each placement. T2, each is
// there: check_placement. T3, kind and count: check_roots and check_line. T4, the question: read_row, whole, and
// Document.
namespace rollfix_verify {
namespace {

constexpr double kMeetWork = 1e-3;  // to compare two cells, in expansions
// A start that fits is off by no more than so many tolerances: the search's outlines are good to a quarter of one.
constexpr double kBeyondTolerance = 1.25;
// A root's start is looked at on this share of the perimeter to either side.
constexpr double kBesideRoot = 1.1 * kRootLength;
// Of a placement that fits the start, as far as it can be told from what is beside it.
constexpr double kBesideStart = 0.25 * kSamePlace;

using Places = std::array<Place, 2>;
using Roots = PairBoxes::Roots;

struct Placement {
  std::string name;
  std::string kind;
  std::string
      proof;  // one: exactly one root in its box; family: each pair of its line fits; fits: its start does; none
  Places start;
  std::optional<Box> box;
  std::optional<PairLine> line;  // of a family
  std::optional<Box> extent;     // that holds all of a family
  bool has_start = false;        // in its box or in a cell of its own
  bool is_single = false;        // no more than one root of some two equations in its box
  std::vector<Polygon> remains;  // of its cells, where it is not single
  std::size_t pieces = 0;        // that these are, with the box of a single one
  bool is_apart = true;          // they are next to no other one's

  bool is_one_piece() const { return pieces <= 1 && is_apart; }
};

/// L_c of a finger's contacts from its first one, which stands at the front with 0.
std::vector<Ball> lengths(const Document& document, std::size_t finger) {
  std::vector<Ball> result = {0.0};
  for (const Json& reading : document.json().at("readings")) {
    result.push_back(document.length(reading.at("length").at(finger)));
  }
  return result;
}

/// One equation for each reading, and one for the facing if it is known.
PairEquations equations(const Document& document) {
  std::vector<Ball> turns;
  for (const Json& reading : document.json().at("readings")) turns.push_back(Document::turn(reading.at("turn")));
  const Json& facing = document.json().at("facing");
  return {turns, facing.is_null() ? std::nullopt : std::optional<Ball>(Document::turn(facing))};
}

/// Checks one certificate of two fingers; used once. Every refusal is a std::domain_error with its reason.
class TwoFingers {
 public:
  explicit TwoFingers(const Document& document)
      : document_(document),
        boundary_(document.boundary()),
        lengths_{lengths(document, 0), lengths(document, 1)},
        equations_(equations(document)),
        boxes_(boundary_, lengths_, equations_),
        tolerance_(document.tolerance()),
        period_(document.period()) {}

  /// The verdict without the question. The order matters: cells need the placements' boxes, roots and lines.
  Verdict check() {
    // One equation in two unknowns has lines of solutions.
    if (equations_.count() < 2) refuse("it has fewer than two equations");
    whole_ = whole();
    read_placements();
    check_apart();
    for (Placement& placement : placements_) check_roots(placement);
    for (const Placement& placement : placements_) check_line(placement);
    Verdict verdict;
    verdict.placements = placements_.size();
    const auto check_leaf = [&](const Leaf& leaf) {
      ++verdict.cells;
      if (!check_cell(leaf, verdict.cells - 1)) return;
      ++verdict.open;
      // Of all pairs.
      verdict.share += area(leaf.box) / area(whole_);
    };
    read_cover(document_.json().at("cells").get<std::string>(), whole_, check_leaf);
    // With open cells it is not known what lies between the sets.
    if (verdict.open == 0) look_at_pieces();
    for (const Placement& placement : placements_) {
      check_placement(placement);
      // Without one root of two equations nothing is known of a crossing.
      const bool has_kind = placement.is_single || placement.kind != "crossing";  // check_placement looks at corners
      verdict.families += placement.line ? 1 : 0;
      verdict.unproved += placement.proof == "none" || !has_kind || !placement.is_one_piece() ? 1 : 0;
    }
    return verdict;
  }

 private:
  // ---- rows: pairs of places, with how far each equation is off there ----

  /// T4: a pair of places, at which each equation is off by what is stated.
  Places read_row(const Json& stated, const std::string& name) const {
    Places row;
    std::array<Stretch, 2> stretch;
    Ball slack = kTurnSlack;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      row[finger] = document_.place_at(stated.at("start").at(finger));
      // One place as a stretch: only its angles count.
      stretch[finger].pivot = true;
      for (const Ball& length : lengths_[finger]) {
        const std::optional<Place> contact = boundary_.after(row[finger].s + length);
        if (!contact) refuse(name + " has a contact at a joint");
        stretch[finger].from.push_back(contact->angle);
        // What rounded places change the angles by.
        slack = slack + kRounding * period_ * abs(boundary_.bend(contact->curve, contact->u).curvature);
      }
    }
    const std::vector<Ball> off = equations_.off(stretch[0], stretch[1]);
    const auto listed = stated.at("off").get<std::vector<double>>();
    if (listed.size() != off.size()) refuse(name + " does not say how far each equation is off");
    for (std::size_t k = 0; k < off.size(); ++k) {
      if (!abs(off[k] - Ball(listed[k]) * tolerance_).is_below(slack)) {
        refuse_number(name + ", off, in tolerances", listed[k], off[k] * (1 / tolerance_));
      }
    }
    return row;
  }

  /// The box from one row to another one, once round where that is behind.
  Box box_between(const Json& from, const Json& to, const std::string& name) const {
    const Places first = read_row(from, name);
    const Places last = read_row(to, name);
    // Sides from the first row to the last one.
    Box box;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      Interval& side = box[finger];
      side = {first[finger].s.middle(), last[finger].s.middle()};
      if (!(side.lo < side.hi) && boundary_.closed()) side.hi += period_;
      if (!(side.lo < side.hi)) refuse(name + " ends before it begins");
    }
    return box;
  }

  /// Every pair there is. A closed outline's starts anywhere and goes round once.
  Box whole() const {
    if (boundary_.closed()) {
      const Places from = read_row(document_.json().at("from"), "its first corner");
      const auto round = [&](const Ball& s) {
        return Interval{s.middle(), (Ball(s.middle()) + boundary_.perimeter()).upper()};
      };
      return {round(from[0].s), round(from[1].s)};
    }
    const Box box = box_between(document_.json().at("from"), document_.json().at("to"), "its range");
    for (std::size_t finger = 0; finger < 2; ++finger) {
      // An open outline: all starts that leave room must be in the range.
      const Interval starts = document_.starts(lengths_[finger]);
      if (!box[finger].holds(starts, kLengthSlack * period_)) refuse("it leaves out starts at an end");
    }
    return box;
  }

  // ---- boxes ----

  /// Of a box of pairs, for shares of all pairs.
  static double area(const Box& box) { return box[0].width() * box[1].width(); }

  /// Whether that is so of each finger's side of a box, on some lap.
  template <class Is>
  bool on_some_lap(const Box& box, const Is& is) const {
    const std::vector<double>& laps = boundary_.laps();
    const auto is_so = [&](std::size_t finger) {
      return std::any_of(laps.begin(), laps.end(), [&](double shift) {
        return is(Interval{box[finger].lo + shift, box[finger].hi + shift}, finger);
      });
    };
    return is_so(0) && is_so(1);
  }

  /// Inside another one by that at least.
  bool is_inside(const Box& inner, const Box& outer, double margin) const {
    return on_some_lap(inner, [&](const Interval& side, std::size_t k) { return outer[k].holds(side, -margin); });
  }

  /// On some lap of each finger.
  bool meet(const Box& one, const Box& two) const {
    return on_some_lap(one, [&](const Interval& side, std::size_t k) { return side.meets(two[k]); });
  }

  /// So far around a pair; of an open outline no further than its range.
  Box around(const Places& pair, double share) const {
    const double reach = share * period_;
    Box box;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const double s = pair[finger].s.middle();
      const auto& [lo, hi] = whole_[finger];
      box[finger] = {s - reach, s + reach};
      if (boundary_.closed()) continue;
      // Moved inwards so that the box stays as wide beside an end.
      box[finger] = {std::clamp(s - reach, lo, hi - 2 * reach), std::clamp(s + reach, lo + 2 * reach, hi)};
    }
    return box;
  }

  // ---- cells ----

  /// Whether it excludes nothing: it is of a placement that is not known to be the only one there, and what may fit in
  /// it can't be told.
  bool check_cell(const Leaf& leaf, std::size_t number) {
    const std::string name = "cell " + std::to_string(number);
    if (leaf.kind == Leaf::unproved) return true;
    // T1: excluded, by what is stated and by the tolerance.
    if (leaf.kind == Leaf::apart) {
      try {
        boxes_.prove_apart(leaf.box, std::max(leaf.bound, tolerance_));
      } catch (const std::domain_error& error) {
        refuse(name + ": " + error.what());
      }
      return false;
    }
    if (leaf.number >= placements_.size()) refuse(name + " is of a placement that is not listed");
    // T1: of a placement. With a box the cell lies inside it by a place's width, so that cells beside the box are not.
    Placement& placement = placements_[leaf.number];
    if (!placement.box) {
      placement.has_start = placement.has_start || holds(leaf.box, placement.start);
    } else if (!is_inside(leaf.box, *placement.box, kSamePlace * period_)) {
      refuse(name + " is not within the box of " + placement.name);
    }
    // Its box holds at most one root, with all that is within the tolerance.
    if (placement.is_single) return false;
    // Else what may fit in the cell is kept for `look_at_pieces`.
    const std::optional<std::vector<Polygon>> remains =
        boxes_.remains(leaf.box, tolerance_, placement.line ? &*placement.line : nullptr);
    if (!remains) return true;
    placement.remains.insert(placement.remains.end(), remains->begin(), remains->end());
    return false;
  }

  /// A pair in a box, to what places are stated to.
  bool holds(const Box& box, const Places& pair) const {
    const double s = pair[0].s.middle();
    const double t = pair[1].s.middle();
    return is_inside({{{s, s}, {t, t}}}, box, -kLengthSlack * period_);
  }

  // ---- placements ----

  /// T4 of the placements: kinds, proofs, places, boxes and lines, as they are stated.
  void read_placements() {
    for (const Json& stated : document_.json().at("placements")) {
      Placement placement;
      placement.name = "placement " + std::to_string(placements_.size());
      placement.kind = Document::kind_of(placement.name, stated);
      for (std::size_t finger = 0; finger < 2; ++finger) {
        placement.start[finger] = document_.contact(placement.name, stated, lengths_[finger].back(), finger);
      }
      placement.proof = stated.at("proof").get<std::string>();
      if (placement.proof == "family") {
        read_family(stated, placement);
      } else if (placement.proof != "one" && placement.proof != "fits" && placement.proof != "none") {
        refuse(placement.name + " has a proof '" + placement.proof + "'");
      }
      // The box from corner to corner, by rows whose values are checked.
      if (stated.contains("box")) {
        placement.box = box_between(stated.at("box").at(0), stated.at("box").at(1), placement.name + "'s box");
        placement.has_start = holds(*placement.box, placement.start);
      }
      if (placement.proof == "one" && !placement.box) refuse(placement.name + " is the only one in no box");
      placements_.push_back(placement);
    }
  }

  /// A line of pairs and the extent that holds all of it. A family must have no box.
  void read_family(const Json& stated, Placement& placement) const {
    const auto ends = stated.at("family").get<std::array<std::array<double, 2>, 2>>();
    placement.line.emplace(boundary_, lengths_, ends[0], ends[1]);
    placement.extent.emplace();
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const auto [lo, hi] = stated.at("extent").at(finger).get<std::array<double, 2>>();
      (*placement.extent)[finger] = {lo, hi};
    }
    if (placement.kind != "stretch") refuse(placement.name + " is of another kind than a family");
    if (stated.contains("box")) refuse(placement.name + " is a family in a box");
  }

  /// Boxes hold one placement each.
  void check_apart() const {
    for (std::size_t i = 0; i < placements_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (placements_[i].box && placements_[k].box && meet(*placements_[i].box, *placements_[k].box)) {
          refuse(placements_[i].name + "'s box is not apart from that of " + placements_[k].name);
        }
      }
    }
  }

  /// Whether its box has no more than one root, and what of that is claimed.
  void check_roots(Placement& placement) {
    if (!placement.box || placement.proof == "none") return;
    const Roots roots = boxes_.roots_in(*placement.box, tolerance_);
    placement.is_single = roots != Roots::unknown;
    if (placement.proof != "one") return;
    // T3 of `one`: two equations, one root of both.
    if (!placement.is_single) refuse(placement.name + " could not be proved to be the only one");
    if (equations_.count() != 2) refuse(placement.name + " is a root of two equations of more");
    if (placement.kind != (roots == Roots::one_pivot ? "corner" : "crossing")) {
      refuse(placement.name + " is of another kind than its proof");
    }
  }

  /// Each pair of a family's line fits, its start among them.
  void check_line(const Placement& placement) const {
    if (!placement.line) return;
    const auto& [s, t] = placement.start;
    if (!placement.line->holds(s.s.middle(), t.s.middle(), kLengthSlack * period_)) {
      refuse(placement.name + " is not on its line");
    }
    if (!placement.line->fits(equations_, tolerance_)) refuse(placement.name + "'s line could not be proved to fit");
  }

  /// All that fits of a family is in its extent, to what places are told to.
  void check_extent(const Placement& placement) const {
    const double slack = kLengthSlack * period_;
    for (const Polygon& set : placement.remains) {
      Box box;
      for (std::size_t finger = 0; finger < 2; ++finger) {
        // The set's bounding box.
        const auto [lo, hi] = std::minmax_element(
            set.begin(), set.end(), [&](const auto& one, const auto& two) { return one[finger] < two[finger]; });
        box[finger] = {(*lo)[finger], (*hi)[finger]};
      }
      const bool is_inside = on_some_lap(box, [&](const Interval& side, std::size_t k) {
        const Interval& extent = (*placement.extent)[k];
        // An extent of a whole lap claims nothing.
        return (boundary_.closed() && extent.width() >= period_ - slack) || extent.holds(side, slack);
      });
      if (!is_inside) refuse(placement.name + " is larger than its extent");
    }
  }

  /// T2 and T3 of one placement; T1 of a family's extent.
  void check_placement(const Placement& placement) {
    if (placement.extent) check_extent(placement);
    // One of the two fingers pivots.
    if (placement.kind == "corner" && !is_at_corner(placement, 0) && !is_at_corner(placement, 1)) {
      refuse(placement.name + " is at no corner");
    }
    const Box beside = around(placement.start, kBesideStart);
    // With one root, the start must be at that root; else all equations fit together beside the start.
    const bool is_one = placement.proof == "one";
    if (!is_one && !boxes_.may_fit(beside, kBeyondTolerance * tolerance_)) refuse(placement.name + " does not fit");
    if (placement.proof == "none") return;
    if (!placement.has_start) refuse(placement.name + " is in no cell of its own");
    // Two ways to be the root: off by rounding alone, or with exactly one root within kBesideRoot.
    if (is_one && !boxes_.may_fit(beside, 2.2 * kRootTurn) &&
        boxes_.roots_in(around(placement.start, kBesideRoot), 0) == Roots::unknown) {
      refuse(placement.name + " is not where the equations are solved");
    }
  }

  bool is_at_corner(const Placement& placement, std::size_t finger) const {
    return rollfix_verify::is_at_corner(boundary_, placement.start[finger].s, lengths_[finger], kLengthSlack * period_);
  }

  /// Where all that is not excluded is near to fitting: whether each placement's is one piece, next to no other one's.
  /// T1: sets that come as near as places are told are one piece. Union-find over all sets; quadratic in their number.
  void look_at_pieces() {
    std::vector<std::pair<Placement*, Polygon>> all;
    for (Placement& placement : placements_) {
      for (const Polygon& remains : placement.remains) all.emplace_back(&placement, remains);
      if (!placement.is_single) continue;
      const auto& [s, t] = *placement.box;
      all.push_back({&placement, {{s.lo, t.lo}, {s.hi, t.lo}, {s.hi, t.hi}, {s.lo, t.hi}}});
    }
    Budget::spend(kMeetWork * static_cast<double>(all.size() * all.size()));
    std::vector<std::size_t> piece(all.size());  // of each set another one that it hangs together with, or itself
    std::iota(piece.begin(), piece.end(), 0U);
    // The root of a set's piece; paths are halved on the way.
    const auto first = [&](std::size_t i) {
      while (piece[i] != i) i = piece[i] = piece[piece[i]];
      return i;
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (!meet(all[i].second, all[k].second)) continue;
        // Two placements that hang together are not shown to be two.
        if (all[i].first != all[k].first) all[i].first->is_apart = all[k].first->is_apart = false;
        piece[first(i)] = first(k);
      }
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      // Each set that stands for itself is a piece.
      if (piece[i] == i) ++all[i].first->pieces;
    }
  }

  /// To what places are told to.
  bool meet(const Polygon& one, const Polygon& two) const {
    for (const double s : boundary_.laps()) {
      for (const double t : boundary_.laps()) {
        if (are_near(one, two, {s, t}, 2 * kSamePlace * period_)) return true;
      }
    }
    return false;
  }

  const Document& document_;
  const Boundary& boundary_;
  std::array<std::vector<Ball>, 2> lengths_;  // how far from the first contact each one is
  PairEquations equations_;
  PairBoxes boxes_;
  double tolerance_;
  double period_;
  Box whole_;  // all pairs
  std::vector<Placement> placements_;
};

}  // namespace

Verdict check_two_fingers(const Document& document) { return TwoFingers(document).check(); }

}  // namespace rollfix_verify
