#pragma once

#include <memory_resource>
#include <vector>

namespace rollfix::belief {

/// How far a finger has travelled, told by lengths that are noisy. The steps from each length to the next add up to
/// what the finger travelled and to all the noise besides: of n rows at rest to 2 n sd / sqrt(pi). So a length is
/// compared with the last one that is farther off than noise can make it; what lies between is spread evenly over the
/// rows between, and is not given out twice.
class Travel {
 public:
  /// A length that was measured, of as many rows as were joined for it.
  struct Mark {
    double row = 0;       // their number, the middle one's
    double length = 0;    // from the first contact
    double variance = 0;  // of that, the mark's own
  };

  /// `first`: the first contact. `per_row`: what the variance of a difference of lengths grows by with every row
  /// between them, as where lengths are sums of increments.
  Travel(const Mark& first, double per_row, std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : marks_({first}, memory), so_far_({0.0}, memory), per_row_(per_row) {}

  /// From the last mark to this one: length, at least 0.
  double since_last(const Mark& mark) const;
  /// The same, and this one is the last mark from now on.
  double add(const Mark& mark);
  /// From the first contact to the last mark.
  double so_far() const { return so_far_.back(); }
  /// Takes all marks away but the first contact.
  void restart();

 private:
  std::pmr::vector<Mark> marks_;
  std::pmr::vector<double> so_far_;  // from the first contact to each of them
  double per_row_;
};

}  // namespace rollfix::belief
