#pragma once

// The estimate alone: the posterior of the first contact over the boundary, sample by sample.
//
//     const Part part = load_part("gallery:spline,n=9,seed=7,wobble=0.2");
//     Belief belief(part, LogKind::increments, {.noise = {.angle = 0.003, .slip = 0.002}});
//     belief.add(Reading(1.0, 0.9937));
//     belief.modes().size();  // 6
//     belief.add(Reading(1.95, 2.2898));  // of the same roll, later
//     belief.modes().size();  // 1
//
// Degenerate cases: on a circle every place stays as probable; a sample that no place explains makes `fit` bad and all
// modes wide, never none.
//
// Accuracy: where the posterior has a closed form it agrees (tests/belief_closed_forms_test.cpp); docs/calibration.md
// has how often intervals hold the truth.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// What is known of the first contact (of two fingers, of finger a's) before the roll: a normal distribution along the
/// boundary, wrapped around a closed one.
struct Prior {
  double s = 0;   // mean, arc length along the stored outline
  double sd = 0;  // length, above 0
};

/// What is known of the part's pose at the first contacts before the roll: normal distributions, of x and y alike.
struct PosePrior {
  Pose mean;
  double heading_sd = 0;                                      // radians, above 0
  double place_sd = std::numeric_limits<double>::infinity();  // length; infinite: only the heading is known
};

struct BeliefOptions {
  /// Angles that are noisier, radians, would be taken for more than they say.
  static constexpr double kMostAngle = 0.5;

  Noise noise;
  std::optional<Prior> prior{};  // none: every place alike
  bool robust = false;           // a stray sample counts no more than its share
  bool bare = false;             // readings whose first contact is exact and that do not drift
  double scale_sd = 0;           // of all lengths by one factor, besides what slip and radius make of them, ...
  std::optional<std::size_t> scale_of{};  // ... or of this one's of two fingers
  bool glance = false;                    // of two fingers: where nothing fits there are no modes, and Fit says no more
  std::optional<PosePrior> pose{};  // for logs of u and psi and known fingers; places take x and y in the log as well
  /// Of one finger: its samples are joined to so many at most; none: as few as lose nothing.
  std::optional<std::size_t> nodes{};
  /// To weigh one explanation against another. Of one finger samples are joined for their number alone, whatever the
  /// noise. Of two the effort is bounded: what is too wide for it is left open, in Belief::rest.
  bool by_rows = false;
  /// Of one finger: stretches of [0, P] outside which the first contact can't be; none: it can be anywhere.
  std::vector<Interval> within{};
};

/// What is known of the fingers, one or two.
struct FingerGeometry {
  PerFinger<double> finger_curvature;  // at the first contact: 1/r of a disk; 0 of a jaw, or where it is not known
  std::optional<double> facing{};      // of two: (u + psi)_a - (u + psi)_b at the first contacts, radians
  std::vector<Finger> fingers{};       // none: not known, and centres say nothing; one serves both of two
};

/// Where the posterior has its mass: one of several places, or of two fingers pairs of places, that remain.
struct Mode {
  PerFinger<double> start;    // s of the first contacts where the density is largest, in [0, P); where that is outside
                              // of the interval, as on a stretch that is flat, the middle of it
  PerFinger<double> end;      // s of the last contacts for that start, in [0, P)
  PerFinger<double> tangent;  // directions at the start, radians, unwrapped; in a corner those of the pivot
  double probability = 0;     // of the first contacts being in here
  PerFinger<double> mean;     // of them, given that they are in here; in [0, P)
  PerFinger<double> sd;       // length
  Mat2 covariance = Mat2::Zero();  // of two fingers, length^2
  PerFinger<Interval> interval;    // holds 95 % of this mode's probability; lo in [0, P), hi may exceed P
  PerFinger<Interval> region;      // holds all of it: up to where the density is least, or next to nothing
  PerFinger<double> end_mean;      // mean of where the contacts are now, in [0, P)
  PerFinger<double> end_sd;
};

/// A little of the posterior along the boundary: so much of the probability, evenly spread over an interval. In a
/// corner the interval is a point.
struct DensityPiece {
  Interval s;  // of the first contact; lo in [0, P), hi may exceed P
  double probability = 0;
};
/// Of one finger's first contact, in order; what they hold together is 1, but for Belief::rest().
using Density = std::vector<DensityPiece>;

