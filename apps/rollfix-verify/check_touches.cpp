#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "centre_tree.hpp"
#include "check.hpp"
#include "document.hpp"
#include "out_of_reach.hpp"
#include "pose_search.hpp"
#include "stated.hpp"

// Notation: a pose X, phi has the part's point c at X + R(phi) c; q_i is a touch's measured centre, tau_i the tangent
// by its normal; p + r n the finger's centre where it touches at p.
// What a certificate of touches claims, docs/certificates.md: each stated pose fits (`check_pose`), and every pose that
// fits is in a stated set (`PoseSearch`). A part that lies face down is looked at in the mirror x = -x.
namespace rollfix_verify {
namespace {

// Tolerances are at least this share of the largest coordinate, and so many radians: below it doubles decide.
constexpr double kLeastLength = 1e-9;
constexpr double kLeastAngle = 1e-9;

/// A stated set of poses.
struct Set {
  std::array<double, 3> pose{};
  std::optional<PoseBox> extent;   // none: the pose is in another one's
  const Json* contacts = nullptr;  // nullptr: it is not said that a pose of the set fits
};

class Touches {
 public:
  explicit Touches(const Document& document)
      : document_(document),
        boundary_(document.boundary()),
        period_(document.period()),
        is_mirrored_(document.json().at("mirrored").get<bool>()),
        radius_(number(document.json().at("radius"))) {
    if (!(radius_ >= 0)) refuse("a finger whose radius is below 0");
    considered_ = considered(document.json().at("reach"), period_);
    for (const Json& stated : document.json().at("touches")) read_touch(stated);
    if (touches_.empty()) refuse("there is no touch");
    for (const Json& stated : document.json().at("poses")) sets_.push_back(read_set(stated));
  }

  Verdict check() {
    document_.check_outline();
    require_tolerances();
    check_reach();
    CentreTree tree(boundary_, radius_, considered_);
    Verdict verdict;
    verdict.of_touches = true;
    for (std::size_t k = 0; k < sets_.size(); ++k) check_set(tree, k);
    for (const Json& stated : document_.json().at("poses")) {
      ++(!stated.contains("extent")        ? verdict.inside
         : stated.at("listed").get<bool>() ? verdict.placements
                                           : verdict.left_out);
    }
    if (tree.root() >= 0) cover(tree, verdict);
    return verdict;
  }

 private:
  double mirrored(double value) const { return is_mirrored_ ? -value : value; }
  Interval mirrored(const Interval& one) const { return is_mirrored_ ? Interval{-one.hi, -one.lo} : one; }

  void read_touch(const Json& stated) {
    SoughtTouch touch;
    touch.x = mirrored(number(stated.at("at").at(0)));
    touch.y = number(stated.at("at").at(1));
    touch.length = number(stated.at("tolerance").at(0));
    touch.angle = number(stated.at("tolerance").at(1));
    if (stated.contains("normal")) {
      const double normal = number(stated.at("normal"));
      if (!(std::abs(normal) <= kMostAngle)) refuse("an angle of too many turns");
      const Ball quarter = 0.25 * full_turn();
      const Ball tangent = is_mirrored_ ? 3.0 * quarter - normal : Ball(normal) + quarter;
      touch.tangent = to_nearest_turn(tangent).middle();
    }
    touches_.push_back(touch);
  }

  Set read_set(const Json& stated) const {
    Set set;
    if (stated.contains("extent")) {
      const Json& extent = stated.at("extent");
      set.extent = {mirrored(interval(extent.at(0))), interval(extent.at(1)), mirrored(interval(extent.at(2)))};
    }
    if (!stated.contains("pose")) {
      if (stated.at("listed").get<bool>() || !set.extent) refuse("a set without a pose");
      return set;
    }
    const Json& pose = stated.at("pose");
    set.pose = {mirrored(number(pose.at(0))), number(pose.at(1)), mirrored(number(pose.at(2)))};
    set.contacts = &stated.at("contacts");
    return set;
  }

  void require_tolerances() {
    for (const SoughtTouch& touch : touches_) size_ = std::max({size_, std::abs(touch.x), std::abs(touch.y)});
    const CentreTree all(boundary_, radius_, std::nullopt);
    const CentreTree::Node& root = all.node(all.root());
    size_ = std::max({size_, std::abs(root.x) + root.radius, std::abs(root.y) + root.radius});
    for (const SoughtTouch& touch : touches_) {
      if (!(touch.length >= kLeastLength * size_)) refuse("a tolerance of length below what rounding allows");
      if (touch.tangent && !(touch.angle >= kLeastAngle)) refuse("a tolerance of angle below what rounding allows");
    }
  }

