#include "hold_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "centre_tree.hpp"
#include "check.hpp"
#include "document.hpp"

// Notation, of an instant at which the part lies at X, phi:
//   z_i, s_i        first contact of finger i, and its contact now: s_i = z_i + L_i, within a_i
//   tau_i, q_i      the part's tangent and the contact in the world; eps_i, delta_i: how far they may be off
//   (c_i, rho_i), theta_i +- w_i   where the contact is on the part if z_i is on the box's arc: OnArc
//   p, C            of a wheel's pin, as in docs/rig.md: the contact on the part, and the pin in the world; v = C - q:
//                   `arm`
//   phi +- h        the part's heading; x = p + R(-phi) v: the pin on the part
//   (c, rho), psi +- w, t   a stretch of the pin's path, the tangents and the places at which the wheel touches
// A box goes where at some instant no phi is left by
//   normals         |tau_i - theta_i - phi| <= w_i + eps_i for all fingers
//   chords          |R(phi) (c_j - c_i) - (q_j - q_i)| <= rho_i + rho_j + delta_i + delta_j for all that have places
//   wheels          their pins are on their paths as seen from each finger that has a place
// or where no zero of some encoder is left by all instants together. A stretch may hold the pin if
// |x - c| <= reach + rho + delta + 2 |v| sin(h / 2). With an encoder its zero is then be - phi - psi - t / r, within
// the tolerance; squeezed the direction of v is phi + psi - pi / 2, likewise. Follows docs/certificates.md, "Holds".
// Idea: the pose of each instant is a function of the first contacts, or nearly; so these alone are halved. At a corner
// phi is not known well; its interval is halved until it moves x no further than x is known.
namespace rollfix_verify {
namespace {

constexpr double kPinWork = 1e-3;
constexpr double kPinRounding = 1e-13;
constexpr double kPinAngleRounding = 1e-13;
// Stretches that hold the pin are no larger than this share of how far off it may be; those that just come near enough
// than the second.
constexpr double kPinGrain = 0.1;
constexpr double kPinEdge = 0.002;
// Headings are halved until they move the pin no further than this share of it.
constexpr double kHeadingGrain = 0.5;
/// In order, those that overlap as one.
std::vector<Interval> joined(std::vector<Interval> all) {
  std::sort(all.begin(), all.end(), [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  std::vector<Interval> result;
  for (const Interval& one : all) {
    // In the order of their starts: the next one can only overlap the last of the result.
    if (result.empty() || one.lo > result.back().hi) {
      result.push_back(one);
    } else {
      result.back().hi = std::max(result.back().hi, one.hi);
    }
  }
  return result;
}

constexpr double kHoldBox = 4e-3;
constexpr double kHoldComparison = 1e-3;
constexpr double kHoldRounding = 1e-13;
constexpr double kHeadingRounding = 1e-13;
/// What an interval of angles leaves of another one: of more than one piece all that lies between as well.
bool keep(const Interval& others, Interval& angles) {
  Interval kept{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const double first = std::ceil((angles.lo - others.hi) / kTurn);
  const double last = std::floor((angles.hi - others.lo) / kTurn);
  // Every number of whole turns at which the two overlap.
  for (double turn = first; turn <= last; turn += 1) {
    kept.lo = std::min(kept.lo, std::max(angles.lo, others.lo + turn * kTurn));
    kept.hi = std::max(kept.hi, std::min(angles.hi, others.hi + turn * kTurn));
  }
  angles = kept;
  return angles.lo <= angles.hi;
}

/// From both ends to the middle: instants that are far apart tell most.
std::vector<std::size_t> telling_order(std::size_t count) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < count; ++k) order.push_back(k % 2 == 0 ? k / 2 : count - 1 - k / 2);
  return order;
}

}  // namespace

/// Intersects what is known with other intervals, on every period. The first ones are taken as they are.
void Zeros::keep(std::vector<Interval> others) {
  others = joined(std::move(others));
  if (!known_) {
    known_ = std::move(others);
    return;
  }
  std::vector<Interval> common;
  for (const Interval& one : *known_) {
    for (const Interval& other : others) {
      // All shifts by whole periods at which the two may overlap.
      const double first = period_ > 0 ? std::ceil((one.lo - other.hi) / period_) : 0;
      const double last = period_ > 0 ? std::floor((one.hi - other.lo) / period_) : 0;
      for (double lap = first; lap <= last; lap += 1) {
        const double on = lap * period_;
        const Interval both{std::max(one.lo, other.lo + on), std::min(one.hi, other.hi + on)};
        if (both.lo <= both.hi) common.push_back(both);
      }
    }
  }
  known_ = joined(std::move(common));
}

/// Of one look.
struct PinLook::Question {
  std::size_t instant = 0;
  double x = 0;  // of the contact on the part
  double y = 0;
  double arm_x = 0;
  double arm_y = 0;
  double arm = 0;
  double reach = 0;
  std::vector<Interval>& zeros;
};

/// The path of the pin is that of a disk's centre. `period_`: what psi + t / r grows by around the part.
PinLook::PinLook(const Boundary& boundary, const HeldWheel& wheel, double turn)
    : wheel_(wheel), path_(boundary, wheel.radius, wheel.reach) {
  if (path_.root() < 0) refuse("a wheel that can be nowhere");
  if (boundary.closed()) period_ = std::abs(turn + boundary.perimeter().middle() / wheel.radius);
  const CentreTree::Node& root = path_.node(path_.root());
  // Of the part, the path and all pins.
  double largest = std::hypot(root.x, root.y) + root.radius;
  for (const HeldWheel::At& at : wheel.at) largest = std::max({largest, std::abs(at.x), std::abs(at.y)});
  rounding_ = kPinRounding * largest;
}

/// With the box of contacts as `from`, within which p is known.
bool PinLook::may_touch(const SeenFrom& from, std::size_t instant, double heading, double half,
                        std::vector<Interval>& zeros) {
  const HeldWheel::At& pin = wheel_.at[instant];
  const double arm_x = pin.x - from.world_x;
  const double arm_y = pin.y - from.world_y;
  const double arm = std::hypot(arm_x, arm_y);
  Question question{instant, from.x, from.y, arm_x, arm_y, arm, from.reach + wheel_.place + rounding_, zeros};
  return look(question, heading, std::min(half, 0.5 * kTurn));
}

/// Where the pin is on the part for headings within `half`: x, within `reach`. Wide intervals of headings are halved
/// first, so that the pin's disc is about as small as the contact's.
bool PinLook::look(Question& question, double heading, double half) {
  Budget::spend(kPinWork);
  // In the middle of the headings.
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  const double x = question.x + c * question.arm_x + s * question.arm_y;
  const double y = question.y + c * question.arm_y - s * question.arm_x;
  const double reach = question.reach + 2 * question.arm * std::sin(0.5 * half);
  // If the path is far from all of the disc, no half can touch. Both halves are asked, for zeros are added by each.
  if (half * question.arm > kHeadingGrain * question.reach) {
    if (!is_near(x, y, reach)) return false;
    const bool is_below = look(question, heading - 0.5 * half, 0.5 * half);
    return look(question, heading + 0.5 * half, 0.5 * half) || is_below;
  }
  // The pin alone: any stretch of the path within reach will do.
  if (!wheel_.spin && !wheel_.line) return is_near(x, y, reach);
  // Else each stretch within reach is looked at by itself, for its tangents and places.
  bool is_any = false;
  std::vector<int> waiting{path_.root()};
  while (!waiting.empty()) {
    Budget::spend(kPinWork);
    const int index = waiting.back();
    waiting.pop_back();
    const CentreTree::Node node = path_.node(index);
    const double apart = std::hypot(x - node.x, y - node.y);
    // The stretch is out of the pin's reach.
    if (apart > reach + node.radius) continue;
    const double grain = apart <= reach ? kPinGrain : kPinEdge;
    const bool is_small = node.curve >= 0 && node.radius <= grain * reach;
    const auto [left, right] = is_small ? std::make_pair(index, index) : path_.halves(index);
    if (left != right) {
      waiting.push_back(left);
      waiting.push_back(right);
      continue;
    }
    // In reach, but squeezed the line has another direction.
    if (!suits(question, heading, half, node)) continue;
    is_any = true;
    if (!wheel_.spin) return true;
    // beta - phi - psi, without t / r: the stretch has an interval of t.
    const double zero = wheel_.at[question.instant].spin - heading - node.angle;
    const double off = half + node.half_turn + *wheel_.spin + kPinAngleRounding * (1 + std::abs(zero));
    question.zeros.push_back({zero - node.s.hi / wheel_.radius - off, zero - node.s.lo / wheel_.radius + off});
  }
  return is_any;
}

/// Whether the path comes within reach: its nearest stretches are asked first.
bool PinLook::is_near(double x, double y, double reach) {
  std::vector<int> waiting{path_.root()};
  while (!waiting.empty()) {
    Budget::spend(kPinWork);
    const int index = waiting.back();
    waiting.pop_back();
    const CentreTree::Node node = path_.node(index);
    const double apart = std::hypot(x - node.x, y - node.y);
    // None of the stretch is near enough.
    if (apart > reach + node.radius) continue;
    // The middle of the disc is within reach, or the stretch is too small to be told from one that is.
    if (node.curve >= 0 && (apart <= reach || node.radius <= kPinEdge * reach)) return true;
    const auto [left, right] = path_.halves(index);
    if (left == right) return true;
    const auto distance = [&](int half) { return std::hypot(x - path_.node(half).x, y - path_.node(half).y); };
    // The nearer half is put on top.
    const bool is_left_nearer = distance(left) < distance(right);
    waiting.push_back(is_left_nearer ? right : left);
    waiting.push_back(is_left_nearer ? left : right);
  }
  return false;
}

/// Squeezed: the wheel's normal points from the finger's contact to the pin, as measured.
bool PinLook::suits(const Question& question, double heading, double half, const CentreTree::Node& node) const {
  if (!wheel_.line) return true;
  const double towards = std::atan2(question.arm_y, question.arm_x) + 0.25 * kTurn;
  const double most = *wheel_.line + half + node.half_turn + kPinAngleRounding * (2 + std::abs(node.angle));
  return !(std::abs(nearest(towards - heading - node.angle)) > most);
}

/// `open`: arcs that the certificate leaves open.
HoldSearch::HoldSearch(BoundaryArcs& boundary, const std::vector<HeldFinger>& fingers, std::deque<PinLook>& wheels,
                       std::vector<HeldSet> listed, std::vector<HeldSet> open)
    : boundary_(boundary),
      fingers_(fingers),
      wheels_(wheels),
      listed_(std::move(listed)),
      open_(std::move(open)),
      order_(telling_order(fingers.front().at.size())) {
  double largest = boundary.size();
  for (const HeldFinger& finger : fingers_) {
    contacts_.emplace_back(boundary_, finger);
    for (const HeldFinger::At& at : finger.at) largest = std::max({largest, std::abs(at.x), std::abs(at.y)});
  }
  rounding_ = kHoldRounding * largest;
}

/// Starts with the whole boundary for each finger.
HoldCovered HoldSearch::run() {
  covered_ = {};
  visit(Nodes(fingers_.size(), 0));
  return covered_;
}

/// Whether all first contacts of the box are in one of the sets.
bool HoldSearch::is_in(const std::vector<HeldSet>& sets, const Nodes& box) const {
  Budget::spend(kHoldComparison * static_cast<double>(sets.size()));
  const double period = boundary_.period();
  const double slack = kLengthSlack * period;
  const auto holds = [&](const HeldSet& set, std::size_t finger) {
    const Interval& arc = contacts_[finger].arc(box[finger]);
    if (!boundary_.closed()) return set[finger].holds(arc, slack);
    // The whole boundary.
    if (set[finger].width() >= period - slack) return true;
    // Arcs of sets begin on the first lap and may go beyond it.
    return set[finger].holds(arc, slack) || set[finger].holds({arc.lo + period, arc.hi + period}, slack);
  };
  return std::any_of(sets.begin(), sets.end(), [&](const HeldSet& set) {
    for (std::size_t finger = 0; finger < fingers_.size(); ++finger) {
      if (!holds(set, finger)) return false;
    }
    return true;
  });
}

/// The headings at which the chord between two contacts is where it was measured. `offsets`: headings less `base`.
/// False: none is left.
bool HoldSearch::keep_chord(const Nodes& box, std::size_t instant, std::size_t one, std::size_t other, double base,
                            Interval& offsets) {
  const OnArc& from = contacts_[one].at(box[one], instant);
  const OnArc& to = contacts_[other].at(box[other], instant);
  const HeldFinger::At& from_at = fingers_[one].at[instant];
  const HeldFinger::At& to_at = fingers_[other].at[instant];
  // The chord on the part, and in the world.
  const double part_x = to.x - from.x, part_y = to.y - from.y;
  const double world_x = to_at.x - from_at.x, world_y = to_at.y - from_at.y;
  const double reach = from.radius + to.radius + fingers_[one].place + fingers_[other].place + rounding_;
  const double part = std::hypot(part_x, part_y), world = std::hypot(world_x, world_y);
  // The chords' lengths differ by more than all that both contacts may be off.
  if (std::abs(part - world) > reach) return false;
  // By the law of cosines |R(phi) part - world| <= reach leaves an interval of phi.
  const double cosine = (part * part + world * world - reach * reach) / (2 * part * world);
  // Any angle will do, also where a chord has no length.
  if (!(cosine > -1)) return true;
  const double half = std::acos(std::min(cosine, 1.0)) + kHeadingRounding;
  const double middle = std::atan2(world_y, world_x) - std::atan2(part_y, part_x) - base;
  return keep({middle - half, middle + half}, offsets);
}

/// Those that suit all normals and chords, counted on from instant to instant with the first finger's.
std::optional<Interval> HoldSearch::headings(const Nodes& box, std::size_t instant) {
  // phi = tau - theta, as one finger has it.
  const auto own = [&](std::size_t finger) {
    const OnArc& on = contacts_[finger].at(box[finger], instant);
    const double middle = fingers_[finger].at[instant].tangent - on.angle;
    const double half = on.half_turn + fingers_[finger].angle + kHeadingRounding * (1 + std::abs(middle));
    return Interval{middle - half, middle + half};
  };
  Interval first = own(0);
  // Other angles are compared with it modulo turns.
  const double base = 0.5 * (first.lo + first.hi);
  Interval offsets{first.lo - base, first.hi - base};
  // More than a whole turn says nothing.
  if (offsets.width() > kTurn) offsets = {-0.5 * kTurn, 0.5 * kTurn};
  for (std::size_t finger = 1; finger < fingers_.size(); ++finger) {
    Interval other = own(finger);
    // Says nothing.
    if (other.width() >= kTurn) continue;
    if (!keep({other.lo - base, other.hi - base}, offsets)) return std::nullopt;
  }
  for (std::size_t one = 0; one < fingers_.size(); ++one) {
    for (std::size_t other = one + 1; other < fingers_.size(); ++other) {
      if (!fingers_[one].has_place || !fingers_[other].has_place) continue;
      if (!keep_chord(box, instant, one, other, base, offsets)) return std::nullopt;
    }
  }
  return Interval{offsets.lo + base, offsets.hi + base};
}

/// Each wheel, as seen from each finger whose place is known. `zeros`: what earlier instants left of each encoder's
/// zero.
bool HoldSearch::may_touch(const Nodes& box, std::size_t instant, const Interval& heading, std::vector<Zeros>& zeros) {
  const double middle = 0.5 * (heading.lo + heading.hi);
  const double half = 0.5 * heading.width() + kHeadingRounding * (1 + std::abs(middle));
  for (std::size_t wheel = 0; wheel < wheels_.size(); ++wheel) {
    for (std::size_t finger = 0; finger < fingers_.size(); ++finger) {
      // The wheel is seen from contacts whose place in the world is known.
      if (!fingers_[finger].has_place) continue;
      const OnArc& on = contacts_[finger].at(box[finger], instant);
      const HeldFinger::At& at = fingers_[finger].at[instant];
      const SeenFrom from{on.x, on.y, at.x, at.y, on.radius + fingers_[finger].place + rounding_};
      std::vector<Interval> left;
      if (!wheels_[wheel].may_touch(from, instant, middle, half, left)) return false;
      if (!wheels_[wheel].wheel().spin) continue;
      zeros[wheel].keep(std::move(left));
      // No zero suits all instants so far.
      if (zeros[wheel].is_empty()) return false;
    }
  }
  return true;
}

/// False: at some instant, or by all zeros together, no first contacts of the box fit.
bool HoldSearch::may_fit(const Nodes& box) {
  for (std::size_t finger = 0; finger < fingers_.size(); ++finger) {
    // By one finger alone: reach, and ends of an open outline.
    if (!contacts_[finger].is_possible(box[finger])) return false;
  }
  std::vector<Zeros> zeros;
  for (const PinLook& wheel : wheels_) zeros.emplace_back(wheel.period());
  return std::all_of(order_.begin(), order_.end(), [&](std::size_t instant) {
    Budget::spend(kHoldComparison);
    const std::optional<Interval> heading = headings(box, instant);
    return heading && may_touch(box, instant, *heading, zeros);
  });
}

/// Counts a box that is as small as it gets; the first one's middle is kept for the message.
void HoldSearch::add_undecided(const Nodes& box) {
  ++covered_.undecided;
  if (!covered_.first_undecided.empty()) return;
  for (std::size_t finger = 0; finger < fingers_.size(); ++finger) {
    const Interval& arc = contacts_[finger].arc(box[finger]);
    covered_.first_undecided.push_back(0.5 * (arc.lo + arc.hi));
  }
}

/// One box: listed, excluded, left open, or too small; else its longest arc, in tolerances, is halved.
void HoldSearch::visit(const Nodes& box) {
  if (covered_.is_cut_short()) return;
  Budget::spend(kHoldBox);
  ++covered_.boxes;
  // What is listed needs no look: P2 is checked elsewhere.
  if (is_in(listed_, box) || !may_fit(box)) return;
  if (is_in(open_, box)) {
    ++covered_.open;
    return;
  }
  std::size_t widest = 0;
  double most = 0;
  for (std::size_t finger = 0; finger < fingers_.size(); ++finger) {
    const double size = contacts_[finger].size(box[finger]);
    if (size <= most) continue;
    most = size;
    widest = finger;
  }
  const auto [left, right] =
      most > 1 ? contacts_[widest].halves(box[widest]) : std::make_pair(box[widest], box[widest]);
  // As small as it gets, and still not excluded.
  if (left == right) return add_undecided(box);
  for (const int half : {left, right}) {
    Nodes next = box;
    next[widest] = half;
    visit(next);
  }
}

}  // namespace rollfix_verify
