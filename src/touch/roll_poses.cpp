#include "roll_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "cell_search.hpp"
#include "outline/turn.hpp"
#include "work/union_find.hpp"

// Notation:
//   tau_k, eps_k   direction of the part's tangent in the world at contact k, and how far it may be off
//   a(u)           the tangent's angle in the part's frame, monotone on each stretch of a contact's path
//   phi            the part's heading: |tau_k - a(u_k) - phi| <= eps_k for each k
//   tuple          a stretch for each contact, and the interval of phi that all of them leave
// Where no contact tells a place the heading is all that there is: tuples are connected where a contact passes from one
// stretch to the next, and what hangs together is one answer. docs/touch.md, "Several rolls".
namespace rollfix::touch {
namespace {

// More sets of stretches than this are too many to compare one with another.
constexpr std::size_t kMostTuples = 200000;
// Bisection of a place on a stretch: down to the last bit of a double.
constexpr int kHalvings = 60;

/// A stretch for each contact, and the headings with which they all can be on theirs.
struct Tuple {
  std::vector<std::size_t> stretches;
  HeadingArc headings;
};

/// All tuples of stretches by depth first, one contact after the other, then what of them hangs together.
class HeadingSearch {
 public:
  /// REQUIRES that each contact has a tangent and a tree. `budget`: tuples, at most kMostTuples.
  HeadingSearch(const std::vector<Measured>& contacts, std::size_t budget)
      : contacts_(contacts), budget_(std::min(budget, kMostTuples)) {}

  /// Sets in order of their headings.
  HeadingSets run() {
    std::vector<std::size_t> chosen;
    extend(chosen, {});
    for (const std::vector<std::size_t>& set : connected()) result_.poses.push_back(described(set));
    std::sort(result_.poses.begin(), result_.poses.end(),
              [](const TouchPose& a, const TouchPose& b) { return a.pose.heading < b.pose.heading; });
    return std::move(result_);
  }

 private:
  const CentrePath& path(std::size_t k) const { return contacts_[k].tree->path(); }

  /// The headings with a contact whose tangent has one of these angles.
  /// phi = tau - a for a among `angles`, within eps.
  HeadingArc headings_of(std::size_t k, const Interval& angles) const {
    return {nearest_angle(*contacts_[k].tangent - angles.middle()),
            0.5 * angles.width() + contacts_[k].angle_most + kTurnAccuracy};
  }

  /// All tuples that begin so.
  /// `headings`: those that the stretches chosen so far leave. A branch ends where they are empty, so only tuples that
  /// are possible together are visited below it.
  void extend(std::vector<std::size_t>& chosen, const HeadingArc& headings) {
    const std::size_t k = chosen.size();
    if (k == contacts_.size()) {
      tuples_.push_back({chosen, headings});
      return;
    }
    const std::vector<CentreStretch>& stretches = path(k).stretches();
    for (std::size_t n = 0; n < stretches.size(); ++n) {
      // The sets found so far are told, as of an incomplete search.
      if (tuples_.size() >= budget_) result_.complete = false;
      if (!result_.complete) return;
      ++result_.comparisons;
      const HeadingArc both = common(headings, headings_of(k, stretches[n].angle));
      if (both.is_empty()) continue;
      chosen.push_back(n);
      extend(chosen, both);
      chosen.pop_back();
    }
  }

  /// Tuples that hang together: one contact is at the end of its stretch, where the next one begins.
  /// Complete: angles are monotone on stretches, so all places of a tuple hang together, and a path between two tuples
  /// passes from stretch to stretch one contact at a time.
  std::vector<std::vector<std::size_t>> connected() const {
    // The number of the tuple with these stretches.
    std::map<std::vector<std::size_t>, std::size_t> index;
    for (std::size_t t = 0; t < tuples_.size(); ++t) index[tuples_[t].stretches] = t;
    UnionFind joined(tuples_.size());
    for (std::size_t t = 0; t < tuples_.size(); ++t) {
      for (std::size_t k = 0; k < contacts_.size(); ++k) {
        const std::optional<std::size_t> next = path(k).stretches()[tuples_[t].stretches[k]].after;
        if (!next) continue;
        std::vector<std::size_t> other = tuples_[t].stretches;
        other[k] = *next;
        // Only a tuple that was found, and only if some heading has the contact at the seam of both stretches.
        const auto found = index.find(other);
        if (found != index.end() && meet_at_end(tuples_[t], k)) joined.join(t, found->second);
      }
    }
    return joined.sets();
  }

