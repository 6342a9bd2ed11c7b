#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/locate/locate.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/part/reach.hpp"
#include "rollfix/per_finger.hpp"

namespace rollfix {

/// A place where the contact may be now; of two fingers a pair of places.
struct Contender {
  PerFinger<double> place;  // s of the contacts now, in [0, P)
  PerFinger<double> sd;     // how well that is known, given this contender, length
  double probability = 0;   // of all contenders together 1
  std::size_t label = 0;    // those of one placement, such as a stretch, have the same
  double covariance = 0;    // of two fingers' places, length^2
};

/// The contenders that a search leaves: with noise as probable as the samples say, else all placements alike; of a wide
/// one several, but of two fingers without noise the one pair that is listed.
std::vector<Contender> contenders_of(const Part& part, const std::vector<Placement>& placements);
/// The same of a posterior's modes.
std::vector<Contender> contenders_of(const Part& part, const std::vector<Mode>& modes);

/// The same where it is not known which part it is.
struct PartContender {
  const Part* part = nullptr;     // not owned
  PerFinger<const Reach*> reach;  // where each finger can touch it; not owned; nullptr: anywhere
  Contender contender;
};

/// What a contender would measure after a roll, and how far that may be off.
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
  /// Whether the robot can roll by these lengths from a contender's places; none: it can do any roll. A roll is advised
  /// that it can do from every contender that counts.
  std::function<bool(const PartContender&, const PerFinger<double>&)> can_roll{};
  /// Other motions than rolls: what is measured of them in place of turns, and the ways on which to go, each so far
  /// back and forward; of two numbers each. The other options say nothing then.
  std::function<Foreseen(const PartContender&, const PerFinger<double>&)> foresees{};
  std::vector<std::pair<PerFinger<double>, Interval>> ways{};
};

/// What is to be expected of a roll.
struct Prospect {
  double length = 0;      // from where the contact is now, positive along the stored outline; of two: see Advice::way
  double placements = 0;  // that remain, on average over the contenders
  double bits = 0;        // information gained, on average
  double travel = 0;      // with this roll and those after it, on average, until what can be told apart is
};

/// Which roll tells the contenders apart.
struct Advice {
  std::vector<Prospect> prospects;  // of all lengths that were looked at on the advised way, in order; 0 is among them
  std::size_t best = 0;             // index of the advised one
  double bits_wanted = 0;           // what it would take to tell them all apart
  bool helps = false;               // false: no roll within the travel will
  PerFinger<double> way = 1.0;      // of two fingers: each rolls this many times Prospect::length, one of them 1 times

  const Prospect& advised() const { return prospects[best]; }
  /// By how far each finger rolls on.
  PerFinger<double> lengths() const { return lengths(advised()); }
  PerFinger<double> lengths(const Prospect& prospect) const {
    PerFinger<double> each = way;
    for (double& length : each) length = length * prospect.length + 0.0;  // who stays goes by 0 and not by -0
    return each;
  }
};

/// How far a measured turn changes while the fingers roll on by these lengths from a contender's places, radians: of
/// two that of finger a less that of finger b.
double turn_ahead(const Part& part, const Contender& contender, const PerFinger<double>& lengths);

/// Looks at rolls forward and back; of two fingers at ways on which one finger rolls alone, or both equally far or one
/// half as far as the other, in the same or in opposite directions. While a finger rolls over x, contender i reads the
/// turn Theta(p_i + x) - Theta(p_i), and of two fingers the difference of both; two contenders are told apart by the
/// instant at which their turns differ most, in standard deviations d: what was as probable is then exp(d^2 / 2) times
/// less so, and told apart from the true one where less than 1 % of it is left. The advised roll is the one after which
/// the least travel is to be expected, itself included, until all places are told apart that can be; the fingers then
/// roll on or back on the same way. What this way does not tell and another one does counts with the travel there. A
/// roll counts as 1 % of the perimeter more, as it takes time to stop and start again. Where no two can be told apart,
/// the advised roll is the shortest one that gains nearly as much as the best. A roll that would take a contender that
/// counts out of a finger's reach, or one disk into the other, is not looked at. Throws InputError: no contenders, of
/// one finger and of two, a standard deviation that is not above 0, or a travel that does not hold 0.
Advice advise(const Part& part, const std::vector<Contender>& contenders, const AdviceOptions& options = {});
/// The same of contenders on several parts, each with a reach of its own. No travel: one lap of the shortest part.
Advice advise(const std::vector<PartContender>& contenders, const AdviceOptions& options = {});

}  // namespace rollfix
