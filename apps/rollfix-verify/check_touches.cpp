#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "centre_tree.hpp"
#include "check.hpp"
#include "document.hpp"
#include "pose_search.hpp"

// Notation:
//   X, phi          a pose of the part, which has the part's point c at X + R(phi) c
//   q_i, tau_i      a touch's measured centre; the part's tangent in the world, by the measured normal
//   p + r n         the finger's centre where it touches at p: n the part's outward normal, r the finger's radius
//   off             a residual as a share of its tolerance
// Follows docs/certificates.md, "Touches": P1 is `cover`, P2 is `check_set`, P3 is Document.
// Idea: each stated pose is shown to fit, and `PoseSearch` shows that every pose that fits is in a stated set. A roll
// is its first contact, on what its readings leave (`RollStarts`); rolls stand before touches. A part that lies face
// down is looked at in the mirror x = -x.
namespace rollfix_verify {
namespace {

/// A stated set of poses.
struct StatedSet {
  std::array<double, 3> pose{};
  std::optional<PoseBox> extent;   // none: the pose is in another one's
  const Json* contacts = nullptr;  // nullptr: it is not said that a pose of the set fits
};

/// What a certificate of touches and rolls states, read and not yet checked. A part that lies face down is seen in the
/// mirror x = -x. Refused: numbers that can't be meant.
struct TouchQuestion {
  explicit TouchQuestion(const Document& document);

  bool is_mirrored = false;
  double radius = 0;                     // of the finger; 0: a point
  std::optional<Considered> considered;  // where contacts are looked for; none: everywhere
  std::size_t rolls = 0;                 // the first ones of:
  std::vector<SoughtTouch> touches;      // first contacts of rolls, then touches
  bool any_place = true;                 // false: nothing tells where the part is
  std::vector<StatedSet> sets;

  double mirrored(double value) const { return is_mirrored ? -value : value; }
  Interval mirrored(const Interval& one) const { return is_mirrored ? Interval{-one.hi, -one.lo} : one; }
  std::string name_of(std::size_t contact) const {
    return contact < rolls ? "roll " + std::to_string(contact) : "touch " + std::to_string(contact - rolls);
  }

 private:
  void read_contact(const Json& stated, bool is_roll);
  /// One coordinate of a pose.
  double place_of(const Json& stated) const;
  /// An extent of one coordinate.
  Interval places_of(const Json& stated) const;
  /// One of `poses`.
  StatedSet set_of(const Json& stated) const;
};

/// Reads the question and the stated sets: rolls first, then touches, as contacts of a pose are listed.
TouchQuestion::TouchQuestion(const Document& document)
    : is_mirrored(document.json().at("mirrored").get<bool>()), radius(number(document.json().at("radius"))) {
  // Negated, so that NaN is refused.
  if (!(radius >= 0)) refuse("a finger whose radius is below 0");
  considered = rollfix_verify::considered(document.json().at("reach"), document.period());
  if (document.json().contains("rolls")) {
    for (const Json& stated : document.json().at("rolls")) read_contact(stated, true);
  }
  rolls = touches.size();
  for (const Json& stated : document.json().at("touches")) read_contact(stated, false);
  if (touches.empty()) refuse("there is no touch");
  any_place = std::any_of(touches.begin(), touches.end(), [](const SoughtTouch& one) { return one.has_place; });
  for (const Json& stated : document.json().at("poses")) sets.push_back(set_of(stated));
}

/// Of a touch, or of a roll's first contact; it may have no place.
void TouchQuestion::read_contact(const Json& stated, bool is_roll) {
  SoughtTouch touch;
  touch.has_place = stated.contains("at");
  if (touch.has_place) {
    touch.x = mirrored(number(stated.at("at").at(0)));
    touch.y = number(stated.at("at").at(1));
  }
  // A normal alone needs no tolerance of length; rolls state one in any case.
  if (touch.has_place || is_roll) touch.length = number(stated.at("tolerance").at(0));
  touch.angle = number(stated.at("tolerance").at(1));
  if (is_roll && !stated.contains("normal")) refuse("a roll without a normal");
  if (!touch.has_place && !stated.contains("normal")) refuse("a touch without a place and a normal");
  if (stated.contains("normal")) {
    const double normal = number(stated.at("normal"));
    if (!(std::abs(normal) <= kMostAngle)) refuse("an angle of too many turns");
    const Ball quarter = 0.25 * full_turn();
    // The part's tangent is a quarter turn ahead of its outward normal a; in the mirror a is pi - a.
    const Ball tangent = is_mirrored ? 3.0 * quarter - normal : Ball(normal) + quarter;
    touch.tangent = to_nearest_turn(tangent).middle();
  }
  touches.push_back(touch);
}

/// Where no contact has a place, x and y are null, and anything.
double TouchQuestion::place_of(const Json& stated) const {
  if (any_place) return number(stated);
  if (!stated.is_null()) refuse("a place, which nothing tells");
  return 0;
}

/// Unbounded where nothing tells places.
Interval TouchQuestion::places_of(const Json& stated) const {
  if (any_place) return interval(stated);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  place_of(stated.at(0));
  place_of(stated.at(1));
  return {-kFar, kFar};
}

/// A listed set has a pose; a set without a pose has an extent.
StatedSet TouchQuestion::set_of(const Json& stated) const {
  StatedSet set;
  if (stated.contains("extent")) {
    const Json& extent = stated.at("extent");
    set.extent = {mirrored(places_of(extent.at(0))), places_of(extent.at(1)), mirrored(interval(extent.at(2)))};
  }
  if (!stated.contains("pose")) {
    // What is neither a pose nor an extent claims nothing.
    if (stated.at("listed").get<bool>() || !set.extent) refuse("a set without a pose");
    return set;
  }
  const Json& pose = stated.at("pose");
  set.pose = {mirrored(place_of(pose.at(0))), place_of(pose.at(1)), mirrored(number(pose.at(2)))};
  set.contacts = &stated.at("contacts");
  return set;
}

// Tolerances are at least this share of the largest coordinate, and so many radians: below it doubles decide.
constexpr double kLeastLength = 1e-9;
constexpr double kLeastAngle = 1e-9;

/// Checks one certificate of touches and rolls; used once. Every refusal is a std::domain_error with its reason.
class Touches {
 public:
  explicit Touches(const Document& document)
      : document_(document),
        boundary_(document.boundary()),
        period_(document.period()),
        question_(document),
        touches_(question_.touches) {}