  /// Whether some heading has contact k exactly at the end of its stretch and the others anywhere on theirs.
  bool meet_at_end(const Tuple& tuple, std::size_t k) const {
    const CentreStretch& stretch = path(k).stretches()[tuple.stretches[k]];
    const double angle = path(k).at({tuple.stretches[k], stretch.u.hi}).angle;
    HeadingArc headings = headings_of(k, {angle, angle});
    for (std::size_t other = 0; other < contacts_.size(); ++other) {
      if (other == k) continue;
      headings = common(headings, headings_of(other, path(other).stretches()[tuple.stretches[other]].angle));
    }
    return !headings.is_empty();
  }

  /// Where on its stretch a contact can be with one of these headings.
  /// u where a(u) = tau_k - phi for one of the headings, within eps_k; clamped to the stretch. lo above hi where a(u)
  /// falls with u.
  Interval places_at(std::size_t k, std::size_t stretch, const HeadingArc& headings) const {
    const CentreStretch& on = path(k).stretches()[stretch];
    if (headings.is_all()) return on.u;
    // By how much a(u) may be off from tau - phi at the middle heading.
    const double most = headings.half + contacts_[k].angle_most + kTurnAccuracy;
    // The lap of tau - phi on which the stretch's own angles are.
    const double about = on.angle.middle() + nearest_angle(*contacts_[k].tangent - headings.middle - on.angle.middle());
    return {place_of(k, stretch, about - most, false), place_of(k, stretch, about + most, true)};
  }

  /// The u of a stretch with this angle, or the end that is next to it: of an angle's upper bound the larger u where
  /// angles grow with u, else the smaller one.
  double place_of(std::size_t k, std::size_t stretch, double angle, bool is_upper) const {
    const CentreStretch& on = path(k).stretches()[stretch];
    const auto angle_at = [&](double u) { return path(k).at({stretch, u}).angle; };
    // On a stretch that turns the other way a(u) is reflected about its middle angle, so that `value` grows either way.
    const bool grows = angle_at(on.u.hi) >= angle_at(on.u.lo);
    double lo = on.u.lo;
    double hi = on.u.hi;
    // Of angles that fall with u the bounds change their roles.
    const double wanted = grows ? angle : 2 * on.angle.middle() - angle;
    const bool upper = grows ? is_upper : !is_upper;
    const auto value = [&](double u) { return grows ? angle_at(u) : 2 * on.angle.middle() - angle_at(u); };
    // The lower bound lies before the stretch, or the upper one behind it: all of the stretch counts on that side.
    if (value(on.u.lo) >= wanted && !upper) return on.u.lo;
    if (value(on.u.hi) <= wanted && upper) return on.u.hi;
    // An angle that is beyond the stretch leads to the end next to it.
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double middle = 0.5 * (lo + hi);
      (value(middle) < wanted ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
  }

  /// Contact k with this heading, in the middle of the places that its tolerance leaves; `turn` is its residual.
  TouchContact contact_at(std::size_t k, std::size_t stretch, double heading) const {
    const Interval places = places_at(k, stretch, {heading, 0});
    const CentreStretch& on = path(k).stretches()[stretch];
    const double lo = std::min(places.lo, places.hi);
    const double hi = std::max(places.lo, places.hi);
    const PathPlace place{stretch, std::clamp(0.5 * (lo + hi), on.u.lo, on.u.hi)};
    const CentrePoint point = path(k).at(place);
    TouchContact contact;
    contact.s = path(k).part().boundary().canonical(point.s);
    contact.point = path(k).contact(place);
    contact.tangent = nearest_angle(point.angle);
    contact.turn = nearest_angle(*contacts_[k].tangent - point.angle - heading);
    return contact;
  }

  /// A set as a pose without x and y: the heading in the middle of the widest tuple, the extent around those of all
  /// tuples.
  TouchPose described(const std::vector<std::size_t>& set) const {
    // The tuple with most room is the one that is shown.
    const std::size_t widest = *std::max_element(set.begin(), set.end(), [&](std::size_t a, std::size_t b) {
      return tuples_[a].headings.half < tuples_[b].headings.half;
    });
    const Tuple& shown = tuples_[widest];
    TouchPose pose;
    const double heading = nearest_angle(shown.headings.middle);
    pose.pose = {0, 0, heading};
    Interval headings{heading, heading};
    for (const std::size_t t : set) {
      const HeadingArc& arc = tuples_[t].headings;
      // Arcs are unwrapped about the heading that is shown.
      const double middle = heading + nearest_angle(arc.middle - heading);
      headings = {std::min(headings.lo, middle - arc.half), std::max(headings.hi, middle + arc.half)};
    }
    // A circle, or another part of which every heading fits.
    pose.any_heading = headings.width() >= kFullTurn;
    // x and y stay 0 here. Where nothing tells the place `add_roll_ends` makes them NaN.
    pose.extent[2] = headings;
    double most = 0;
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      pose.contacts.push_back(contact_at(k, shown.stretches[k], heading));
      most = std::max(most, contacts_[k].angle_most);
      const double turn = std::abs(*pose.contacts.back().turn);
      pose.residual.turn = std::max(pose.residual.turn, turn);
      pose.worst = std::max(pose.worst, turn / contacts_[k].angle_most);
      extend_contact(k, set, pose.contacts.back());
    }
    // Free to turn, or one contact free to slide, by more than the tolerances make.
    const double much = kFreePlace * path(0).part().perimeter();
    pose.continuum = headings.width() > kFreeHeading + kFreeTolerances * most ||
                     std::any_of(pose.contacts.begin(), pose.contacts.end(),
                                 [&](const TouchContact& contact) { return contact.extent->width() > much; });
    return pose;
  }

