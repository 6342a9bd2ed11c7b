#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/locate/locate.hpp"
#include "rollfix/locate/pair_reading.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// Two first contacts: s of finger a and t of finger b.
using PairPoint = std::array<double, 2>;

/// A box of them.
using PairBox = std::array<Interval, 2>;

/// How the two first contacts move when a reading does: one entry per finger, in each one per reading. Empty where it
/// is undefined. With J the rows [kappa(s_k) - kappa(s0), -(kappa(t_k) - kappa(t0))], least squares when there are
/// more rows than two.
struct PairSensitivity {
  std::array<std::vector<double>, 2> per_turn;                   // [finger][reading], length per radian
  std::array<std::vector<std::array<double, 2>>, 2> per_length;  // [finger][reading][which finger's length]
  std::array<double, 2> per_facing{};                            // [finger], length per radian of the facing
};

/// One answer: a connected set of pairs on which every |f_k| is within the tolerance, where
/// f_k(s, t) = Phi(s, s + La_k) - Phi(t, t + Lb_k) - theta_k.
struct PairPlacement {
  Kind kind = Kind::crossing;
  PairPoint start{};                 // first contacts, each in [0, P): the first root, else where the residual is least
  PairPoint end{};                   // last contacts, likewise
  PairBox extent;                    // around the connected set: lo in [0, P), hi may exceed P; a whole loop is [0, P]
  std::array<bool, 2> whole_loop{};  // the extent is all of a closed boundary
  std::vector<PairPoint> roots;      // every exact root in it, each in [0, P); of a stretch the first of its continuum
  double error = 0;                  // bound on the distance of each start from the true one; infinite where not simple
  double residual = 0;               // largest |f_k(start)|, radians, the facing equation's included
  std::array<Vec2, 2> point;         // positions of the first contacts
  std::array<double, 2> tangent{};   // directions of the tangents there, radians, in (-pi, pi]
  PairSensitivity sensitivity;
  std::vector<PairPoint> family;  // of a stretch: a line of pairs that runs through all of it, unwrapped; it may go
                                  // over parts of itself again where branches meet
  double family_error = 0;        // no pair of the stretch is further from that line, length
  std::optional<std::array<Pivot, 2>> pivot;  // of a corner, one entry per finger
};

struct PairSearch {
  Status status = Status::complete;
  std::vector<PairPlacement> placements;  // ordered by start
  std::vector<PairBox> unresolved;        // where a placement may be that is not listed
  SearchCounts counts;

  /// In plain words: "unique", "ambiguous (k)", "ambiguous (k, of them m stretches)", "unobservable" (what fits
  /// goes all the way round for one finger at least: no such roll can tell), "inconsistent" or "undecided".
  std::string verdict() const;
};

struct PairOptions {
  double tolerance = 1e-9;       // radians: how far |f_k| may be from 0; at least kTurnAccuracy is used
  std::size_t budget = 1000000;  // boxes to look at, beyond the part's own, before giving up (status incomplete)
  // The facing equation: Theta(s0) - Theta(t0) = facing mod 2 pi, with facing = (u + psi)_a - (u + psi)_b.
  std::optional<double> facing;
};

/// Every pair of places where two fingers can have started on a part that is free to move: eqs. (8) and (9), by
/// branch and prune on pairs of spirals. Two readings are the least without the facing equation, one with it.
/// Throws InputError: too few readings, a number that is not finite, a roll longer than an open curve.
PairSearch locate(const Part& part, const std::vector<PairReading>& readings, const PairOptions& options = {});

}  // namespace rollfix
