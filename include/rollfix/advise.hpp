#pragma once

// Which contact to make next where several places, or poses, are left.
//
//     const Part part = load_part("gallery:ellipse,a=2,b=1.5");
//     const Answer answer = solve({part, Reading(1.0, 0.6)});
//     const NextRoll next = next_roll(answer);
//     next.helps();  // true
//
// Degenerate cases: where no roll tells the places apart, as by symmetry, `helps` is false and `why` says so.
//
// Accuracy: bits and places that remain are expectations over the places that are left, given their probabilities.

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

namespace rollfix {

/// A place where the contact may be now; of two fingers a pair of places.
struct Hypothesis {
  PerFinger<double> place;  // s of the contacts now, in [0, P)
  PerFinger<double> sd;     // how well that is known, given this hypothesis, length
  double probability = 0;   // of all hypotheses together 1
  std::size_t label = 0;    // those of one placement, such as a stretch, have the same
  double covariance = 0;    // of two fingers' places, length^2
};

/// The hypotheses that a search leaves: with noise as probable as the samples say, else all placements alike; of a wide
/// one several, but of two fingers without noise the one pair that is listed.
std::vector<Hypothesis> hypotheses_of(const Part& part, const std::vector<Placement>& placements);
/// The same of a posterior's modes.
std::vector<Hypothesis> hypotheses_of(const Part& part, const std::vector<Mode>& modes);

/// The same where it is not known which part it is.
struct PartHypothesis {
  const Part* part = nullptr;     // not owned
  PerFinger<const Reach*> reach;  // where each finger can touch it; not owned; nullptr: anywhere
  Hypothesis hypothesis;
};

/// What a hypothesis would measure after a roll, and how far that may be off.
struct Foreseen {
  double value = 0;
  double variance = 0;
};

struct AdviceOptions {
  double turn_sd = 1e-6;             // standard deviation of a turn that is read, radians
  double length_sd = 0;              // of a length, and ...
  double length_share_sd = 0;        // ... of one by its size
  std::optional<Interval> travel{};  // how far each finger can roll on, backwards (below 0) and forwards; none: one lap
  PerFinger<const Reach*> reach{nullptr};  // where each can touch; not owned
  double rows = 1;  // that are read at about the same place, over which the errors of turn_sd and length_sd average out
  std::optional<PerFinger<double>> disks{};  // radii of two disks that must not overlap; none: they may
  /// Whether the robot can roll by these lengths from a hypothesis's places; none: it can do any roll. A roll is
  /// advised that it can do from every hypothesis that counts.
  std::function<bool(const PartHypothesis&, const PerFinger<double>&)> can_roll{};
  /// Other motions than rolls: what is measured of them in place of turns, and the ways on which to go, each so far
  /// back and forward; of two numbers each. The other options say nothing then.
  std::function<Foreseen(const PartHypothesis&, const PerFinger<double>&)> foresees{};
  std::vector<std::pair<PerFinger<double>, Interval>> ways{};
};

/// What is to be expected of a roll.
struct ExpectedGain {
  double length = 0;      // from where the contact is now, positive along the stored outline; of two: see Advice::way
  double placements = 0;  // that remain, on average over the hypotheses
  double bits = 0;        // information gained, on average
  double travel = 0;      // with this roll and those after it, on average, until what can be told apart is
};

/// Which roll tells the hypotheses apart.
struct Advice {
  std::vector<ExpectedGain> gains;  // of all lengths that were looked at on the advised way, in order; 0 is among them
  std::size_t best = 0;             // index of the advised one
  double bits_wanted = 0;           // what it would take to tell them all apart
  bool helps = false;               // false: no roll within the travel will
  PerFinger<double> way = 1.0;  // of two fingers: each rolls this many times ExpectedGain::length, one of them 1 times