  /// P3 first, then P2 of each stated pose, last P1 by the search.
  Verdict check() {
    document_.check_outline();
    require_tolerances();
    check_reach();
    // Without a root the finger has no place on the part, and P1 needs no search.
    CentreTree tree(boundary_, question_.radius, question_.considered);
    if (tree.root() >= 0) read_readings(tree);
    Verdict verdict;
    verdict.of_touches = true;
    for (std::size_t k = 0; k < question_.sets.size(); ++k) check_set(tree, k);
    for (const Json& stated : document_.json().at("poses")) {
      // A pose without an extent is in another one's set.
      ++(!stated.contains("extent")        ? verdict.inside
         : stated.at("listed").get<bool>() ? verdict.placements
                                           : verdict.left_out);
    }
    if (tree.root() >= 0) cover(tree, verdict);
    return verdict;
  }

 private:
  /// Lengths and turns count along the outline as it is stated, whichever side of the part is up.
  void read_readings(const CentreTree& tree) {
    for (std::size_t k = 0; k < question_.rolls; ++k) {
      const Json& stated = document_.json().at("rolls").at(k);
      std::vector<RollReading> readings;
      for (const Json& one : stated.at("readings")) {
        readings.push_back({document_.length(one.at("length")), Document::turn(one.at("turn"))});
      }
      if (readings.empty()) refuse("a roll without readings");
      // In radians, the same for all readings of the roll.
      const double within = number(stated.at("within"));
      if (!(within >= kLeastAngle)) refuse("a tolerance of readings below what rounding allows");
      starts_.push_back(std::make_unique<RollStarts>(boundary_, tree, std::move(readings), within));
      touches_[k].starts = starts_.back().get();
    }
  }

  /// Refuses tolerances that are so small that the rounding of doubles decides. The largest coordinate is that of the
  /// part or of a touch.
  void require_tolerances() {
    for (const SoughtTouch& touch : touches_) size_ = std::max({size_, std::abs(touch.x), std::abs(touch.y)});
    // Of the finger's centres: the disc of its root bounds all coordinates.
    const CentreTree all(boundary_, question_.radius, std::nullopt);
    const CentreTree::Node& root = all.node(all.root());
    size_ = std::max({size_, std::abs(root.x) + root.radius, std::abs(root.y) + root.radius});
    for (const SoughtTouch& touch : touches_) {
      if (touch.has_place && !(touch.length >= kLeastLength * size_))
        refuse("a tolerance of length below what rounding allows");
      if (touch.tangent && !(touch.angle >= kLeastAngle)) refuse("a tolerance of angle below what rounding allows");
    }
  }

  /// Where contacts are not looked for the finger can't be.
  void check_reach() const {
    if (!question_.considered) return;
    const std::optional<double> place = not_out_of_reach(boundary_, question_.radius, *question_.considered);
    if (!place) return;
    char text[120];
    std::snprintf(text, sizeof text, "the reach leaves out s = %.6g, where the finger may touch", *place);
    refuse(text);
  }

  // ---- each stated pose fits ----