  /// Around all places of a contact in a set, on the lap where the one that is shown is.
  void extend_contact(std::size_t k, const std::vector<std::size_t>& set, TouchContact& contact) const {
    const Boundary boundary = path(k).part().boundary();
    Interval arc{contact.s, contact.s};
    for (const std::size_t t : set) {
      const std::size_t stretch = tuples_[t].stretches[k];
      const CentreStretch& on = path(k).stretches()[stretch];
      const Interval u = places_at(k, stretch, tuples_[t].headings);
      for (const double end : {u.lo, u.hi}) {
        double s = on.corner ? on.s : end;
        // The lap nearest to the contact that is shown.
        if (boundary.closed) s = contact.s + std::remainder(s - contact.s, boundary.perimeter);
        arc = {std::min(arc.lo, s), std::max(arc.hi, s)};
      }
    }
    const double lo = boundary.on_first_lap(arc.lo);
    contact.extent = Interval{lo, lo + std::min(arc.width(), boundary.perimeter)};
  }

  const std::vector<Measured>& contacts_;
  std::size_t budget_;
  // All that are possible, in the order in which they were found.
  std::vector<Tuple> tuples_;
  HeadingSets result_;
};

// A place at an arc's end is on it, a share of the perimeter.
constexpr double kSeam = 1e-9;

/// The 95 % interval of a normal distribution.
/// 1.959964 standard deviations either way.
Interval normal_interval(double mean, double variance) {
  const double half = 1.959964 * std::sqrt(std::max(0.0, variance));
  return {mean - half, mean + half};
}

/// A roll's contact as the answer of that roll alone has it: its first one, where it ends, and its extent.
TouchContact contact_of(const Placement& placement) {
  TouchContact contact;
  contact.s = placement.start[0];
  contact.point = placement.point[0];
  contact.tangent = placement.tangent[0];
  contact.end = placement.end[0];
  contact.extent = placement.extent[0];
  return contact;
}

/// The heading where only that is known.
double heading_of(const RollContact& roll, const Placement& placement) {
  return nearest_angle(*roll.measured.tangent - placement.tangent[0]);
}

/// One placement of a roll alone as a pose: with noise the belief's mean and covariance at that place, else the pose at
/// the first row; without centres the heading alone, x = y = 0.
TouchPose pose_of(const RollContact& roll, const Placement& placement) {
  TouchPose pose;
  pose.contacts = {contact_of(placement)};
  pose.pose = {0, 0, heading_of(roll, placement)};
  if (placement.pose_spread) {
    pose.pose = placement.pose_spread->mean;
    pose.spread = *placement.pose_spread;
  } else if (!placement.pose.empty()) {
    pose.pose = placement.pose.front();
  }
  // All along a side or around a circle.
  pose.continuum = placement.kind == Kind::stretch || placement.whole_loop[0];
  pose.probability = placement.probability;
  const std::array<double, 3> mean{pose.pose.x, pose.pose.y, pose.pose.heading};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    pose.interval[i] = normal_interval(mean[i], pose.spread.covariance(k, k));
    pose.extent[i] = {mean[i], mean[i]};
    pose.density[i] = {{1, mean[i], std::sqrt(pose.spread.covariance(k, k))}};
  }
  return pose;
}

}  // namespace

