#include "rollfix/advise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "belief/posterior.hpp"
#include "rollfix/error.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/rolling.hpp"
#include "text/text.hpp"

// Notation, as in docs/rig.md:
//   x             how far the pin has gone on a straight way in the jaw's frame
//   s(x)          where the jaw touches then, by closure, as `roll_rig` has it
// Idea: the robot moves pin and jaw, and the part follows. What the jaw's skin feels of it, s(x) - s(0), depends on
// where both touch: so that is what tells places apart.
namespace rollfix {
namespace {

// Straight ways in the jaw's frame, each back and forward.
constexpr std::array<std::array<double, 2>, 4> kPinWays = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
constexpr double kPinTravel = 0.1;    // of the perimeter
constexpr std::size_t kPinRows = 65;  // of a way, between which s(x) is linear
constexpr double kShorterPin = 0.7;   // a way that the pin can't go is tried so much shorter, ...
constexpr int kMostTries = 12;        // ... and not at all where even a 50th of it is too long
constexpr double kExactShare = 1e-4;  // of the perimeter: without noise the skin and the pin are known this well
constexpr double kRowsTogether = 2;   // the difference of two rows is felt

/// How the jaw's contact travels while the pin goes straight on.
class PinWay {
 public:
  PinWay(const HoldAnswer& held, const PerFinger<double>& from, const Vec2& to) : to_(to) {
    for (int left = kMostTries; left > 0 && !try_to_go(held, from); --left) to_ *= kShorterPin;
  }

  /// How far the pin goes on this way, length; 0 where it can't go at all.
  double reach() const { return jaw_.empty() ? 0 : to_.norm(); }
  /// Until where it can't go on.
  double travelled(double x) const {
    if (jaw_.empty()) return 0;
    // Rows are at equal steps of the pin, so that x is a place among them; beyond the end the contact stays.
    const double at = std::min(x / reach(), 1.0) * static_cast<double>(jaw_.size() - 1);
    const auto k = std::min(static_cast<std::size_t>(at), jaw_.size() - 2);
    return std::lerp(jaw_[k], jaw_[k + 1], at - static_cast<double>(k)) - jaw_.front();
  }
  /// ds / dx, the jaw's contact by the pin: by which an error of the pin counts.
  double slope(double x) const {
    const double step = reach() / static_cast<double>(kPinRows);
    return step > 0 ? (travelled(x) - travelled(std::max(0.0, x - step))) / step : 0;
  }

 private:
  /// Follows the rig along the whole way. False where it can't be followed, with `jaw_` as it was.
  bool try_to_go(const HoldAnswer& held, const PerFinger<double>& from) {
    RigPlan plan;
    plan.radius = held.rolls[1].radius;
    plan.start = from;
    plan.pin = [this](double time) -> Vec2 { return time * to_; };
    plan.squeezed = held.squeezed.has_value();
    plan.rows = kPinRows;
    try {
      jaw_ = roll_rig(held.part, plan).s[0];
      return true;
    } catch (const InputError&) {  // the closure does not say how the part rolls so far
      return false;
    }
  }

  /// the way's end in the jaw's frame, from where the pin is
  Vec2 to_;
  std::vector<double> jaw_;  // its contacts, unwrapped
};

/// On one way, from one place and from what it may be off by.
struct Outlook {
  Outlook(const HoldAnswer& held, const Hypothesis& from, const Vec2& to) : way(held, from.place, to) {
    for (const std::size_t k : {0U, 1U}) {
      // The same way from a place one standard deviation off, of one finger at a time: how far the travel then differs.
      PerFinger<double> off = from.place;
      off[k] += from.sd[k];
      if (from.sd[k] > 0) others.emplace_back(held, off, to);
    }
  }

  /// from the hypothesis's own place
  PinWay way;
  /// from one standard deviation off, of each finger whose place is not exact
  std::vector<PinWay> others;
};

/// All ways from all places.
class Outlooks {
 public:
  Outlooks(const HoldAnswer& held, const std::vector<Hypothesis>& hypotheses, const Interval& travel)
      : hypotheses_(hypotheses) {
    // Without noise the skin and the pin are taken to be exact to kExactShare.
    const double P = held.part.perimeter();
    contact_ = held.noise ? held.noise->contact : kExactShare * P;
    pin_ = held.noise ? held.noise->position : kExactShare * P;
    // A squeezed part follows the pin along the jaw alone.
    const std::size_t ways = held.squeezed ? 1 : kPinWays.size();
    for (std::size_t k = 0; k < ways; ++k) {
      for (const Hypothesis& one : hypotheses) {
        for (const double end : ends_of(k, travel)) ahead_.emplace_back(held, one, end * way(k));
      }
    }
  }

  /// The ways, each as far as all places allow. Lengths are multiples of the way's direction, as `advise` takes them.
  std::vector<std::pair<PerFinger<double>, Interval>> ways() const {
    std::vector<std::pair<PerFinger<double>, Interval>> all;
    for (std::size_t k = 0; k * hypotheses_.size() * 2 < ahead_.size(); ++k) {
      Interval common{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
      for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
        const double longest = way(k).norm();
        common.lo = std::max(common.lo, -outlook(k, i, false).way.reach() / longest);
        common.hi = std::min(common.hi, outlook(k, i, true).way.reach() / longest);
      }
      all.emplace_back(kPinWays[k], common);
    }
    return all;
  }