  /// P2: the stated pose is in its extent, and each contact fits it.
  void check_set(const CentreTree& tree, std::size_t number) const {
    const StatedSet& set = question_.sets[number];
    if (set.contacts == nullptr) return;
    const std::string name = "set " + std::to_string(number);
    // Headings by radians, x and y by the largest coordinate.
    for (std::size_t axis = 0; set.extent && axis < 3; ++axis) {
      const double slack = axis == 2 ? kPlaceSlack : kPlaceSlack * size_;
      if (!(*set.extent)[axis].holds({set.pose[axis], set.pose[axis]}, slack))
        refuse(name + ": its pose is outside of it");
    }
    if (set.contacts->size() != touches_.size()) refuse(name + " has not one contact for each roll and touch");
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      check_contact(tree, set, touches_[k], set.contacts->at(k), name + ", " + question_.name_of(k));
    }
  }

  /// P2 of one contact: its place is on the boundary and within reach, and the residuals are as stated and within the
  /// tolerance.
  void check_contact(const CentreTree& tree, const StatedSet& set, const SoughtTouch& touch, const Json& stated,
                     const std::string& name) const {
    const Place place = document_.place_at(stated.at("at"));
    document_.require_as_far(place.s, number(stated.at("s")), name + ", s");
    const Ball direction = direction_at(document_, tree, place, number(stated.at("tangent")), name);
    if (!is_considered(boundary_, question_.considered, place, number(stated.at("tangent"))))
      refuse(name + " is out of reach");
    const Point point = boundary_.position(place);
    // The finger's centre on the part, p + r n.
    const Ball x = point.x + question_.radius * sin(direction);
    const Ball y = point.y - question_.radius * cos(direction);
    const Ball c = cos(Ball(set.pose[2]));
    const Ball s = sin(Ball(set.pose[2]));
    // The centre in the world less the measured one.
    const Ball dx = set.pose[0] + c * x - s * y - touch.x;
    const Ball dy = set.pose[1] + s * x + c * y - touch.y;
    if (touch.has_place) {
      require_off(length_of(dx, dy), touch.length, kLengthSlack * size_, number(stated.at("off").at(0)), name);
    }
    // A roll's first contact must leave all of its readings possible.
    if (touch.starts != nullptr && !touch.starts->may_start(place, direction)) {
      refuse(name + " starts a roll that its readings contradict");
    }
    if (!touch.tangent) return;
    // tau - Theta - phi, modulo turns.
    const Ball turn = to_nearest_turn(Ball(*touch.tangent) - direction - set.pose[2]);
    require_off(question_.mirrored(1) * turn, touch.angle, kTurnSlack, number(stated.at("off").at(1)), name);
  }

  // ---- there is no other ----

  /// P1: every pose that fits is in an extent. A pose that fits and is in none refutes the certificate.
  void cover(CentreTree& tree, Verdict& verdict) const {
    std::vector<PoseBox> listed;
    for (const StatedSet& set : question_.sets) {
      if (set.extent) listed.push_back(*set.extent);
    }
    std::optional<LeftOpen> open;
    if (document_.json().contains("unresolved")) {
      const Json& stated = document_.json().at("unresolved");
      // What the search gave up is counted, not refused.
      open = LeftOpen{stated.at("touch").get<std::size_t>(), arcs(stated.at("arcs"), period_)};
      if (open->touch >= touches_.size()) refuse("what is unresolved is of a touch that is not there");
    }
    const Covered covered = PoseSearch(tree, touches_, listed, open).run();
    // A pose that fits for certain and is in no set.
    if (covered.unlisted) refuse(unlisted(*covered.unlisted));
    if (covered.is_cut_short()) refuse("not decided: many poses are within rounding of the tolerance");
    verdict.cells = covered.boxes;
    verdict.unproved = covered.undecided;
    verdict.open = covered.open;
    if (!open) return;
    verdict.open_contact = question_.name_of(open->touch);
    for (const Interval& arc : open->arcs) verdict.share = std::min(verdict.share + arc.width() / period_, 1.0);
  }

  /// For the message, as the part lies in the world.
  std::string unlisted(const std::array<double, 3>& pose) const {
    char text[160];
    if (!question_.any_place) {
      std::snprintf(text, sizeof text, "the heading %.6g rad fits and is in no set", question_.mirrored(pose[2]));
      return text;
    }
    std::snprintf(text, sizeof text, "the pose x %.6g, y %.6g, heading %.6g rad fits and is in no set",
                  question_.mirrored(pose[0]), pose[1], question_.mirrored(pose[2]));
    return text;
  }

  const Document& document_;
  const Boundary& boundary_;
  double period_;
  TouchQuestion question_;
  std::vector<SoughtTouch> touches_;  // of the question, rolls with where they can have started
  std::vector<std::unique_ptr<RollStarts>> starts_;
  double size_ = 0;  // of the largest coordinate
};

}  // namespace

Verdict check_touches(const Document& document) { return Touches(document).check(); }

}  // namespace rollfix_verify