  /// Where contacts are not looked for the finger can't be.
  void check_reach() const {
    if (!considered_) return;
    const std::optional<double> place = not_out_of_reach(boundary_, radius_, *considered_);
    if (!place) return;
    char text[120];
    std::snprintf(text, sizeof text, "the reach leaves out s = %.6g, where the finger may touch", *place);
    refuse(text);
  }

  // ---- each stated pose fits ----

  void check_set(const CentreTree& tree, std::size_t number) const {
    const Set& set = sets_[number];
    if (set.contacts == nullptr) return;
    const std::string name = "set " + std::to_string(number);
    for (std::size_t axis = 0; set.extent && axis < 3; ++axis) {
      const double slack = axis == 2 ? kPlaceSlack : kPlaceSlack * size_;
      if (!(*set.extent)[axis].holds({set.pose[axis], set.pose[axis]}, slack))
        refuse(name + ": its pose is outside of it");
    }
    if (set.contacts->size() != touches_.size()) refuse(name + " has not one contact for each touch");
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      check_contact(tree, set, touches_[k], set.contacts->at(k), name + ", touch " + std::to_string(k));
    }
  }

  void check_contact(const CentreTree& tree, const Set& set, const SoughtTouch& touch, const Json& stated,
                     const std::string& name) const {
    const Place place = document_.place_at(stated.at("at"));
    if (!document_.is_as_far(place.s, number(stated.at("s")))) refuse(name + " is elsewhere");
    const Ball direction = direction_at(document_, tree, place, number(stated.at("tangent")), name);
    if (!is_considered(boundary_, considered_, place, number(stated.at("tangent")))) refuse(name + " is out of reach");
    const Point point = boundary_.position(place);
    const Ball x = point.x + radius_ * sin(direction);
    const Ball y = point.y - radius_ * cos(direction);
    const Ball c = cos(Ball(set.pose[2]));
    const Ball s = sin(Ball(set.pose[2]));
    const Ball dx = set.pose[0] + c * x - s * y - touch.x;
    const Ball dy = set.pose[1] + s * x + c * y - touch.y;
    require_off(length_of(dx, dy), touch.length, kLengthSlack * size_, number(stated.at("off").at(0)), name);
    if (!touch.tangent) return;
    const Ball turn = to_nearest_turn(Ball(*touch.tangent) - direction - set.pose[2]);
    require_off(turn, touch.angle, kTurnSlack, Ball(mirrored(1)) * number(stated.at("off").at(1)), name);
  }

  // ---- there is no other ----

  void cover(CentreTree& tree, Verdict& verdict) const {
    std::vector<PoseBox> listed;
    for (const Set& set : sets_) {
      if (set.extent) listed.push_back(*set.extent);
    }
    std::optional<LeftOpen> open;
    if (document_.json().contains("unresolved")) {
      const Json& stated = document_.json().at("unresolved");
      open = LeftOpen{stated.at("touch").get<std::size_t>(), arcs(stated.at("arcs"), period_)};
      if (open->touch >= touches_.size()) refuse("what is unresolved is of a touch that is not there");
    }
    const Covered covered = PoseSearch(tree, touches_, listed, open).run();
    if (covered.unlisted) refuse(unlisted(*covered.unlisted));
    if (covered.is_cut_short()) refuse("not decided: many poses are within rounding of the tolerance");
    verdict.cells = covered.boxes;
    verdict.unproved = covered.undecided;
    verdict.open = covered.open;
    if (!open) return;
    verdict.open_touch = open->touch;
    for (const Interval& arc : open->arcs) verdict.share = std::min(verdict.share + arc.width() / period_, 1.0);
  }

  std::string unlisted(const std::array<double, 3>& pose) const {
    char text[160];
    std::snprintf(text, sizeof text, "the pose x %.6g, y %.6g, heading %.6g rad fits and is in no set",
                  mirrored(pose[0]), pose[1], mirrored(pose[2]));
    return text;
  }

  const Document& document_;
  const Boundary& boundary_;
  double period_;
  bool is_mirrored_;
  double radius_;
  std::optional<Considered> considered_;
  std::vector<SoughtTouch> touches_;
  std::vector<Set> sets_;
  double size_ = 0;  // of the largest coordinate
};

}  // namespace

Verdict check_touches(const Document& document) { return Touches(document).check(); }

}  // namespace rollfix_verify
