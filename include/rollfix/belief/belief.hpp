#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/contact/log_stream.hpp"
#include "rollfix/contact/noise.hpp"
#include "rollfix/outline/curve.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// What is known of the first contact before the roll: a normal distribution along the boundary, wrapped around it.
struct Prior {
  double s = 0;   // mean, arc length along the stored outline
  double sd = 0;  // length, above 0
};

struct BeliefOptions {
  Noise noise;
  std::optional<Prior> prior;  // none: every place alike
  bool robust = false;         // a stray sample counts no more than its share
  bool bare = false;           // readings whose first contact is exact and that do not drift
};

/// A place where the posterior has its mass: one of several that remain.
struct Mode {
  double start = 0;        // s of the first contact where the density is largest, in [0, P)
  double end = 0;          // s of the last contact for that start, in [0, P)
  double tangent = 0;      // its direction at the start, radians, unwrapped; in a corner that of the pivot
  double probability = 0;  // of the first contact being in here
  double mean = 0;         // of it, given that it is in here; in [0, P)
  double sd = 0;           // length
  Interval interval;       // holds 95 % of this mode's probability; lo in [0, P), hi may exceed P
  Interval region;         // holds all of it: up to where the density is least, or next to nothing
  double end_mean = 0;     // mean of where the contact is now, in [0, P)
  double end_sd = 0;
};

/// A little of the posterior: the share of the probability that the first contact is in between.
struct Mass {
  Interval s;        // unwrapped along the boundary
  Interval tangent;  // the tangent's direction at both ends, radians, unwrapped; in a corner s does not change
  double share = 0;
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

/// Where on the part's boundary the finger can have started, given all the samples of a roll and how noisy they are:
/// the posterior density over the whole boundary, on a grid that adapts to it. No particles, no random numbers. See
/// docs/belief.md.
class Belief {
 public:
  /// `kind`: of the log that the samples come from: increments gather errors as they are summed. Throws InputError:
  /// noise that is not valid (no length or no angle may be free of error altogether), a prior that is not.
  Belief(const Part& part, LogKind kind, const BeliefOptions& options);
  ~Belief();
  Belief(Belief&&) noexcept;
  Belief& operator=(Belief&&) noexcept;

  /// The next sample of the roll, in the order of the log. Costs no memory beyond a fixed number of samples.
  void add(const Sample& sample);
  std::size_t samples() const;

  /// The places that remain, the most probable first; what they leave out is less than `rest`.
  const std::vector<Mode>& modes();
  double rest();

  /// By how many times the samples are off more than the noise allows; 1 where they are not. What modes() says is as
  /// with that much more noise.
  double excess();

  /// The posterior in pieces, in order along the boundary, without those of next to no probability.
  std::vector<Mass> mass();

  /// How far f = Theta(s + L) - Theta(s) - theta of the last sample can be from 0 at the places that remain, radians: a
  /// tolerance for the search that lets all of them pass.
  double tolerance();

  /// Which explanation is the likeliest where nothing fits: the samples are weighed again with errors that they were
  /// not said to have.
  Diagnosis diagnosis();

  /// In plain words: "unique", "ambiguous (k)", "unobservable", "inconsistent".
  std::string verdict();
  /// The same where only these modes are left, the most probable first: others are out of the finger's reach.
  std::string verdict_on(const std::vector<Mode>& modes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rollfix
