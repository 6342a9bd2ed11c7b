#include "box_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "work/pulse.hpp"
#include "work/union_find.hpp"

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

/// With noise kPossibleSigmas standard deviations. Errors of the angle and of the place are added, not their squares,
/// which only widens the slack. A contact that is off by n along the finger turns the measured normal by n times the
/// finger's curvature. What n turns the part's tangent by is not in `angle`: the arc is widened by `travel` instead.
Slack slack_of(const HeldErrors& errors, const HeldContact& contact, bool has_noise) {
  if (!has_noise) return {errors.travel, errors.angle, errors.place};
  // The radius' share e stretches all that was travelled since the first row.
  const double travel = std::hypot(errors.travel, errors.stretch * contact.travelled);
  Slack slack;
  slack.travel = kPossibleSigmas * travel;
  slack.angle = kPossibleSigmas * (errors.angle + errors.travel * contact.finger_curvature);
  const double arm = errors.arm_share * errors.stretch + errors.angle;
  slack.place = kPossibleSigmas * (errors.place + arm * contact.lever.norm() + travel);
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

// ---- boxes
// Notation, as in docs/two_fingers.md, "Three and more fingers":
//   A_i             an arc of first contacts of finger i: a node of `trees_[i]`; A_1 x ... x A_k: `Box`
//   (c_i, rho_i), theta_i +- w_i   where contact i is at an instant, and its tangents: ArcAt
//   tau_i, eps_i    the tangent's direction in the world, and how far that can be off: `tangent`, `Slack::angle`
//   q_i, delta_i    the contact in the world: `at`, `Slack::place`
// Tests at each instant, for its heading phi: normals, |tau_i - theta_i - phi| <= w_i + eps_i for all i; chords,
// |R(phi)(c_j - c_i) - (q_j - q_i)| <= rho_i + rho_j + delta_i + delta_j for all pairs that have places; of wheels
// wheel_pins.cpp.
// Follows docs/two_fingers.md, "Three and more fingers".
// Idea: branch and prune, a generation of boxes after the other. If there is no room for the next generation, this one
// is what fits: the boxes are coarser, and still hold all that fits.

namespace {

// More boxes are not kept: a set that needs them is a continuum, of which coarser boxes say as much. With noise they
// only say where to start.
constexpr std::size_t kMostBoxes = 20000;
constexpr std::size_t kMostNoisyBoxes = 8000;
constexpr double kHeadingGrain = 1e-12;  // headings are rounded, radians
constexpr double kMoreMisses = 1e-3;     // that more instants than allowed have outliers: as rare as bad fits
constexpr double kSameArc = 1e-12;       // arcs that share an end, of the perimeter

using touch::HeadingArc;

/// Instants of so many in which some finger's measurement is an outlier, but for a chance of kMoreMisses.
std::size_t most_misses(const HeldRows& rows, std::size_t instants) {
  // At an instant all measurements are right with (1 - share)^fingers; the number of misses is binomial.
  const double right = std::pow(1 - rows.outlier_share, static_cast<double>(rows.fingers()));
  double probability = std::pow(right, static_cast<double>(instants));
  // P(more misses than `misses`).
  double beyond = 1 - probability;
  std::size_t misses = 0;
  // Without outliers right = 1 and beyond = 0: no instant may fail. One instant at least has to fit.
  for (; beyond > kMoreMisses && misses + 1 < instants; ++misses) {
    probability *= static_cast<double>(instants - misses) / static_cast<double>(misses + 1) * (1 - right) / right;
    beyond -= probability;
  }
  return misses;
}

}  // namespace

/// Copies what the rows searched with say, so that a test at an instant reads from one place.
HoldBoxSearch::HoldBoxSearch(const HeldPart& part, const HeldRows& rows, const std::vector<std::size_t>& instants,
                             const std::vector<const Reach*>& reach, const WheelPaths& wheels, std::size_t budget)
    : pins_(rows, instants, wheels), most_boxes_(rows.has_noise ? kMostNoisyBoxes : kMostBoxes), budget_(budget) {
  for (std::size_t k = 0; k < rows.fingers(); ++k) {
    trees_.emplace_back(part, rows, k, instants, reach[k]);
    has_place_.push_back(rows.errors[k].has_place);
  }
  for (const std::size_t row : instants) {
    Instant instant;
    for (const HeldContact& contact : rows.rows[row].contacts) {
      instant.tangent.push_back(contact.tangent);
      instant.at.push_back(contact.at);
    }
    instants_.push_back(std::move(instant));
  }
  misses_ = most_misses(rows, instants.size());
  if (fingers() == 1 && pins_.wheels() > 0) add_levers(instants.size());
}

/// An arm is |C - q|: both are measured, in the world, whatever the first contacts are.
void HoldBoxSearch::add_levers(std::size_t instants) {
  std::vector<std::vector<Lever>> levers(instants);
  for (std::size_t t = 0; t < instants; ++t) {
    for (std::size_t k = 0; k < pins_.wheels(); ++k) {
      levers[t].push_back({(pins_.pin(k, t) - instants_[t].at[0]).norm(), pins_.slack(k)});
    }
  }
  trees_[0].set_levers(std::move(levers));
}

/// Those that suit all normals and all chords between contacts.
HeadingArc HoldBoxSearch::headings(const Box& box, std::size_t t) {
  const Instant& instant = instants_[t];
  HeadingArc heading;
  for (std::size_t k = 0; k < trees_.size(); ++k) {
    const ArcAt& arc = trees_[k].at(box[k], t);
    // phi = tau - Theta: the heading that turns the part's tangent into the measured one.
    const HeadingArc own{nearest_angle(instant.tangent[k] - arc.angle),
                         arc.half_turn + trees_[k].slack(t).angle + kHeadingGrain};
    // `common` holds all that both have in common, so that no heading that suits both is lost.
    heading = common(heading, own);
    if (heading.is_empty()) return heading;
  }
  // Chords: a pose leaves the vector between two contacts its length and turns it by phi.
  for (std::size_t i = 0; i < trees_.size(); ++i) {
    if (!has_place_[i]) continue;
    const ArcAt& one = trees_[i].at(box[i], t);
    for (std::size_t j = i + 1; j < trees_.size(); ++j) {
      if (!has_place_[j]) continue;
      const ArcAt& other = trees_[j].at(box[j], t);
      // Both ends of the chord may be anywhere in their discs, and be measured wrong.
      const double slack = one.radius + other.radius + trees_[i].slack(t).place + trees_[j].slack(t).place;
      heading =
          common(heading, touch::headings_between(other.middle - one.middle, instant.at[j] - instant.at[i], slack));
      if (heading.is_empty()) return heading;
    }
  }
  return heading;
}

/// The heading is unwrapped as the tangents are: an encoder counts turns.
HeldFrom HoldBoxSearch::from(const Box& box, std::size_t finger, std::size_t t) {
  const ArcAt& arc = trees_[finger].at(box[finger], t);
  const double place = trees_[finger].slack(t).place;
  return {arc.middle, instants_[t].at[finger], arc.radius + place, place, instants_[t].tangent[finger] - arc.angle};
}

/// Seen from each finger that has a place; from the first one encoders are looked at as well.
bool HoldBoxSearch::may_touch(const Box& box, std::size_t t, const HeadingArc& heading, std::vector<SpinSet>& spins) {
  for (std::size_t wheel = 0; wheel < pins_.wheels(); ++wheel) {
    bool is_first = true;
    for (std::size_t finger = 0; finger < trees_.size(); ++finger) {
      // Without x and y the pin can't be seen from this finger.
      if (!has_place_[finger]) continue;
      PinFound found;
      // One view is enough for the encoder's zero: more would narrow it, and cost all places within reach.
      const bool asks_spin = is_first && pins_.has_spin(wheel);
      if (!pins_.may_touch(wheel, t, from(box, finger, t), heading, asks_spin ? &found : nullptr)) return false;
      // What the zero can be at this instant; over all instants it must be one and the same.
      if (asks_spin && !found.any_spin) spins[wheel].keep(found.spins);
      if (spins[wheel].is_empty()) return false;
      is_first = false;
    }
  }
  return true;
}

std::vector<Interval> HoldBoxSearch::wheel_arcs(const Box& box, std::size_t wheel) {
  // Row 0 comes first in the order of instants.
  const HeadingArc heading = headings(box, 0);
  std::vector<Interval> arcs;
  if (heading.is_empty()) return arcs;
  for (std::size_t finger = 0; finger < trees_.size() && arcs.empty(); ++finger) {
    if (!has_place_[finger]) continue;
    PinFound found;
    pins_.may_touch(wheel, 0, from(box, finger, 0), heading, &found);
    for (const PinStretch& one : found.touching) arcs.push_back(one.s);
  }
  return arcs;
}

/// Normals and chords first: they are cheap, and leave fewer headings to look at wheels with.
bool HoldBoxSearch::may_fit(const Box& box, std::size_t t, std::vector<SpinSet>& spins) {
  ++comparisons_;
  const HeadingArc heading = headings(box, t);
  return !heading.is_empty() && may_touch(box, t, heading, spins);
}

/// Ends at the first instant that can't fit, or with outliers at one more than may fail.
bool HoldBoxSearch::may_fit(const Box& box) {
  beat();
  for (std::size_t k = 0; k < trees_.size(); ++k) {
    // By reach and by an open boundary's ends: no pose is needed.
    if (!trees_[k].is_possible(box[k])) return false;
  }
  std::vector<SpinSet> spins;
  for (std::size_t k = 0; k < pins_.wheels(); ++k) spins.push_back(pins_.any_spin(k));
  std::size_t misses = 0;
  for (std::size_t t = 0; t < instants_.size(); ++t) {
    if (!may_fit(box, t, spins) && ++misses > misses_) return false;
  }
  return true;
}

Boxes HoldBoxSearch::search(double leaf) {
  Box all{};
  for (std::size_t k = 0; k < trees_.size(); ++k) all[k] = trees_[k].root();
  return search({all}, leaf);
}

/// Each turn of the outer loop halves every box that is left once. At its start `from` and `found.fit` together hold
/// all first contacts that fit.
Boxes HoldBoxSearch::search(std::vector<Box> from, double leaf) {
  Boxes found;
  while (!from.empty()) {
    std::vector<Box> next;
    for (std::size_t b = 0; b < from.size(); ++b) {
      const Box& box = from[b];
      // Nothing is lost: the rest of this generation and the part of the next that is made are handed back.
      if (comparisons() >= budget_) {
        found.undecided.insert(found.undecided.end(), from.begin() + static_cast<std::ptrdiff_t>(b), from.end());
        found.undecided.insert(found.undecided.end(), next.begin(), next.end());
        return found;
      }
      // The arc that is largest, in leaves, is halved.
      std::size_t widest = 0;
      double most = 0;
      for (std::size_t k = 0; k < trees_.size(); ++k) {
        const double size = trees_[k].size(box[k], leaf);
        if (size > most) {
          most = size;
          widest = k;
        }
      }
      // Equal: all arcs are leaves, or the widest has no number between its ends.
      const auto [left, right] =
          most <= 1 ? std::make_pair(box[widest], box[widest]) : trees_[widest].halves(box[widest]);
      if (left == right) {
        found.fit.push_back(box);
        continue;
      }
      for (const std::int32_t half : {left, right}) {
        Box child = box;
        child[widest] = half;
        if (may_fit(child)) next.push_back(child);
      }
    }
    // No room for another generation: these boxes are coarser than leaves, and hold all that fits.
    if (found.fit.size() + next.size() > most_boxes_) {
      found.fit.insert(found.fit.end(), next.begin(), next.end());
      return found;
    }
    from = std::move(next);
  }
  return found;
}

/// A sweep along the first finger's arcs, with union-find: n log n, and the pairs whose first arcs overlap.
std::vector<std::vector<Box>> sets_of(HoldBoxSearch& search, const std::vector<Box>& boxes, const Boundary& boundary) {
  const double grain = kSameArc * boundary.perimeter;
  std::vector<std::pair<double, std::size_t>> order;  // by the first finger's arcs
  for (std::size_t b = 0; b < boxes.size(); ++b) order.emplace_back(search.tree(0).arc(boxes[b][0]).lo, b);
  std::sort(order.begin(), order.end());
  UnionFind joined(boxes.size());
  // Arcs that share an end touch; rounding must not part them.
  const auto touching = [&](const Box& one, const Box& other) {
    for (std::size_t k = 0; k < search.fingers(); ++k) {
      const Interval& a = search.tree(k).arc(one[k]);
      const Interval b = search.tree(k).arc(other[k]);
      if (!boundary.intersects({a.lo - grain, a.hi + grain}, b)) return false;
    }
    return true;
  };
  const auto join_with = [&](std::size_t a, std::size_t b) {
    if (joined.find(a) != joined.find(b) && touching(boxes[a], boxes[b])) joined.join(a, b);
  };
  for (std::size_t i = 0; i < order.size(); ++i) {
    beat();
    const double hi = search.tree(0).arc(boxes[order[i].second][0]).hi + grain;
    // Only arcs that start before this one ends can meet it.
    for (std::size_t j = i + 1; j < order.size() && order[j].first <= hi; ++j) {
      join_with(order[i].second, order[j].second);
    }
    // Of a closed boundary an arc that ends at P meets those that start at 0.
    if (!boundary.closed || hi < boundary.perimeter) continue;
    for (std::size_t j = 0; j < order.size() && order[j].first <= hi - boundary.perimeter; ++j) {
      join_with(order[i].second, order[j].second);
    }
  }
  // Sets come in the order of their first boxes.
  std::vector<std::vector<Box>> sets;
  for (const std::vector<std::size_t>& members : joined.sets()) {
    std::vector<Box>& set = sets.emplace_back();
    for (const std::size_t b : members) set.push_back(boxes[b]);
  }
  return sets;
}

namespace {

/// The shortest arc that holds all of these.
Interval hull_of(std::vector<Interval> arcs, const Boundary& boundary) {
  // Nothing is known: anywhere.
  if (arcs.empty()) return boundary.full_arc();
  std::sort(arcs.begin(), arcs.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  if (!boundary.closed) {
    double hi = arcs.front().hi;
    for (const Interval& arc : arcs) hi = std::max(hi, arc.hi);
    return {arcs.front().lo, hi};
  }
  // All but the widest gap.
  // `reached`: how far the arcs before this one go. The hull starts behind the widest gap and ends before it.
  double reached = arcs.front().hi;
  double widest = 0, start = arcs.front().lo, end = 0;
  for (const Interval& arc : arcs) {
    if (arc.lo - reached > widest) {
      widest = arc.lo - reached;
      start = arc.lo;
      end = reached + boundary.perimeter;
    }
    reached = std::max(reached, arc.hi);
  }
  // The gap across s = 0.
  const double across = arcs.front().lo + boundary.perimeter - reached;
  if (across >= widest) {
    start = arcs.front().lo;
    end = reached;
  }
  return boundary.arc(start, end);
}

}  // namespace

Interval extent_of(HoldBoxSearch& search, const std::vector<Box>& boxes, std::size_t finger, const Boundary& boundary) {
  std::vector<Interval> arcs;
  for (const Box& box : boxes) arcs.push_back(search.tree(finger).arc(box[finger]));
  return hull_of(std::move(arcs), boundary);
}

Interval wheel_extent(HoldBoxSearch& search, const std::vector<Box>& boxes, std::size_t wheel,
                      const Boundary& boundary) {
  std::vector<Interval> arcs;
  for (const Box& box : boxes) {
    const std::vector<Interval> own = search.wheel_arcs(box, wheel);
    arcs.insert(arcs.end(), own.begin(), own.end());
  }
  return hull_of(std::move(arcs), boundary);
}

}  // namespace rollfix::hold
