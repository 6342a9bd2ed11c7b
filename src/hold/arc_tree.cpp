#include "arc_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

// Notation, as in docs/two_fingers.md, "Three and more fingers":
//   [lo, hi]        an arc of first contacts s_i: `arc`
//   L(t) +- a       what the contact has travelled: `travelled_`, `Slack::travel`
//   (c, rho)        disc that holds p(s) for all s in [lo + L - a, hi + L + a]: `ArcAt::middle`, `radius`
//   theta +- w      the tangents there, pivots of corners included: `angle`, `half_turn`
// Idea: |p'| = 1, so that half an arc's length is the radius of a disc about its middle; Theta is monotone on spirals.
namespace rollfix::hold {
namespace {

// Cells of the table of Theta over the perimeter; arcs of no more than so many of them are looked at exactly.
constexpr std::size_t kCells = 1024;
constexpr double kFewCells = 16;
// Positions and arcs are rounded: shares of the perimeter.
constexpr double kDiscGrain = 1e-14;
constexpr double kArcGrain = 1e-12;

}  // namespace

/// With noise kTouchSigmas standard deviations. Errors of the angle and of the place are added, not their squares,
/// which only widens the slack. A contact that is off by n along the finger turns the measured normal by n times the
/// finger's curvature. What n turns the part's tangent by is not in `angle`: the arc is widened by `travel` instead.
Slack slack_of(const HeldErrors& errors, const HeldContact& contact, bool has_noise) {
  if (!has_noise) return {errors.travel, errors.angle, errors.place};
  // e stretches all that was travelled since the first row.
  const double travel = std::hypot(errors.travel, errors.stretch * contact.travelled);
  Slack slack;
  slack.travel = kTouchSigmas * travel;
  slack.angle = kTouchSigmas * (errors.angle + errors.travel * contact.finger_curvature);
  slack.place = kTouchSigmas * (errors.place + errors.angle * contact.lever.norm() + travel);
  return slack;
}

HeldPart::HeldPart(const Part& whole) : part(whole), range(whole.turning(), kCells) {}

/// Looks at the whole boundary first: the root is [0, P].
ArcTree::ArcTree(const HeldPart& part, const HeldRows& rows, std::size_t finger,
                 const std::vector<std::size_t>& instants, const Reach* reach)
    : part_(part), has_place_(rows.errors[finger].has_place) {
  for (const std::size_t row : instants) {
    const HeldContact& contact = rows.rows[row].contacts[finger];
    travelled_.push_back(contact.travelled);
    slacks_.push_back(slack_of(rows.errors[finger], contact, rows.has_noise));
  }
  // Over all rows, not only those searched with: a finger may pass over a concave corner between two of these.
  sweep_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const HeldRow& row : rows.rows) {
    const HeldContact& contact = row.contacts[finger];
    const double off = slack_of(rows.errors[finger], contact, rows.has_noise).travel;
    sweep_.lo = std::min(sweep_.lo, contact.travelled + off);
    sweep_.hi = std::max(sweep_.hi, contact.travelled - off);
  }
  // An undecided reach counts as whole, so that it excludes nothing.
  if (reach != nullptr && reach->decided && !reach->is_whole()) {
    confined_ = true;
    reach_ = reach->arcs;
    gaps_ = reach->gaps();
    for (const PivotReach& pivot : reach->pivots) {
      // A corner at which some pivot is possible is within reach, though no arc may hold it.
      if (!pivot.angles.empty()) reach_.push_back({pivot.s, pivot.s});
    }
  }
  add({0, part.part.perimeter()});
}

/// Where the contact can be at an instant: [lo + L - a, hi + L + a].
Interval ArcTree::moved(const Interval& s, std::size_t instant) const {
  return {s.lo + travelled_[instant] - slacks_[instant].travel, s.hi + travelled_[instant] + slacks_[instant].travel};
}

/// Each contact has a place within reach, and so has all that lies between the first contacts and the others.
bool ArcTree::can_be(const Interval& s) const {
  const Boundary boundary = part_.part.boundary();
  const double grain = kArcGrain * boundary.perimeter;
  // From whichever place of s the finger started, it rolls over all of `passed`: at the row with the least L it is not
  // behind hi + least L + a, at the row with the most L not before lo + most L - a.
  const Interval passed{s.hi + sweep_.lo + grain, s.lo + sweep_.hi - grain};
  if (!boundary.closed && passed.hi > passed.lo && (passed.lo < -grain || passed.hi > boundary.perimeter + grain)) {
    return false;
  }
  for (std::size_t t = 0; t < travelled_.size(); ++t) {
    // At each instant the contact must be on an open boundary, and meet what the finger can reach.
    const Interval arc = moved(s, t);
    if (!boundary.closed && (arc.hi < 0 || arc.lo > boundary.perimeter)) return false;
    if (confined_ && std::none_of(reach_.begin(), reach_.end(),
                                  [&](const Interval& one) { return boundary.intersects(one, arc); })) {
      return false;
    }
  }
  // A gap in the reach that is rolled over for sure excludes the arc; its ends may be touched.
  if (!confined_ || passed.hi <= passed.lo) return true;
  return std::none_of(gaps_.begin(), gaps_.end(), [&](const Interval& gap) {
    const Interval inner{gap.lo + grain, gap.hi - grain};
    return inner.lo < inner.hi && boundary.intersects(inner, passed);
  });
}