/// How well the samples fit the likeliest place, as noisy as they are said to be.
struct Fit {
  // What a standard normal deviate is beyond once in some thousand times.
  static constexpr double kMostSigmas = 3.3;
  // Of the chi-square that is to be expected, less than this share: of the noise, less than half.
  static constexpr double kFarTooGood = 0.25;
  // Turns that are off by more at the end of a roll tell next to nothing there, radians.
  static constexpr double kMostGathered = 1;

  double chi_square = 0;          // of the samples about that place
  double freedom = 0;             // as much is to be expected of it
  double sigmas = 0;              // how unlikely such a chi-square is: a standard normal deviate
  double correlation = 0;         // of neighbouring samples' errors, which should be independent
  double correlation_sigmas = 0;  // how unlikely that is
  double trend_sigmas = 0;        // how unlikely it is that independent errors drift so, or go to and fro so slowly
  double row_sigmas = 0;          // how unlikely it is that the row that is farthest off is so far off
  double stray = 0;               // robust: as many rows are
  double prior_sigmas = 0;        // how unlikely it is that rows which fit another place so much better, or are so far
                                  // from where the prior has it, go with the prior
  double excess = 1;              // by how many times the samples are off more than the noise allows; 1: they are not
  double widened = 1;             // all that is said is as with this many times the noise: the excess, and what
                                  // samples that are alike are worth
  double alike_over = 0;          // where they fit too well: neighbouring samples may be off alike over so much of the
                                  // roll, length; 0: no such length is known
  double turn_gathered = 0;       // standard deviation of what the turns gather by the end of the roll, radians
  PerFinger<double> length_scale = 1.0;     // lengths are this many times what was measured, ...
  PerFinger<double> length_scale_sd = 0.0;  // ... give or take; 0: they were said to be exact
  double turn_scale = 1;                    // turns by a gyroscope are this many times what was measured, ...
  double turn_scale_sd = 0;                 // ... give or take; 0: they were said to be exact
  double turn_bias = 0;     // of noise with drift: a gyroscope's rate is this much too high, radians per second, ...
  double turn_bias_sd = 0;  // ... give or take; 0: it was said to have none

  bool is_correlated() const { return std::max(correlation_sigmas, trend_sigmas) > kMostSigmas; }
  /// The noise is far less than was said, or neighbours are so much alike that it does not show: then the answer is too
  /// sure.
  bool is_too_good() const { return sigmas < -kMostSigmas && chi_square < kFarTooGood * freedom; }
  bool is_bad() const { return is_correlated() || std::max({sigmas, row_sigmas, prior_sigmas}) > kMostSigmas; }
};

/// How likely all samples are together, whatever the first contact: to weigh one belief against another whose samples
/// are as many, and said to be as noisy. Logarithms, up to what is the same in both.
struct Evidence {
  double peak = -std::numeric_limits<double>::infinity();  // of the likelihood at the likeliest place, ...
  double volume = 0;                                       // ... and of how much of the boundary is about as likely
  double gathered = 0;  // of one finger: what the likelihood has less because errors may gather on the way; the same at
                        // about all places, but not with another noise

  /// As with so many times the noise: see Fit::widened.
  double with(double widened) const { return peak / (widened * widened) + volume; }
};

/// What another part makes of the same samples.
struct Rival {
  double log_evidence = 0;  // Evidence::with(widened)
  double widened = 1;       // as its Fit has it
};

/// What is wrong with a log, or with what was said of it, where its rows fit badly.
enum class Cause {
  none,              // nothing: they fit
  unsaid_noise,      // rows that were not said to be noisy jitter
  noise,             // the rows are noisier than said, each on its own
  correlation,       // they are as noisy as said, and neighbours are off alike
  prior,             // what was said of the first contact beforehand
  radius,            // all lengths are off by one factor: the finger's radius, or the unit
  u_degrees,         // u is in degrees
  psi_degrees,       // psi is
  angles_degrees,    // both are
  turn_degrees,      // of a log without u and psi: the turn is
  u_radians,         // u is in radians, and was said to be in degrees
  psi_radians,       // psi is
  angles_radians,    // both are
  turn_radians,      // of a log without u and psi: the turn is
  u_clockwise,       // u is counted clockwise
  psi_clockwise,     // psi is
  u_psi_swapped,     // u was taken for psi, and psi for u
  fingers_swapped,   // of two fingers: finger a was taken for b
  both_clockwise,    // all angles are, or the part lies face down
  length_backwards,  // of a log without u and psi: the length is counted against the outline's direction
  turn_clockwise,    // the turn is counted clockwise
  stray,             // a few rows are anything
  gyroscope,         // all turns of a gyroscope are off by one factor
  slip,              // lengths are off here and there
  part               // nothing of all that: another part, another finger, another side of it
};

