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

Slack slack_of(const HeldErrors& errors, const HeldContact& contact, bool has_noise) {
  if (!has_noise) return {errors.travel, errors.angle, errors.place};
  const double travel = std::hypot(errors.travel, errors.stretch * contact.travelled);
  Slack slack;
  slack.travel = kTouchSigmas * travel;
  slack.angle = kTouchSigmas * (errors.angle + errors.travel * contact.finger_curvature);
  slack.place = kTouchSigmas * (errors.place + errors.angle * contact.lever.norm() + travel);
  return slack;
}

HeldPart::HeldPart(const Part& whole) : part(whole), range(whole.turning(), kCells) {}

ArcTree::ArcTree(const HeldPart& part, const HeldRows& rows, std::size_t finger,
                 const std::vector<std::size_t>& instants, const Reach* reach)
    : part_(part), has_place_(rows.errors[finger].has_place) {
  for (const std::size_t row : instants) {
    const HeldContact& contact = rows.rows[row].contacts[finger];
    travelled_.push_back(contact.travelled);
    slacks_.push_back(slack_of(rows.errors[finger], contact, rows.has_noise));
  }
  sweep_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const HeldRow& row : rows.rows) {
    const HeldContact& contact = row.contacts[finger];
    const double off = slack_of(rows.errors[finger], contact, rows.has_noise).travel;
    sweep_.lo = std::min(sweep_.lo, contact.travelled + off);
    sweep_.hi = std::max(sweep_.hi, contact.travelled - off);
  }
  if (reach != nullptr && reach->decided && !reach->is_whole()) {
    confined_ = true;
    reach_ = reach->arcs;
    gaps_ = reach->gaps();
    for (const PivotReach& pivot : reach->pivots) {
      if (!pivot.angles.empty()) reach_.push_back({pivot.s, pivot.s});
    }
  }
  add({0, part.part.perimeter()});
}

Interval ArcTree::moved(const Interval& s, std::size_t instant) const {
  return {s.lo + travelled_[instant] - slacks_[instant].travel, s.hi + travelled_[instant] + slacks_[instant].travel};
}

/// Each contact has a place within reach, and so has all that lies between the first contacts and the others.
bool ArcTree::can_be(const Interval& s) const {
  const Boundary boundary = part_.part.boundary();
  const double grain = kArcGrain * boundary.perimeter;
  const Interval passed{s.hi + sweep_.lo + grain, s.lo + sweep_.hi - grain};
  if (!boundary.closed && passed.hi > passed.lo && (passed.lo < -grain || passed.hi > boundary.perimeter + grain)) {
    return false;
  }
  for (std::size_t t = 0; t < travelled_.size(); ++t) {
    const Interval arc = moved(s, t);
    if (!boundary.closed && (arc.hi < 0 || arc.lo > boundary.perimeter)) return false;
    if (confined_ && std::none_of(reach_.begin(), reach_.end(),
                                  [&](const Interval& one) { return boundary.intersects(one, arc); })) {
      return false;
    }
  }
  if (!confined_ || passed.hi <= passed.lo) return true;
  return std::none_of(gaps_.begin(), gaps_.end(), [&](const Interval& gap) {
    const Interval inner{gap.lo + grain, gap.hi - grain};
    return inner.lo < inner.hi && boundary.intersects(inner, passed);
  });
}

ArcAt ArcTree::look(const Interval& s, std::size_t instant) const {
  Interval arc = moved(s, instant);
  const Boundary boundary = part_.part.boundary();
  if (!boundary.closed) arc = {std::max(arc.lo, 0.0), std::min(arc.hi, boundary.perimeter)};
  ArcAt at;
  at.middle = part_.part.point(arc.middle());
  at.radius = 0.5 * arc.width() + kDiscGrain * boundary.perimeter;
  const bool is_short = arc.width() * static_cast<double>(kCells) <= kFewCells * boundary.perimeter;
  const Interval angles = is_short ? angles_over(part_.part.turning(), arc) : part_.range.over(arc.lo, arc.hi);
  at.angle = angles.middle();
  at.half_turn = 0.5 * angles.width() + kTurnAccuracy;
  return at;
}

std::int32_t ArcTree::add(const Interval& s) {
  Node node;
  node.s = s;
  node.possible = can_be(s);
  nodes_.push_back(std::move(node));
  return static_cast<std::int32_t>(nodes_.size()) - 1;
}

const ArcAt& ArcTree::at(std::int32_t index, std::size_t instant) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  while (node.at.size() <= instant) node.at.push_back(look(node.s, node.at.size()));
  return node.at[instant];
}

/// What moves the pin on the part, over what it is off by. At a corner arcs only have to be short.
double ArcTree::size_by_levers(std::int32_t node, double leaf) {
  const double width = arc(node).width();
  double size = 0;
  for (std::size_t t = 0; t < travelled_.size(); ++t) {
    const ArcAt& here = at(node, t);
    const Slack& slack = slacks_[t];
    for (const Lever& lever : levers_[t]) {
      const double off = slack.place + lever.slack + lever.arm * slack.angle;
      const double turned = std::min(lever.arm * here.half_turn / (leaf * off), width / (leaf * slack.travel));
      size = std::max({size, turned, 0.5 * width / (leaf * off)});
    }
  }
  return size;
}

double ArcTree::size(std::int32_t node, double leaf) {
  if (!levers_.empty()) return size_by_levers(node, leaf);
  const double width = arc(node).width();
  double size = 0;
  for (std::size_t t = 0; t < travelled_.size(); ++t) {
    const ArcAt& here = at(node, t);
    const Slack& slack = slacks_[t];
    // What the travelled length itself may be off by does not get smaller: nor does a corner's turn.
    const double least = leaf * slack.travel;
    const double turn = std::min(here.half_turn / (leaf * slack.angle), width / least);
    const double place = has_place_ ? 0.5 * width / (leaf * slack.place) : 0;
    size = std::max({size, turn, place});
  }
  return size;
}

std::pair<std::int32_t, std::int32_t> ArcTree::halves(std::int32_t index) {
  {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.left >= 0) return {node.left, node.right};
    const double middle = node.s.middle();
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
