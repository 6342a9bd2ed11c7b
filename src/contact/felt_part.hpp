#pragma once

#include <cstddef>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// What one finger says of the part at each row, when its first contact is at a given place of the boundary.
class FeltPart {
 public:
  /// All have to stay. The log has u, psi, x and y.
  FeltPart(const Part& part, const Finger& finger, const Log& log, double start);

  /// Whether a log has what this needs.
  static bool is_in(const Log& log) { return log.kind == LogKind::contact && !log.x.empty(); }

  /// The part's heading that the contact's normal asks for: u + psi = heading + Theta(s) + pi / 2. At a convex corner
  /// the tangent may have any direction of the pivot, so that this is an interval; unwrapped over the rows.
  Interval heading(std::size_t row) const;

  /// The contact, in the part's frame and in the world's.
  Vec2 on_part(std::size_t row) const { return part_.point(place(row)); }
  Vec2 in_world(std::size_t row) const;

  std::size_t rows() const { return u_.size(); }

 private:
  double place(std::size_t row) const { return start_ - finger_.length_per_u() * (u_[row] - u_[0]); }
  Contact contact(std::size_t row) const { return {u_[row], psi_[row]}; }
  Interval tangents(double s) const;

  const Part& part_;
  Finger finger_;
  const Log& log_;
  double start_;
  std::vector<double> u_;
  std::vector<double> psi_;
};

}  // namespace rollfix