/// A mistake, and what would be the answer without it.
struct Diagnosis {
  Cause cause = Cause::none;
  double excess = 1;           // of the rows without that mistake, see Fit
  double log_odds = 0;         // of it against a log that is as noisy as its rows make it seem, but without mistake
  double length_scale = 1;     // radius: lengths are this many times what was measured, ...
  double length_scale_sd = 0;  // ... give or take, ...
  std::optional<std::size_t> finger{};  // ... of all fingers, or of this one alone
  double turn_scale = 1;                // gyroscope: turns are this many times what was measured, ...
  double turn_scale_sd = 0;             // ... give or take
  double noise_scale = 1;               // noise: it is this many times what was said
  Noise noise{};                        // where none was said: what they seem to have, and are to be read with
  std::size_t stray = 0;                // rows
  double slip = 0;                      // slip: so much per length would allow it
  double gyro = 0;                      // gyroscope: so much per turn would allow it
  /// Angles in degrees or radians, u and psi swapped: how the log's columns are to be read. Empty: no file's header is
  /// known.
  std::vector<ColumnSource> columns{};
  Verdict verdict{};          // the answer
  std::vector<Mode> modes{};  // likewise, the most probable first
};

/// What a finger feels at an instant: where its contact is in the world, and where the part's inward normal points
/// there, radians.
struct MeasuredContact {
  Vec2 where = Vec2::Zero();
  double normal = 0;
  double finger_curvature = 0;
};

/// A little of one finger's posterior, with what all rows say of the part's pose there.
struct PosePiece {
  struct End {
    double s = 0;        // of the first contact, unwrapped
    double tangent = 0;  // of the part there, radians, unwrapped: in a corner of the pivot
    PoseSpread pose;     // of the part, if the first contact is here; x and y mean something where the log has centres
  };
  End lo;  // s and tangent grow to `hi` along the boundary, or one of them stays
  End hi;
  double probability = 0;
  double rise = 0;  // by so much the logarithm of the density is larger at `hi`
};

/// Where the first contacts can have been on the part's boundary, given all the samples of a roll and how noisy they
/// are: the posterior density, of one finger over the whole boundary, of two over all pairs of places, on a grid that
/// adapts to it. No particles, no random numbers. See docs/belief.md and docs/two_fingers.md.
class Belief {
 public:
  /// `kind`: of the log that the samples come from: increments gather errors as they are summed. `contacts`: of one
  /// finger or two; of one finger every sample tells its own curvature. Throws InputError: noise that is not valid (no
  /// length or no angle may be free of error altogether), a prior or a facing that is not.
  Belief(const Part& part, LogKind kind, const BeliefOptions& options, const FingerGeometry& contacts = {});
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

  /// The same for every place: the density along the boundary, of either finger by itself. Of one finger as fine as it
  /// was computed; of two by steps of a third of a mode's standard deviation. Empty before the first sample.
  PerFinger<Density> density();

  /// How well they fit. What modes() says is as with Fit::widened times the noise.
  const Fit& fit();
  double excess();  // of it
  const Evidence& evidence();

  /// Next to a rival's, the evidence of this part is nothing: below exp(-25) of it, with the rival's noise. Takes far
  /// less time than modes(), before which it is asked. Of two fingers nothing is found out, and it is false.
  bool is_hopeless(const Rival& rival);

  /// How far f can be from 0 at what remains, radians: a tolerance for a search with these readings that lets all of it
  /// pass. Of one finger that of the last sample, whose f is the least certain.
  double tolerance(const std::vector<Reading>& readings);

  Verdict verdict();
  /// The same where only some are left, of these probabilities, the most probable first, and with these intervals that
  /// hold 95 %: others are out of the fingers' reach.
  Verdict verdict_on(const std::vector<Mode>& modes);
  Verdict verdict_on(const std::vector<Placement>& placements);

  /// The part's pose at the first contacts, given that they are one of a mode's: number `mode` of modes(). The errors
  /// with which those contacts were measured add theirs; of two fingers, as far as the samples don't tell them.
  PoseSpread pose_spread(std::size_t mode, const PerFinger<MeasuredContact>& measured);

  /// The posterior of one finger in pieces that hold its mass, in no order. Empty before the first sample, of two
  /// fingers, and where the finger or its orientation is not known.
  std::vector<PosePiece> pose_pieces();

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
              const std::vector<Placement>& found, Belief& belief);

}  // namespace rollfix