/// What holds for every first contact in s: a disc about the arc's middle, and a range of Theta with pivots of
/// corners.
ArcAt ArcTree::look(const Interval& s, std::size_t instant) const {
  Interval arc = moved(s, instant);
  const Boundary boundary = part_.part.boundary();
  if (!boundary.closed) arc = {std::max(arc.lo, 0.0), std::min(arc.hi, boundary.perimeter)};
  ArcAt at;
  at.middle = part_.part.point(arc.middle());
  // |p'| = 1: no place of the arc is further from its middle, along the boundary or straight.
  at.radius = 0.5 * arc.width() + kDiscGrain * boundary.perimeter;
  // On short arcs the exact range, spiral by spiral; on long ones bounds by a table, in constant time.
  const bool is_short = arc.width() * static_cast<double>(kCells) <= kFewCells * boundary.perimeter;
  const Interval angles = is_short ? angles_over(part_.part.turning(), arc) : part_.range.over(arc.lo, arc.hi);
  at.angle = angles.middle();
  at.half_turn = 0.5 * angles.width() + kTurnAccuracy;
  return at;
}

/// Whether the arc is possible is decided once, when it is made.
std::int32_t ArcTree::add(const Interval& s) {
  Node node;
  node.s = s;
  node.possible = can_be(s);
  nodes_.push_back(std::move(node));
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

/// Computed on first demand, instant after instant: an arc that is excluded early needs few of them.
const ArcAt& ArcTree::at(std::int32_t index, std::size_t instant) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  while (node.at.size() <= instant) node.at.push_back(look(node.s, node.at.size()));
  return node.at[instant];
}

/// The size, of the only finger beside wheels: how far an arc leaves the pin open on the part, over how far off the pin
/// can be anyway.
double ArcTree::size_by_levers(std::int32_t node, double leaf) {
  const double width = arc(node).width();
  double size = 0;
  for (std::size_t t = 0; t < travelled_.size(); ++t) {
    const ArcAt& here = at(node, t);
    const Slack& slack = slacks_[t];
    for (const Lever& lever : levers_[t]) {
      // How far the pin may be off on the part, by the measurements alone.
      const double off = slack.place + lever.slack + lever.arm * slack.angle;
      // The heading follows from the tangent: half_turn moves the pin by arm * half_turn. At a corner half_turn does
      // not shrink with the arc, so that the arc's width against `travel` ends the halving.
      const double turned = std::min(lever.arm * here.half_turn / (leaf * off), width / (leaf * slack.travel));
      size = std::max({size, turned, 0.5 * width / (leaf * off)});
    }
  }
  return size;
}

/// The largest of: range of tangents over the angle's slack, radius of the disc over the place's slack; at all
/// instants. Above 1 the arc is to be halved.
double ArcTree::size(std::int32_t node, double leaf) {
  if (!levers_.empty()) return size_by_levers(node, leaf);
  const double width = arc(node).width();
  double size = 0;
  for (std::size_t t = 0; t < travelled_.size(); ++t) {
    const ArcAt& here = at(node, t);
    const Slack& slack = slacks_[t];
    // At a corner the range of tangents does not shrink with the arc. An arc shorter than `travel` is short enough, as
    // the contact is not known better.
    const double least = leaf * slack.travel;
    const double turn = std::min(here.half_turn / (leaf * slack.angle), width / least);
    const double place = has_place_ ? 0.5 * width / (leaf * slack.place) : 0;
    size = std::max({size, turn, place});
  }
  return size;
}

/// The halves are made on first demand and shared by all boxes that ask for them.
std::pair<std::int32_t, std::int32_t> ArcTree::halves(std::int32_t index) {
  {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.left >= 0) return {node.left, node.right};
    const double middle = node.s.middle();
    // No number lies between the ends.
    if (!(middle > node.s.lo && middle < node.s.hi)) return {index, index};
  }
  const Interval whole = arc(index);
  const std::int32_t left = add({whole.lo, whole.middle()});
  const std::int32_t right = add({whole.middle(), whole.hi});
  Node& node = nodes_[static_cast<std::size_t>(index)];
  node.left = left;
  node.right = right;
  return {left, right};
}

}  // namespace rollfix::hold