  const ExpectedGain& advised() const { return gains[best]; }
  /// By how far each finger rolls on.
  PerFinger<double> lengths() const { return lengths(advised()); }
  PerFinger<double> lengths(const ExpectedGain& gain) const {
    PerFinger<double> each = way;
    for (double& length : each) length = length * gain.length + 0.0;  // who stays goes by 0 and not by -0
    return each;
  }
};

/// How far a measured turn changes while the fingers roll on by these lengths from a hypothesis's places, radians: of
/// two that of finger a less that of finger b.
double turn_ahead(const Part& part, const Hypothesis& hypothesis, const PerFinger<double>& lengths);

/// Looks at rolls forward and back; of two fingers at ways on which one finger rolls alone, or both equally far or one
/// half as far as the other, in the same or in opposite directions. While a finger rolls over x, hypothesis i reads the
/// turn Theta(p_i + x) - Theta(p_i), and of two fingers the difference of both; two hypotheses are told apart by the
/// instant at which their turns differ most, in standard deviations d: what was as probable is then exp(d^2 / 2) times
/// less so, and told apart from the true one where less than 1 % of it is left. The advised roll is the one after which
/// the least travel is to be expected, itself included, until all places are told apart that can be; the fingers then
/// roll on or back on the same way. What this way does not tell and another one does counts with the travel there. A
/// roll counts as 1 % of the perimeter more, as it takes time to stop and start again. Where no two can be told apart,
/// the advised roll is the shortest one that gains nearly as much as the best. A roll that would take a hypothesis that
/// counts out of a finger's reach, or one disk into the other, is not looked at. Throws InputError: no hypotheses, of
/// one finger and of two, a standard deviation that is not above 0, or a travel that does not hold 0.
Advice advise(const Part& part, const std::vector<Hypothesis>& hypotheses, const AdviceOptions& options = {});
/// The same of hypotheses on several parts, each with a reach of its own. No travel: one lap of the shortest part.
Advice advise(const std::vector<PartHypothesis>& hypotheses, const AdviceOptions& options = {});

/// What was found so far, and which roll tells apart what remains.
struct NextRoll {
  Answer answer;
  std::vector<Hypothesis> hypotheses;  // where the contact may be now
  std::optional<Advice> advice{};      // none where there is nothing to tell apart
  std::string why{};                   // where there is none, or no roll helps: why, in words; else empty

  bool helps() const { return advice && advice->helps; }
  /// How far the tangent turns along the advised roll if this is the place, radians; of two fingers the difference of
  /// both, a's less b's. REQUIRES helps().
  double turn_ahead(const Hypothesis& hypothesis) const;
};

/// What is known before any contact, for next_roll to say which roll tells most at first: places spread evenly over the
/// boundary, of two fingers pairs of places, wherever these fingers can be, apart from each other; all as probable.
/// `noise`: of the rolls to come. Throws InputError: no finger, or more than two.
Answer before_contact(const Part& part, const std::vector<Finger>& fingers, const std::optional<Noise>& noise = {},
                      bool may_overlap = false);

/// How well what was measured for this answer tells turns and lengths apart.
AdviceOptions advice_options(const Answer& answer, const std::optional<Interval>& travel);
/// Where each finger of an answer can touch the part.
class ReachForAdvice {
 public:
  explicit ReachForAdvice(const Answer& answer);
  /// As long as this lives; nullptr: anywhere, as far as is known.
  PerFinger<const Reach*> pointers() const;

 private:
  std::array<std::optional<Reach>, 2> each_;
};
/// The radii of two disks that must not overlap; nothing where that is not asked.
std::optional<PerFinger<double>> disks_for_advice(const Answer& answer, bool may_overlap);

/// From an answer of one finger or of two to the roll to do next: with the answer's noise, within the reach of its
/// fingers. `travel`: how far each finger can roll on, see AdviceOptions. `may_overlap`: as in Problem. `friction`: of
/// two fingers, the coefficient between each and the part; only rolls are advised that can be planned with it, from
/// every place that counts and where the part can be held at all (PlanProblem). Throws InputError as `advise` does,
/// and: friction of one finger, or of fingers that are not disks and jaws.
NextRoll next_roll(const Answer& answer, const std::optional<Interval>& travel = {}, bool may_overlap = false,
                   const std::optional<PerFinger<double>>& friction = {});

}  // namespace rollfix

