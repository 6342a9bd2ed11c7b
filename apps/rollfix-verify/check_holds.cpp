#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "check.hpp"
#include "document.hpp"
#include "hold_search.hpp"

// Notation, as in hold_search.cpp:
//   p(s), Theta(s)  the boundary and its tangent's angle
//   t, psi          where a wheel touches, and the tangent there, at a corner a pivot
//   X + R(phi) p    the part at an instant: `Lie`
//   off             a residual as a share of its tolerance
// Follows docs/certificates.md, "Holds": P1 is `cover`, P2 is `check_set`, P3 is HeldQuestion and Document.
// Idea: each stated set has first contacts that fit, with the stated pose of each instant; `HoldSearch` shows that all
// that fit are in a stated set.
namespace rollfix_verify {
namespace {

// A tangent's residual is stated to this share of what it may be.
constexpr double kAngleShare = 1e-3;
// Places beside a contact at which the tangent is looked at.
constexpr int kLooks = 16;

/// How the part lies.
struct Lie {
  Ball x, y, heading, c, s;
  /// A point of the part in the world less another point there, as a length.
  Ball distance(const Point& point, double world_x, double world_y) const {
    // X + R(phi) p less the other point, by coordinates.
    const Ball dx = x + c * point.x - s * point.y - world_x;
    const Ball dy = y + s * point.x + c * point.y - world_y;
    return length_of(dx, dy);
  }
};

/// Checks one certificate of a hold; used once. Every refusal is a std::domain_error with its reason.
class Holds {
 public:
  explicit Holds(const Document& document)
      : document_(document),
        boundary_(document.boundary()),
        period_(document.period()),
        question_(document),
        all_(boundary_, 0, std::nullopt),
        arcs_(boundary_) {}

  /// P3 first, then P2 of each stated set, last P1 by the search.
  Verdict check() {
    document_.check_outline();
    question_.require_sound(document_);
    // The search's looks at wheels are made once, and their paths serve P2 as well.
    for (const HeldWheel& wheel : question_.wheels) wheels_.emplace_back(boundary_, wheel, arcs_.turn());
    Verdict verdict;
    verdict.of_holds = true;
    std::vector<HeldSet> listed;
    const Json& sets = document_.json().at("sets");
    for (std::size_t k = 0; k < sets.size(); ++k) {
      const Json& set = sets.at(k);
      // Sets that are left out hold what fits as well: P1 is about all of them.
      listed.push_back(extent_of(set.at("extent")));
      ++(set.at("listed").get<bool>() ? verdict.placements : verdict.left_out);
      // A set that is left out may be without first contacts; a listed one is counted then.
      if (set.contains("first")) {
        check_set(set, listed.back(), "set " + std::to_string(k));
      } else if (set.at("listed").get<bool>()) {
        ++verdict.unwitnessed;
      }
    }
    cover(listed, verdict);
    return verdict;
  }

 private:
  /// An arc for each finger with skin.
  HeldSet extent_of(const Json& stated) const {
    HeldSet extent = arcs(stated, period_);
    if (extent.size() != question_.fingers.size()) refuse("a set without an arc of each finger");
    return extent;
  }

  // ---- each set has first contacts that fit ----

  /// P2: the stated first contacts are where they are said to be, in the set, and fit at each instant.
  void check_set(const Json& set, const HeldSet& extent, const std::string& name) const {
    if (set.at("first").size() != question_.fingers.size()) refuse(name + " has not a first contact of each finger");
    if (set.at("instants").size() != question_.instants) refuse(name + " has not a pose of each instant");
    if (set.at("zeros").size() != question_.wheels.size()) refuse(name + " has not a zero of each wheel");
    std::vector<Place> first;
    for (std::size_t k = 0; k < question_.fingers.size(); ++k) {
      const Json& stated = set.at("first").at(k);
      first.push_back(document_.place_at(stated.at("at")));
      document_.require_as_far(first.back().s, number(stated.at("s")), name + ", first, s");
      // The extent is what P1 is about; the witness has to be in it.
      if (!is_on(extent[k], number(stated.at("s")))) refuse(name + " starts outside of itself");
      // What lies between the first contact and the others.
      require_passed(question_.fingers[k], first.back(), name);
    }
    for (std::size_t t = 0; t < question_.instants; ++t) {
      check_instant(set, first, t, name + ", instant " + std::to_string(t));
    }
  }

  /// On some lap.
  bool is_on(const Interval& arc, double s) const {
    const double slack = kPlaceSlack * period_;
    return std::any_of(boundary_.laps().begin(), boundary_.laps().end(), [&](double lap) {
      return arc.holds({s + lap, s + lap}, slack);
    });
  }

