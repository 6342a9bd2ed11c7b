#include "check_two.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "budget.hpp"
#include "convex.hpp"
#include "cover.hpp"
#include "pair_equations.hpp"

namespace rollfix_verify {
namespace {

constexpr int kDeepest = 120;
constexpr std::size_t kMostPairs = 400000;  // of a cell, before it is given up
constexpr std::size_t kMostParts = 24;      // of a cell in which what may fit is looked for
constexpr double kMeetWork = 1e-3;          // to compare two cells, in expansions
// A start that fits is off by no more than so many tolerances: the search's outlines are good to a quarter of one.
constexpr double kBeyondTolerance = 1.25;
// A root's start is looked at on this share of the perimeter to either side.
constexpr double kBesideRoot = 1.1 * kRootLength;
// Of a placement that fits the start, as far as it can be told from what is beside it.
constexpr double kBesideStart = 0.25 * kSamePlace;

struct Placement {
  std::string name;
  std::string kind;
  std::array<Place, 2> start;
  std::optional<Box> box;
  enum Proof { one, fits, none } proof = none;  // exactly one root in its box; its start fits
  bool has_start = false;                       // in its box or in a cell of its own
  bool is_single = false;                       // no more than one root of some two equations in its box
  std::vector<Polygon> remains;                 // of its cells, where it is not single
  bool is_one_piece = true;                     // they are, and next to no other one's
};

class TwoFingers {
 public:
  explicit TwoFingers(const Document& document)
      : document_(document),
        boundary_(document.boundary()),
        curves_{FingerCurve(boundary_, lengths(0)), FingerCurve(boundary_, lengths(1))},
        equations_(turns(), facing()),
        tolerance_(document.tolerance()),
        period_(document.period()) {}

  Verdict check() {
    if (equations_.count() < 2) refuse("it has fewer than two equations");
    const Box all = whole();
    range_ = all;
    read_placements();
    check_boxes();
    for (Placement& placement : placements_) check_roots(placement);
    Verdict verdict;
    verdict.placements = placements_.size();
    const auto check_leaf = [&](const Leaf& leaf) {
      ++verdict.cells;
      if (!check_cell(leaf, verdict.cells - 1)) return;
      ++verdict.open;
      verdict.share += area(leaf.box) / area(all);
    };
    read_cover(document_.json().at("cells").get<std::string>(), all, check_leaf);
    if (verdict.open == 0) look_at_pieces();
    for (const Placement& placement : placements_) {
      check_placement(placement);
      const bool has_kind = placement.is_single || placement.kind != "crossing";  // check_placement looks at corners
      verdict.unproved += placement.proof == Placement::none || !has_kind || !placement.is_one_piece ? 1 : 0;
    }
    return verdict;
  }

 private:
  // ---- the question ----

  std::vector<Ball> lengths(std::size_t finger) const {
    std::vector<Ball> result = {0.0};
    for (const Json& reading : document_.json().at("readings")) {
      result.push_back(document_.length(reading.at("length").at(finger)));
    }
    return result;
  }

  std::vector<Ball> turns() const {
    std::vector<Ball> result;
    for (const Json& reading : document_.json().at("readings")) result.push_back(Document::turn(reading.at("turn")));
    return result;
  }

  std::optional<Ball> facing() const {
    const Json& stated = document_.json().at("facing");
    return stated.is_null() ? std::nullopt : std::optional<Ball>(Document::turn(stated));
  }

  /// All first contacts of a finger: on an open outline those whose rolls stay on it.
  Interval starts(std::size_t finger) const {
    double least = 0;
    double most = 0;
    for (const Ball& length : lengths(finger)) {
      least = std::min(least, length.middle());
      most = std::max(most, length.middle());
    }
    return {-least, period_ - most};
  }

  // ---- rows: pairs of places, with how far each equation is off there ----