HeadingSets heading_sets(const std::vector<Measured>& contacts, std::size_t budget) {
  return HeadingSearch(contacts, budget).run();
}

/// Its tolerance is the perimeter or more: the mark that `roll_contacts` sets.
bool is_reference(const Measured& contact) {
  return contact.has_place && contact.tree != nullptr && contact.place_most >= contact.tree->path().part().perimeter();
}

/// `contacts`: of the search, rolls first. The last contact is L on from the first one; on an open outline no further
/// than its ends. If nothing tells the place, x and y become NaN.
void add_roll_ends(const std::vector<RollContact>& rolls, const std::vector<Measured>& contacts, TouchAnswer& answer) {
  const Boundary boundary = answer.part.boundary();
  for (TouchPose& pose : answer.poses) {
    for (std::size_t k = 0; k < rolls.size(); ++k) {
      TouchContact& contact = pose.contacts[k];
      const double end = contact.s + rolls[k].travelled;
      contact.end = boundary.closed ? boundary.canonical(end) : std::clamp(end, 0.0, boundary.perimeter);
      // The first arc that holds the contact. An extent that `heading_sets` has set stays.
      for (const Interval& arc : rolls[k].confined.arcs) {
        if (!contact.extent && boundary.contains(arc, contact.s, kSeam * boundary.perimeter)) contact.extent = arc;
      }
      // A reference has no residual: the pose is where the finger was.
      if (is_reference(contacts[k])) contact.distance = 0;
    }
    if (answer.place != PlaceKnown::unknown) continue;
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    pose.pose.x = pose.pose.y = pose.spread.mean.x = pose.spread.mean.y = kUnknown;
    for (std::array<Interval, 3>* range : {&pose.extent, &pose.interval}) {
      (*range)[0] = (*range)[1] = {kUnknown, kUnknown};
    }
    // The heading's own variance stays.
    pose.spread.covariance.topRows<2>().setConstant(kUnknown);
    pose.spread.covariance.leftCols<2>().setConstant(kUnknown);
  }
}

/// An incomplete search of one roll makes the answer incomplete; the first such roll is the one that is told.
void take_over_doubts(const std::vector<RollContact>& rolls, TouchAnswer& answer) {
  for (std::size_t k = 0; k < rolls.size(); ++k) {
    const Answer& alone = rolls[k].alone;
    answer.verdict.fits_badly |= alone.verdict.fits_badly;
    if (alone.status == Status::complete || answer.status == Status::incomplete) continue;
    answer.status = Status::incomplete;
    answer.verdict.name = Verdict::undecided;
    answer.unresolved_touch = k;
    for (const PerFinger<Interval>& arc : alone.unresolved) answer.unresolved.push_back(arc[0]);
  }
}

/// Of one roll alone: its own status, verdict and placements, but those that other rows contradict.
void take_from(const RollContact& roll, TouchAnswer& answer) {
  const Answer& alone = roll.alone;
  answer.status = alone.status;
  answer.verdict = alone.verdict;
  for (const PerFinger<Interval>& arc : alone.unresolved) answer.unresolved.push_back(arc[0]);
  if (alone.weighing) {
    answer.rest = alone.weighing->rest;
    answer.improbable = alone.weighing->improbable.size();
  }
  for (const Placement& placement : alone.placements) {
    if (!placement.is_contradicted) answer.poses.push_back(pose_of(roll, placement));
  }
}

}  // namespace rollfix::touch