  /// All that was rolled over is on the boundary, and within reach.
  void require_passed(const HeldFinger& finger, const Place& first, const std::string& name) const {
    const double slack = kPlaceSlack * period_;
    const Interval passed{first.s.middle() + finger.passed.lo, first.s.middle() + finger.passed.hi};
    // Nothing was certainly rolled over.
    if (!(passed.lo < passed.hi)) return;
    if (!boundary_.closed() && (passed.lo < -slack || passed.hi > period_ + slack))
      refuse(name + " leaves the outline");
    for (const Interval& gap : finger.gaps) {
      for (double lap = std::floor((passed.lo - gap.hi) / period_); lap <= (passed.hi - gap.lo) / period_; lap += 1) {
        // The gap on that lap.
        const double on = boundary_.closed() ? lap * period_ : 0;
        const Interval both{std::max(passed.lo, gap.lo + on), std::min(passed.hi, gap.hi + on)};
        // A gap that is touched by rounding alone is none.
        if (both.width() > 2 * slack) refuse(name + " goes where the finger can't be");
      }
    }
  }

  /// All contacts and pins with the stated pose, which is taken into the mirror if the part lies face down.
  void check_instant(const Json& set, const std::vector<Place>& first, std::size_t t, const std::string& name) const {
    const Json& stated = set.at("instants").at(t);
    Lie lie;
    lie.x = question_.mirrored(number(stated.at("pose").at(0)));
    lie.y = number(stated.at("pose").at(1));
    lie.heading = question_.mirrored(number(stated.at("pose").at(2)));
    lie.c = cos(lie.heading);
    lie.s = sin(lie.heading);
    for (std::size_t k = 0; k < question_.fingers.size(); ++k) {
      check_contact(question_.fingers[k], first[k], t, lie, stated.at("contacts").at(k),
                    name + ", finger " + std::to_string(k));
    }
    for (std::size_t k = 0; k < question_.wheels.size(); ++k) {
      check_pin(k, first[0], t, lie, stated.at("pins").at(k), number(set.at("zeros").at(k)),
                name + ", wheel " + std::to_string(k));
    }
  }

  /// The place so far on; of an open outline one that is beyond an end by no more than rounding is at it.
  Place place_after(const Ball& s, const std::string& name) const {
    const double slack = kPlaceSlack * period_;
    if (!boundary_.closed() && (s.lower() < -slack || s.upper() > period_ + slack))
      refuse(name + " leaves the outline");
    // At a joint the place can't be told: beside it by less than any slack.
    for (const double beside : {0.0, 1e-13, -1e-13, 1e-12, -1e-12}) {
      if (const std::optional<Place> place = boundary_.after_or_end(s + beside * period_)) return *place;
    }
    refuse(name + " is at no place");
  }

  /// Angles of tangents that are found within the tolerance of a place: those on a grid, and at corners between.
  Ball tangents_about(const Ball& s, double reach, const std::string& name) const {
    // All places within `travel`, on an open outline no further than its ends.
    Interval arc{s.middle() - reach, s.middle() + reach};
    if (!boundary_.closed()) arc = {std::clamp(arc.lo, 0.0, period_), std::clamp(arc.hi, 0.0, period_)};
    const Place from = place_after(arc.lo, name);
    const Place to = place_after(arc.hi, name);
    // The ends, some places between, and both sides of each joint: all of them are angles that there are.
    Ball all = hull(all_.direction(from), all_.direction(to));
    for (int k = 1; k < kLooks; ++k)
      all = hull(all, all_.direction(place_after(arc.lo + arc.width() * k / kLooks, name)));
    for (long curve = from.curve; curve < to.curve; ++curve) {
      const Ball before = all_.direction(boundary_.back(curve));
      all = hull(all, hull(before, before + boundary_.jump(curve)));
    }
    return all;
  }

  /// The residuals of one finger: of the contact's place, and of the tangent, which may be any that the boundary has
  /// within `travel`.
  void check_contact(const HeldFinger& finger, const Place& first, std::size_t t, const Lie& lie, const Json& stated,
                     const std::string& name) const {
    const HeldFinger::At& at = finger.at[t];
    const Place place = place_after(first.s + at.travelled, name);
    require_within(finger, place, name);
    if (finger.has_place) {
      require_off(lie.distance(boundary_.position(place), at.x, at.y), finger.place, kLengthSlack * question_.size,
                  number(stated.at("off").at(0)), name);
    }
    const Ball about = tangents_about(place.s, finger.travel, name);
    // tau - phi must be within `angle` of those tangents: within `half` of their middle.
    const double half = 0.5 * spread(about) + finger.angle;
    const Ball off = to_nearest_turn(at.tangent - lie.heading - 0.5 * (about.lower() + about.upper()));
    const Ball own = Ball(question_.mirrored(1)) * off * (1 / half);
    const double share = number(stated.at("off").at(1));
    if (!abs(off).is_below((1 + kEdge) * half + kTurnSlack) || !abs(own - share).is_below(kAngleShare)) {
      refuse_number(name + ", off of the tangent, in tolerances", share, own);
    }
  }

  /// Within `travel` of a place that the finger reaches.
  void require_within(const HeldFinger& finger, const Place& place, const std::string& name) const {
    if (!finger.reach) return;
    const double reach = finger.travel + kPlaceSlack * period_;
    // On the first lap, where the places within reach are stated.
    const double s = place.s.middle() - (boundary_.closed() ? std::floor(place.s.middle() / period_) * period_ : 0);
    const bool is_within = std::any_of(finger.within.begin(), finger.within.end(), [&](const Interval& one) {
      return std::any_of(boundary_.laps().begin(), boundary_.laps().end(),
                         [&](double lap) { return one.lo + lap <= s + reach && s - reach <= one.hi + lap; });
    });
    if (!is_within) refuse(name + " is where the finger can't be");
  }

