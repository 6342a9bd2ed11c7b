#pragma once

#include <cstddef>
#include <vector>

#include "held_rows.hpp"

namespace rollfix::hold {

/// Whether fingers that touch the part somewhere would enter each other: where each is on the part follows from its
/// contact, with or without x and y. Disks, outlines and jaws, which have no ends; two jaws are not compared.
class FingersApart {
 public:
  /// Looks at some of the rows, spread over the logs.
  FingersApart(const HoldProblem& problem, const HeldRows& rows);

  /// Whether two of them enter each other at some instant wherever on these arcs their first contacts are. With noise
  /// arcs end at kTouchSigmas standard deviations.
  bool must_overlap(const std::vector<Interval>& first_contacts) const;

 private:
  /// A finger as it lies on the part.
  struct Body;
  /// A finger at a row, with how far it can move while its first contact goes over an arc.
  Body body_at(std::size_t row, std::size_t finger, const Interval& first_contact) const;
  /// How deep two of them are in each other at least, wherever on their arcs they started, length.
  double depth(const Body& one, const Body& other) const;
  /// Two errors as one: with noise by the root of their squares, else their sum.
  double together(double one, double other) const;

  const HoldProblem& problem_;
  std::vector<HeldRow> rows_;                // those looked at
  std::vector<std::vector<double>> travel_;  // how far off a contact can be, of each row, of each finger
  std::vector<double> size_;                 // of each finger: how far its reference, of an outline its rim, is at most
                                             // from a contact
  bool has_noise_ = false;
  double radius_slack_ = 0;  // of two radii together, length; without noise 0
};

/// Throws InputError: two fingers enter each other by their own x and y, whatever the part does. `logs`: aligned.
void require_apart(const HoldProblem& problem, const std::vector<Log>& logs);

}  // namespace rollfix::hold
