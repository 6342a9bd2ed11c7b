#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/locate/locate_pair.hpp"
#include "rollfix/locate/pair_reading.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// Where both fingers' first contacts can be: one of several pairs of places that remain. One entry per finger.
struct PairMode {
  PairPoint start{};                // where the density is largest, each in [0, P)
  PairPoint end{};                  // the last contacts for that start, likewise
  std::array<double, 2> tangent{};  // at the start, radians, unwrapped; in a corner that of the pivot
  double probability = 0;           // of the first contacts being in here
  PairPoint mean{};                 // of them, given that they are in here; each in [0, P)
  std::array<double, 2> sd{};       // length
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // length^2
  PairBox interval;  // each holds 95 % of this mode's probability for its finger; lo in [0, P), hi may exceed P
  PairBox region;    // holds all of it
  PairPoint end_mean{};
  std::array<double, 2> end_sd{};
};

/// A little of the posterior: first contacts and the share of the probability that they stand for.
struct PairMass {
  PairPoint start{};                // unwrapped
  std::array<double, 2> tangent{};  // radians, unwrapped
  std::array<double, 2> slid{};     // how much further round each finger the first contact was than felt, length
  Eigen::Matrix2d slid_covariance = Eigen::Matrix2d::Zero();
  std::size_t mode = 0;  // which one it is of
  double share = 0;
};

/// What is special about two fingers, beyond BeliefOptions; its prior is of finger a's first contact.
struct PairContacts {
  std::array<double, 2> finger_curvature{};  // 1/r of each disk; 0 of a jaw, or where it is not known
  std::optional<double> facing;              // (u + psi)_a - (u + psi)_b at the first contacts, radians
};

/// Where two fingers can have started on a part that is free to move, given all the samples of a roll and how noisy
/// they are: the posterior density of both first contacts. See docs/two_fingers.md.
class PairBelief {
 public:
  /// `kind`: of the logs that the samples come from. Throws InputError as Belief does.
  PairBelief(const Part& part, LogKind kind, const BeliefOptions& options, const PairContacts& contacts);
  ~PairBelief();
  PairBelief(PairBelief&&) noexcept;
  PairBelief& operator=(PairBelief&&) noexcept;

  /// The next sample, in the order of the log: of logs of u and psi also the first, where all three are 0.
  void add(const PairReading& sample);
  std::size_t samples() const;

  /// The pairs of places that remain, the most probable first; what they leave out is less than `rest`.
  const std::vector<PairMode>& modes();
  double rest();

  /// By how many times the samples are off more than the noise allows; 1 where they are not. What modes() says is as
  /// with that much more noise.
  double excess();

  /// The posterior in pieces, without those of next to no probability.
  std::vector<PairMass> mass();

  /// How far f of the readings can be from 0 at the places that remain, radians: a tolerance for a search with them
  /// that lets all of them pass.
  double tolerance(const std::vector<PairReading>& readings);

  /// Which explanation is the likeliest where nothing fits.
  Diagnosis diagnosis();

  /// In plain words: "unique", "ambiguous (k)", "unobservable", "inconsistent".
  std::string verdict();
  /// The same where only these modes are left, the most probable first.
  std::string verdict_on(const std::vector<PairMode>& modes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rollfix