  /// The residuals of one wheel: of its pin, of the line if squeezed, and of its encoder's zero.
  void check_pin(std::size_t number_of, const Place& first, std::size_t t, const Lie& lie, const Json& stated,
                 double zero, const std::string& name) const {
    const HeldWheel& wheel = question_.wheels[number_of];
    const CentreTree& path = wheels_[number_of].path();
    const Place place = document_.place_at(stated.at("at"));
    const double tangent = number(stated.at("tangent"));
    // At a corner the stated tangent, if the wheel can pivot to it.
    const Ball direction = direction_at(document_, path, place, tangent, name);
    if (!is_considered(boundary_, wheel.reach, place, tangent)) refuse(name + " is out of reach");
    // p(t) + r n(psi).
    Point pin = boundary_.position(place);
    pin.x = pin.x + wheel.radius * sin(direction);
    pin.y = pin.y - wheel.radius * cos(direction);
    const HeldWheel::At& at = wheel.at[t];
    const Json& off = stated.at("off");
    require_off(lie.distance(pin, at.x, at.y), wheel.place, kLengthSlack * question_.size, number(off.at(0)), name);
    // Residuals are stated as they are in the world: in the mirror angles have the other sign.
    const double sign = question_.mirrored(1);
    const HeldFinger& finger = question_.fingers[0];
    if (wheel.line) {
      // The direction from the first finger's contact to the pin; it must be phi + psi - pi / 2.
      const Ball way = atan2(Ball(at.y) - finger.at[t].y, Ball(at.x) - finger.at[t].x);
      const Ball passes = to_nearest_turn(way - lie.heading - direction + 0.25 * full_turn());
      require_off(sign * passes, *wheel.line, kPlaceSlack, number(off.at(1)), name + ", squeezed,");
    }
    if (!wheel.spin) return;
    // Heading and tangent are counted on from instant to instant, and from lap to lap.
    const Place contact = place_after(first.s + finger.at[t].travelled, name);
    const Ball heading = finger.at[t].tangent - all_.direction(contact);
    // The stated heading with the whole turns of the first finger's tangent, ...
    const Ball counted = heading + to_nearest_turn(lie.heading - heading);
    const Ball own = path.direction(place);
    // ... and psi with those of the boundary at that place.
    const Ball pivoted = own + to_nearest_turn(direction - own);
    Ball spun = at.spin - counted - pivoted - place.s / wheel.radius - question_.mirrored(zero);
    if (boundary_.closed()) {
      // What psi + t / r grows by around the part: the encoder can't tell laps apart.
      const Ball lap = boundary_.total_turn() + boundary_.perimeter() / wheel.radius;
      spun = spun - std::round((spun / lap).middle()) * lap;
    }
    require_off(sign * spun, *wheel.spin, kPlaceSlack * (1 + period_ / wheel.radius), number(off.at(2)),
                name + ", its encoder,");
  }

  // ---- there is no other ----

  /// P1: all first contacts that fit are in a set, or in arcs that are left open, which are counted.
  void cover(const std::vector<HeldSet>& listed, Verdict& verdict) {
    std::vector<HeldSet> open;
    if (document_.json().contains("unresolved")) {
      for (const Json& one : document_.json().at("unresolved")) open.push_back(extent_of(one));
    }
    const HoldCovered covered = HoldSearch(arcs_, question_.fingers, wheels_, listed, open).run();
    // Many undecided boxes mean that something fits there, or that tolerances are at rounding.
    if (covered.is_cut_short()) refuse("not decided: " + nowhere(covered) + ", and many more");
    verdict.cells = covered.boxes;
    verdict.unproved = covered.undecided;
    verdict.open = covered.open;
    for (const HeldSet& one : open) {
      // The share of all first contacts that is in these arcs: the product over the fingers.
      double share = 1;
      for (const Interval& arc : one) share *= std::min(arc.width() / period_, 1.0);
      verdict.share = std::min(verdict.share + share, 1.0);
    }
  }

  /// Of the first box that is undecided.
  static std::string nowhere(const HoldCovered& covered) {
    std::string text = "first contacts about s =";
    for (const double s : covered.first_undecided) {
      char digits[32];
      std::snprintf(digits, sizeof digits, " %.6g", s);
      text += digits;
    }
    return text + " are in no set, and nothing excludes them";
  }

  const Document& document_;
  const Boundary& boundary_;
  double period_;
  HeldQuestion question_;       // as seen face up
  CentreTree all_;              // the boundary itself, for its tangents
  BoundaryArcs arcs_;           // of the boundary, for the search
  std::deque<PinLook> wheels_;  // one for each wheel
};

}  // namespace

Verdict check_holds(const Document& document) { return Holds(document).check(); }

}  // namespace rollfix_verify