  /// What the skin feels of a motion of the pin, and its variance.
  Foreseen foreseen(const PerFinger<double>& from, const PerFinger<double>& by) const {
    // Errors of two rows of the skin, of the pin at both, and of the places themselves: one for each finger's.
    const Vec2 to(by[0], by[1]);
    const Outlook& ahead = outlook_towards(from, to);
    const double x = to.norm();
    Foreseen seen{ahead.way.travelled(x), kRowsTogether * belief::square(contact_)};
    seen.variance += kRowsTogether * belief::square(pin_ * ahead.way.slope(x));
    for (const PinWay& other : ahead.others) seen.variance += belief::square(other.travelled(x) - seen.value);
    return seen;
  }

 private:
  /// Back and forward on this way, so that both coordinates stay within the travel.
  static std::array<double, 2> ends_of(std::size_t k, const Interval& travel) {
    // Only on the way (1, -1) do the two coordinates go opposite ways: then both ends have to hold for both.
    if (kPinWays[k][0] * kPinWays[k][1] >= 0) return {travel.lo, travel.hi};
    const double least = std::min(-travel.lo, travel.hi);
    return {-least, least};
  }

  static Vec2 way(std::size_t k) { return {kPinWays[k][0], kPinWays[k][1]}; }

  /// In order of ways, then of places, then back and forward.
  const Outlook& outlook(std::size_t k, std::size_t hypothesis, bool forward) const {
    return ahead_[2 * (k * hypotheses_.size() + hypothesis) + (forward ? 1 : 0)];
  }

  /// The outlook of this place on the way that points most in the direction of `to`.
  const Outlook& outlook_towards(const PerFinger<double>& from, const Vec2& to) const {
    // `advise` asks with a hypothesis's own places, unchanged.
    std::size_t hypothesis = 0, best = 0;
    while (!(hypotheses_[hypothesis].place == from)) ++hypothesis;
    const auto along = [&](std::size_t k) { return std::abs(way(k).normalized().dot(to)); };
    for (std::size_t k = 1; k * hypotheses_.size() * 2 < ahead_.size(); ++k) {
      if (along(k) > along(best)) best = k;
    }
    return outlook(best, hypothesis, way(best).dot(to) > 0);
  }

  const std::vector<Hypothesis>& hypotheses_;
  /// standard deviation of the skin's contact, length; pin_: of the pin's coordinates
  double contact_ = 0;
  double pin_ = 0;
  /// of each way, place and end; see `outlook`
  std::vector<Outlook> ahead_;
};

/// Throws InputError unless the answer is of a jaw and a wheel without skin.
void require_rig(const HoldAnswer& held) {
  if (held.rolls.size() == 2 && held.rolls[0].is_jaw && held.rolls[1].is_wheel) return;
  throw InputError(
      fmt::format("advise: expected a jaw and one wheel without skin, found {} and {}: how others roll by where the "
                  "pin goes is not looked at; roll on, and let `watch` tell when one place is left",
                  counted(held.rolls.size(), "log", "logs"), held.rolls[0].is_jaw ? "a jaw first" : "no jaw first"));
}

/// Where both touch now: of each placement one hypothesis, the likeliest of them, kMostPinPlaces at most. Without noise
/// all are as probable.
std::vector<Hypothesis> hypotheses_of(const HoldAnswer& held) {
  std::vector<Hypothesis> hypotheses;
  double total = 0;
  for (std::size_t k = 0; k < std::min(held.placements.size(), kMostPinPlaces); ++k) {
    const std::vector<HoldContact>& contacts = held.placements[k].contacts;
    Hypothesis one{{contacts[0].end, contacts[1].end}, {0.0, 0.0}, 1, k};
    if (held.noise) {
      // with noise the posterior's mean, in place of the best fit
      one.place = {contacts[0].end_mean, contacts[1].end_mean};
      one.sd = {contacts[0].end_sd, contacts[1].end_sd};
      one.probability = held.placements[k].probability;
    }
    total += one.probability;
    hypotheses.push_back(one);
  }
  for (Hypothesis& one : hypotheses) one.probability /= total;
  return hypotheses;
}

}  // namespace

NextPin next_pin(const HoldAnswer& held, const std::optional<Interval>& travel) {
  require_rig(held);
  NextPin next;
  next.hypotheses = hypotheses_of(held);
  if (next.hypotheses.size() < 2) {
    next.why = next.hypotheses.empty() ? "there is no place left" : "there is only one place left";
    return next;
  }
  const double usual = kPinTravel * held.part.perimeter();
  const Outlooks outlooks(held, next.hypotheses, travel.value_or(Interval{-usual, usual}));
  AdviceOptions options;
  options.ways = outlooks.ways();
  // What is measured is how far the jaw's contact travels, in place of a turn.
  options.foresees = [&](const PartHypothesis& one, const PerFinger<double>& by) {
    return outlooks.foreseen(one.hypothesis.place, by);
  };
  next.advice = advise(held.part, next.hypotheses, options);
  if (!next.advice->helps) {
    next.why = symmetry(held.part) == 0 ? "the part looks the same from every place on its boundary"
               : symmetry(held.part) > 1
                   ? fmt::format("the part looks the same from {} places", symmetry(held.part))
                   : "no motion that all of them allow moves the jaw's contact otherwise; turn the jaw, or roll on";
    return next;
  }
  // What the reader compares with the skin: the contact's travel after the advised motion, from each place.
  for (const Hypothesis& one : next.hypotheses) {
    next.travels.push_back(outlooks.foreseen(one.place, next.advice->lengths()).value);
  }
  if (held.mirrored) next.advice->way[0] *= -1;  // as the world sees the jaw's x
  return next;
}

}  // namespace rollfix
