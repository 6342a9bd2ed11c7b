#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "rollfix/contact/log.hpp"
#include "rollfix/contact/noise.hpp"
#include "rollfix/locate/placement.hpp"
#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"
#include "rollfix/per_finger.hpp"

namespace rollfix {

/// What is known of the first contact (of two fingers, of finger a's) before the roll: a normal distribution along the
/// boundary, wrapped around a closed one.
struct Prior {
  double s = 0;   // mean, arc length along the stored outline
  double sd = 0;  // length, above 0
};

struct BeliefOptions {
  Noise noise;
  std::optional<Prior> prior{};  // none: every place alike
  bool robust = false;           // a stray sample counts no more than its share
  bool bare = false;             // readings whose first contact is exact and that do not drift
};

/// What is known of the fingers, one or two.
struct Contacts {
  PerFinger<double> finger_curvature;  // at the first contact: 1/r of a disk; 0 of a jaw, or where it is not known
  std::optional<double> facing{};      // of two: (u + psi)_a - (u + psi)_b at the first contacts, radians
};

/// Where the posterior has its mass: one of several places, or of two fingers pairs of places, that remain.
struct Mode {
  PerFinger<double> start;    // s of the first contacts where the density is largest, in [0, P)
  PerFinger<double> end;      // s of the last contacts for that start, in [0, P)
  PerFinger<double> tangent;  // directions at the start, radians, unwrapped; in a corner those of the pivot
  double probability = 0;     // of the first contacts being in here
  PerFinger<double> mean;     // of them, given that they are in here; in [0, P)
  PerFinger<double> sd;       // length
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of two fingers, length^2
  PerFinger<Interval> interval;  // holds 95 % of this mode's probability; lo in [0, P), hi may exceed P
  PerFinger<Interval> region;    // holds all of it: up to where the density is least, or next to nothing
  PerFinger<double> end_mean;    // mean of where the contacts are now, in [0, P)
  PerFinger<double> end_sd;
};

/// Why nothing fits, if nothing does.
enum class Cause {
  none,    // something fits
  radius,  // lengths by one factor throughout would: the finger's radius, or the unit
  slip,    // lengths that are off now and then would
  part     // not even that: another part, another finger, or another side of it
};

struct Diagnosis {
  Cause cause = Cause::none;
  double excess = 1;        // of the samples with that explanation, see Belief::excess
  double length_scale = 1;  // radius: lengths would have to be this many times what was measured
};

/// What a finger feels at an instant: where its contact is in the world, and where the part's inward normal points
/// there, radians.
struct FeltContact {
  Vec2 where = Vec2::Zero();
  double facing = 0;
  double finger_curvature = 0;
};

/// Where the first contacts can have been on the part's boundary, given all the samples of a roll and how noisy they
/// are: the posterior density, of one finger over the whole boundary, of two over all pairs of places, on a grid that
/// adapts to it. No particles, no random numbers. See docs/belief.md and docs/two_fingers.md.
class Belief {
 public:
  /// `kind`: of the log that the samples come from: increments gather errors as they are summed. `contacts`: of one
  /// finger or two; of one finger every sample tells its own curvature. Throws InputError: noise that is not valid (no
  /// length or no angle may be free of error altogether), a prior or a facing that is not.
  Belief(const Part& part, LogKind kind, const BeliefOptions& options, const Contacts& contacts = {});
  ~Belief();
  Belief(Belief&&) noexcept;
  Belief& operator=(Belief&&) noexcept;

  /// The next sample of the roll, in the order of the log: of logs of u and psi also the first, where lengths and turn
  /// are 0. One finger's cost no memory beyond a fixed number of samples. Throws InputError: of another number of
  /// fingers.
  void add(const Sample& sample);
  void add(const Reading& reading);
  std::size_t samples() const;  // a first contact, of length 0, is not one of them

  /// What remains, the most probable first; what they leave out is less than `rest`. None before the first sample.
  const std::vector<Mode>& modes();
  double rest();

  /// By how many times the samples are off more than the noise allows; 1 where they are not. What modes() says is as
  /// with that much more noise.
  double excess();

  /// How far f can be from 0 at what remains, radians: a tolerance for a search with these readings that lets all of it
  /// pass. Of one finger that of the last sample, whose f is the least certain.
  double tolerance(const std::vector<Reading>& readings);

  /// Which explanation is the likeliest where nothing fits: the samples are weighed again with errors that they were
  /// not said to have.
  Diagnosis diagnosis();

  Verdict verdict();
  /// The same where only some are left, of these probabilities, the most probable first, and with these intervals that
  /// hold 95 %: others are out of the fingers' reach.
  Verdict verdict_on(const std::vector<Mode>& modes);
  Verdict verdict_on(const std::vector<Placement>& placements);

  /// The part's pose at the first contacts, given that they are one of a mode's: number `mode` of modes(). The errors
  /// with which those contacts were felt add theirs; of two fingers, as far as the samples don't tell them.
  PoseSpread pose_spread(std::size_t mode, const PerFinger<FeltContact>& felt);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What the samples of a whole roll make of the placements that a few readings of it allow.
struct Weighed {
  std::vector<Placement> placements;  // one for each of Belief::modes(), with its probability and spread
  std::vector<Placement> improbable;  // within the tolerance for the readings, but not for all the samples
};

/// Takes the placements of a search together with what is known of each place: a placement for each mode, which starts
/// where the posterior's density is largest. The search, with Belief::tolerance() at least, says what kind it is and
/// which exact roots it holds; its placements without a mode are improbable. `readings`, `facing`: what was searched
/// with. Of two fingers the sensitivity is of the search's own start.
Weighed weigh(const Part& part, const std::vector<Reading>& readings, const std::optional<double>& facing,
              const Search& found, Belief& belief);

}  // namespace rollfix