  std::array<Place, 2> read_row(const Json& stated, const std::string& name) const {
    std::array<Place, 2> row;
    std::array<Stretch, 2> stretch;
    Ball slack = kTurnSlack;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      row[finger] = document_.place_at(stated.at("start").at(finger));
      stretch[finger].pivot = true;
      for (const Ball& length : lengths(finger)) {
        const std::optional<Place> contact = boundary_.after(row[finger].s + length);
        if (!contact) refuse(name + " has a contact at a joint");
        stretch[finger].from.push_back(contact->angle);
        slack = slack + kRounding * period_ * abs(boundary_.taylor(contact->curve, contact->u)[0]);
      }
    }
    const std::vector<Ball> off = equations_.off(stretch[0], stretch[1]);
    const auto listed = stated.at("off").get<std::vector<double>>();
    if (listed.size() != off.size()) refuse(name + " does not say how far each equation is off");
    for (std::size_t k = 0; k < off.size(); ++k) {
      if (!abs(off[k] - Ball(listed[k]) * tolerance_).is_below(slack)) refuse(name + " turns by another angle");
    }
    return row;
  }

  /// The box from one row to another one, once round where that is behind.
  Box box_between(const Json& from, const Json& to, const std::string& name) const {
    const std::array<Place, 2> first = read_row(from, name);
    const std::array<Place, 2> last = read_row(to, name);
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
      const std::array<Place, 2> from = read_row(document_.json().at("from"), "its first corner");
      Box box;
      for (std::size_t finger = 0; finger < 2; ++finger) {
        const double lo = from[finger].s.middle();
        box[finger] = {lo, (Ball(lo) + boundary_.perimeter()).upper()};
      }
      return box;
    }
    const Box box = box_between(document_.json().at("from"), document_.json().at("to"), "its range");
    const double slack = kLengthSlack * period_;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      if (!(box[finger].lo < starts(finger).lo + slack && box[finger].hi > starts(finger).hi - slack)) {
        refuse("it leaves out starts at an end");
      }
    }
    return box;
  }

  // ---- cells ----

  /// Within a box by more than rounding, but for whole laps.
  bool is_inside(const Box& inner, const Box& outer) const {
    const double slack = kSamePlace * period_;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      bool inside = false;
      for (const int lap : {-1, 0, 1}) {
        if (lap != 0 && !boundary_.closed()) continue;
        const double shift = lap * period_;
        inside = inside || (inner[finger].lo + shift >= outer[finger].lo + slack &&
                            inner[finger].hi + shift <= outer[finger].hi - slack);
      }
      if (!inside) return false;
    }
    return true;
  }

  /// A pair within a box, to what places are stated to.
  bool holds(const Box& box, const std::array<Place, 2>& pair) const {
    const double slack = kLengthSlack * period_;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const double s = pair[finger].s.middle();
      bool inside = false;
      for (const int lap : {-1, 0, 1}) {
        if (lap != 0 && !boundary_.closed()) continue;
        const double at = s + lap * period_;
        inside = inside || (at >= box[finger].lo - slack && at <= box[finger].hi + slack);
      }
      if (!inside) return false;
    }
    return true;
  }

  /// Whether it excludes nothing: it is of a placement that is not known to be the only one there, and what may fit in
  /// it can't be told.
  bool check_cell(const Leaf& leaf, std::size_t number) {
    const std::string name = "cell " + std::to_string(number);
    if (leaf.kind == Leaf::unproved) return true;
    if (leaf.kind == Leaf::apart) {
      try {
        prove_apart(leaf.box, std::max(leaf.bound, tolerance_));
      } catch (const std::domain_error& error) {
        refuse(name + ": " + error.what());
      }
      return false;
    }
    if (leaf.number >= placements_.size()) refuse(name + " is of a placement that is not listed");
    Placement& placement = placements_[leaf.number];
    if (placement.box) {
      if (!is_inside(leaf.box, *placement.box)) refuse(name + " is not within the box of " + placement.name);
    } else {
      placement.has_start = placement.has_start || holds(leaf.box, placement.start);
    }
    return !placement.is_single && !add_remains(leaf.box, placement.remains);
  }

  static double area(const Box& box) { return (box[0].hi - box[0].lo) * (box[1].hi - box[1].lo); }

  /// What may fit in a box. False: it can't be told.
  bool add_remains(const Box& box, std::vector<Polygon>& remains) {
    std::size_t parts = 0;
    try {
      const std::vector<Stretch>& all_b = curves_[1].over(box[1].lo, box[1].hi, FingerCurve::Cuts::bends);
      for (const Stretch& a : curves_[0].over(box[0].lo, box[0].hi, FingerCurve::Cuts::bends)) {
        for (const Stretch& b : all_b) {
          if (!add_remains(a, b, parts, remains)) return false;
        }
      }
    } catch (const std::domain_error&) {
      return false;
    }
    return true;
  }

  /// Where equations are planes to some tolerances, a convex set holds all that fits, and what it holds is off by
  /// kNear tolerances at the most.
  bool add_remains(const Stretch& a, const Stretch& b, std::size_t& parts, std::vector<Polygon>& remains) {
    if (equations_.are_apart(a, b, tolerance_)) return true;
    const std::vector<PairEquations::Plane> planes = equations_.planes(a, b);
    const auto is_flat = [&](const PairEquations::Plane& plane) { return plane.off <= 0.5 * (kNear - 1) * tolerance_; };
    if (!planes.empty() && std::all_of(planes.begin(), planes.end(), is_flat)) {
      Polygon set{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      for (const PairEquations::Plane& plane : planes) {
        set = clipped(set, plane.at, {plane.by_a, plane.by_b}, tolerance_ + plane.off);
        set = clipped(set, -plane.at, {-plane.by_a, -plane.by_b}, tolerance_ + plane.off);
      }
      for (auto& [s, t] : set) {
        s = a.lo + s * a.width();
        t = b.lo + t * b.width();
      }
      if (!set.empty()) remains.push_back(set);
      return true;
    }
    if (++parts > kMostParts || !(std::max(a.change(), b.change()) > 0)) return false;
    const bool halve_a = is_wider(a, b);
    const std::pair<Stretch, Stretch>& halves = halve_a ? curves_[0].halved(a) : curves_[1].halved(b);
    return add_remains(halve_a ? halves.first : a, halve_a ? b : halves.first, parts, remains) &&
           add_remains(halve_a ? halves.second : a, halve_a ? b : halves.second, parts, remains);
  }

  /// Whether the angles change more on the first.
  static bool is_wider(const Stretch& a, const Stretch& b) {
    return a.change() > b.change() || (a.change() == b.change() && a.width() > b.width());
  }

  void prove_apart(const Box& box, double bound) {
    std::size_t parts = 0;
    const std::vector<Stretch>& all_b = curves_[1].over(box[1].lo, box[1].hi);
    for (const Stretch& a : curves_[0].over(box[0].lo, box[0].hi)) {
      for (const Stretch& b : all_b) prove_apart(a, b, bound, 0, parts);
    }
  }

  /// By halves: of the stretch on which the angles change more.
  void prove_apart(const Stretch& a, const Stretch& b, double bound, int depth, std::size_t& parts) {
    if (equations_.are_apart(a, b, bound)) return;
    if (depth == kDeepest || ++parts > kMostPairs || !(std::max(a.change(), b.change()) > 0)) {
      refuse("it could not be proved near s = " + std::to_string(a.lo) + ", t = " + std::to_string(b.lo));
    }
    const bool halve_a = is_wider(a, b);
    const std::pair<Stretch, Stretch>& halves = halve_a ? curves_[0].halved(a) : curves_[1].halved(b);
    for (const Stretch* half : {&halves.first, &halves.second}) {
      prove_apart(halve_a ? *half : a, halve_a ? b : *half, bound, depth + 1, parts);
    }
  }

  // ---- placements ----

  void read_placements() {
    for (const Json& stated : document_.json().at("placements")) {
      Placement placement;
      placement.name = "placement " + std::to_string(placements_.size());
      const std::string kind = stated.at("kind").get<std::string>();
      Document::check_kind(placement.name, kind);
      if (kind == "corner" && stated.contains("tangent")) refuse(placement.name + " has a tangent, but pivots");
      for (std::size_t finger = 0; finger < 2; ++finger) {
        placement.start[finger] = document_.place_at(stated.at("at").at(finger));
        Document::Stated numbers{
            stated.at("start").at(finger), stated.at("end").at(finger), stated.at("point").at(finger), {}};
        if (kind != "corner") numbers.tangent = stated.at("tangent").at(finger);  // there the finger pivots
        document_.check_contact(placement.name, placement.start[finger], lengths(finger).back(), numbers);
      }
      const std::string proof = stated.at("proof").get<std::string>();
      if (proof != "one" && proof != "fits" && proof != "none") refuse(placement.name + " has a proof '" + proof + "'");
      placement.proof = proof == "one" ? Placement::one : proof == "fits" ? Placement::fits : Placement::none;
      if (stated.contains("box")) {
        placement.box = box_between(stated.at("box").at(0), stated.at("box").at(1), placement.name + "'s box");
        placement.has_start = holds(*placement.box, placement.start);
      }
      if (placement.proof == Placement::one && !placement.box) refuse(placement.name + " is the only one in no box");
      placement.kind = kind;
      placements_.push_back(placement);
    }
  }

  /// Boxes hold one placement each.
  void check_boxes() const {
    for (std::size_t i = 0; i < placements_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (placements_[i].box && placements_[k].box && meet(*placements_[i].box, *placements_[k].box)) {
          refuse(placements_[i].name + "'s box is not apart from that of " + placements_[k].name);
        }
      }
    }
  }

  bool meet(const Box& one, const Box& two) const {
    for (std::size_t finger = 0; finger < 2; ++finger) {
      bool here = false;
      for (const int lap : {-1, 0, 1}) {
        const double shift = boundary_.closed() ? lap * period_ : 0.0;
        here = here || (one[finger].lo + shift <= two[finger].hi && two[finger].lo <= one[finger].hi + shift);
      }
      if (!here) return false;
    }
    return true;
  }

  /// Whether its box has no more than one root, and what of that is claimed.
  void check_roots(Placement& placement) {
    if (!placement.box || placement.proof == Placement::none) return;
    const Roots roots = roots_in(*placement.box, tolerance_);
    placement.is_single = roots != Roots::unknown;
    const bool is_one = placement.proof == Placement::one;
    if (!placement.is_single) {
      if (is_one) refuse(placement.name + " could not be proved to be the only one");
      return;
    }
    if (is_one && equations_.count() != 2) refuse(placement.name + " is a root of two equations of more");
    if (is_one && placement.kind != (roots == Roots::one_pivot ? "corner" : "crossing")) {
      refuse(placement.name + " is of another kind than its proof");
    }
  }

  void check_placement(const Placement& placement) {
    if (placement.kind == "corner" && !is_at_corner(placement)) refuse(placement.name + " is at no corner");
    if (!fits(placement, kBeyondTolerance * tolerance_) && placement.proof != Placement::one) {
      refuse(placement.name + " does not fit");
    }
    if (placement.proof == Placement::none) return;
    if (!placement.has_start) refuse(placement.name + " is in no cell of its own");
    if (placement.proof == Placement::fits) return;
    if (!fits(placement, 2.2 * kRootTurn) && roots_in(around(placement, kBesideRoot), 0) == Roots::unknown) {
      refuse(placement.name + " is not where the equations are solved");
    }
  }

  bool is_at_corner(const Placement& placement) const {
    for (std::size_t finger = 0; finger < 2; ++finger) {
      for (const Ball& length : lengths(finger)) {
        if (rollfix_verify::is_at_corner(boundary_, placement.start[finger].s + length, kLengthSlack * period_)) {
          return true;
        }
      }
    }
    return false;
  }

  /// Where all that is not excluded is near to fitting: whether each placement's is one piece, next to no other one's.
  void look_at_pieces() {
    std::vector<std::pair<std::size_t, Polygon>> all;
    for (std::size_t k = 0; k < placements_.size(); ++k) {
      for (const Polygon& remains : placements_[k].remains) all.emplace_back(k, remains);
      if (!placements_[k].is_single) continue;
      const auto& [s, t] = *placements_[k].box;
      all.push_back({k, {{s.lo, t.lo}, {s.hi, t.lo}, {s.hi, t.hi}, {s.lo, t.hi}}});
    }
    Budget::spend(kMeetWork * static_cast<double>(all.size() * all.size()));
    std::vector<std::size_t> piece(all.size());
    std::iota(piece.begin(), piece.end(), 0U);
    const auto first = [&](std::size_t i) {
      while (piece[i] != i) i = piece[i] = piece[piece[i]];
      return i;
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (!meet(all[i].second, all[k].second)) continue;
        if (all[i].first != all[k].first) {
          placements_[all[i].first].is_one_piece = placements_[all[k].first].is_one_piece = false;
        }
        piece[first(i)] = first(k);
      }
    }
    std::vector<std::size_t> pieces(placements_.size(), 0);
    for (std::size_t i = 0; i < all.size(); ++i) pieces[all[i].first] += piece[i] == i ? 1 : 0;
    for (std::size_t k = 0; k < placements_.size(); ++k) {
      if (pieces[k] > 1) placements_[k].is_one_piece = false;
    }
  }

  /// To what places are told to.
  bool meet(const Polygon& one, const Polygon& two) const {
    for (const int s : {-1, 0, 1}) {
      for (const int t : {-1, 0, 1}) {
        if (!boundary_.closed() && (s != 0 || t != 0)) continue;
        if (are_near(one, two, {s * period_, t * period_}, 2 * kSamePlace * period_)) return true;
      }
    }
    return false;
  }

  Box around(const Placement& placement, double share) const {
    Box box;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const double s = placement.start[finger].s.middle();
      box[finger] = {s - share * period_, s + share * period_};
      if (boundary_.closed()) continue;
      box[finger].lo = std::clamp(box[finger].lo, range_[finger].lo, range_[finger].hi - 2 * share * period_);
      box[finger].hi = std::clamp(box[finger].hi, range_[finger].lo + 2 * share * period_, range_[finger].hi);
    }
    return box;
  }

  enum class Roots { unknown, one, one_pivot };

  /// Whether one stretch of each finger in the box has exactly one root, with all that is within the tolerance of it
  /// inside, and all others have none.
  Roots roots_in(const Box& box, double tolerance) {
    Roots result = Roots::unknown;
    std::size_t parts = 0;
    const std::vector<Stretch>& all_b = curves_[1].over(box[1].lo, box[1].hi);
    try {
      for (const Stretch& a : curves_[0].over(box[0].lo, box[0].hi)) {
        for (const Stretch& b : all_b) {
          if (!equations_.have_one_root(curves_[0], a, curves_[1], b, tolerance)) {
            prove_apart(a, b, tolerance, 0, parts);
            continue;
          }
          if (result != Roots::unknown) return Roots::unknown;
          result = a.pivot || b.pivot ? Roots::one_pivot : Roots::one;
        }
      }
    } catch (const std::domain_error&) {
      return Roots::unknown;
    }
    return result;
  }

  bool fits(const Placement& placement, double most) {
    const Box box = around(placement, kBesideStart);
    const std::vector<Stretch>& all_b = curves_[1].over(box[1].lo, box[1].hi);
    for (const Stretch& a : curves_[0].over(box[0].lo, box[0].hi)) {
      for (const Stretch& b : all_b) {
        if (equations_.fit_together(a, b, most)) return true;
      }
    }
    return false;
  }

  const Document& document_;
  const Boundary& boundary_;
  std::array<FingerCurve, 2> curves_;
  PairEquations equations_;
  double tolerance_;
  double period_;
  Box range_;  // all pairs
  std::vector<Placement> placements_;
};

}  // namespace

Verdict check_two_fingers(const Document& document) { return TwoFingers(document).check(); }

}  // namespace rollfix_verify
