#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/locate/placement.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/part/reach.hpp"

namespace rollfix {

/// A place where the contact may be now.
struct Contender {
  double place = 0;        // s of the contact now, in [0, P)
  double sd = 0;           // how well that is known, given this contender, length
  double probability = 0;  // of all contenders together 1
  std::size_t label = 0;   // those of one placement, such as a stretch, have the same
};

/// The contenders that one finger's search leaves: with noise as probable as the samples say, else all placements
/// alike; of a wide one several.
std::vector<Contender> contenders_of(const Part& part, const std::vector<Placement>& placements);
/// The same of a posterior's modes.
std::vector<Contender> contenders_of(const Part& part, const std::vector<Mode>& modes);

/// The same where it is not known which part it is.
struct PartContender {
  const Part* part = nullptr;    // not owned
  const Reach* reach = nullptr;  // where the finger can touch it; not owned; nullptr: anywhere
  Contender contender;
};

struct AdviceOptions {
  double turn_sd = 1e-6;             // standard deviation of a turn that is read, radians
  double length_sd = 0;              // of a length, and ...
  double length_share_sd = 0;        // ... of one by its size
  std::optional<Interval> travel{};  // how far the finger can roll on, backwards (below 0) and forwards; none: one lap
  const Reach* reach = nullptr;      // where it can touch; not owned
  double rows = 1;  // that are read at about the same place, over which the errors of turn_sd and length_sd average out
};

/// What is to be expected of a roll.
struct Prospect {
  double length = 0;      // from where the contact is now, positive along the stored outline
  double placements = 0;  // that remain, on average over the contenders
  double bits = 0;        // information gained, on average
  double travel = 0;      // with this roll and those after it, on average, until what can be told apart is
};

/// Which roll tells the contenders apart.
struct Advice {
  std::vector<Prospect> prospects;  // of all lengths that were looked at, in order; 0 is among them
  std::size_t best = 0;             // index of the advised one
  double bits_wanted = 0;           // what it would take to tell them all apart
  bool helps = false;               // false: no roll within the travel will

  const Prospect& advised() const { return prospects[best]; }
};

/// Looks at rolls forward and back. While the finger rolls over x, contender i reads the turn Theta(p_i + x) -
/// Theta(p_i); two contenders are told apart by the instant at which their turns differ most, in standard deviations d:
/// what was as probable is then exp(d^2 / 2) times less so, and told apart from the true one where less than 1 % of it
/// is left. The advised roll is the one after which the least travel is to be expected, itself included, until all
/// places are told apart that can be; the finger then rolls on or back. A roll counts as 1 % of the perimeter more, as
/// it takes time to stop and start again. Where no two can be told apart, the advised roll is the shortest one that
/// gains nearly as much as the best. A roll that would take a contender that counts out of the finger's reach is not
/// looked at. Throws InputError: no contenders, a standard deviation that is not above 0, or a travel that does not
/// hold 0.
Advice advise(const Part& part, const std::vector<Contender>& contenders, const AdviceOptions& options = {});
/// The same of contenders on several parts, each with a reach of its own. No travel: one lap of the shortest part.
Advice advise(const std::vector<PartContender>& contenders, const AdviceOptions& options = {});

}  // namespace rollfix