// Which touch tells apart the poses that remain: docs/touch.md.
namespace rollfix {

/// A straight way of the finger's centre towards the part, until it touches.
struct Approach {
  Vec2 from = Vec2::Zero();  // in the world, off the part
  double direction = 0;      // of the motion, radians
};

/// What an approach comes to in one pose.
struct ExpectedTouch {
  std::size_t placement = 0;  // the pose's number in the answer; of a continuum several are looked at
  double probability = 0;     // of all together 1
  Pose pose;
  bool hits = false;       // false: the finger goes past the part
  Vec2 at = Vec2::Zero();  // the centre as it touches
  double normal = 0;       // there, out of the part, in the world
  double travel = 0;       // of the centre until then
};

/// What is to be expected of an approach.
struct TouchGain {
  Approach approach;
  double poses = 0;    // that remain, on average
  double bits = 0;     // information gained, on average
  double head_on = 0;  // cosine of the way's angle with the normal where it touches, 0 where it misses; on average
};

/// A roll from the last touch, and the information that it gains on average.
struct RollGain {
  double length = 0;  // of the contact's way, positive along the stored outline
  double bits = 0;
};

/// Which approach tells the poses apart.
struct NextTouch {
  std::vector<TouchGain> gains;         // as the approaches were given; of the less promising ones an upper bound
  std::size_t best = 0;                 // of them
  std::vector<ExpectedTouch> expected;  // of the best approach, in each pose
  std::optional<RollGain> roll{};       // instead: the shortest that gains about most; none: see `next_touch`
  double bits_wanted = 0;               // what it takes to tell all of them apart
  bool helps = false;                   // false: no approach does
  std::string why{};                    // if none helps, in words; else empty

  const TouchGain& advised() const { return gains[best]; }
};

/// Looks at each approach in each pose of an answer: two poses are told apart by where the finger would touch, by the
/// normal there if the answer's touches have normals, and by whether it touches at all; all in standard deviations,
/// with what the poses themselves are uncertain by. Advised is what gains most information, and of what gains about as
/// much what goes at the part head on. Without approaches many all around are looked at. After a single touch, which
/// fits all along the boundary, a sample of its poses is looked at; `expected` is empty then. `roll` is told where a
/// finger rolls, and its direction is measured: its turn counts alone, over at most 24 % of the perimeter. Throws
/// InputError: numbers that are not finite, an answer that is not complete.
NextTouch next_touch(const TouchAnswer& answer, const std::vector<Approach>& approaches = {});

/// How the pin of a wheel without skin moves next, against the jaw beside it, to tell apart where both can be.
struct NextPin {
  std::vector<Hypothesis> hypotheses{};  // where jaw and wheel touch now, the most probable first, up to kMostPinPlaces
  std::vector<double> travels{};         // of each: how far the jaw's contact travels then, along the stored outline
  /// Its lengths are the pin's: in the jaw's frame, along its surface and away from it. None where there is nothing to
  /// tell apart.
  std::optional<Advice> advice{};
  std::string why{};  // where there is none, or no motion helps: why, in words; else empty

  bool helps() const { return advice && advice->helps; }
};

/// Places that are told apart: a motion is looked at from each of them.
inline constexpr std::size_t kMostPinPlaces = 20;

/// From an answer of a jaw and one wheel to that motion: straight, while the jaw stays as it is turned. The same motion
/// of the pin moves the jaw's contact otherwise from each of the places, which its skin feels. Looked at are the
/// motions that every place which counts allows: until the wheel's normal passes through the jaw's contact. `travel`:
/// how far the pin can go in either coordinate, see AdviceOptions; none: a tenth of the perimeter either way. Throws
/// InputError: other fingers.
NextPin next_pin(const HoldAnswer& held, const std::optional<Interval>& travel = {});

}  // namespace rollfix
