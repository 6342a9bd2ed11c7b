#pragma once

#include <memory>

#include "rollfix/locate/march/pair_result.hpp"
#include "rollfix/locate/march/refusal.hpp"
#include "rollfix/locate/pair_reading.hpp"
#include "rollfix/outline/outline.hpp"

namespace rollfix::march {

/// Section 3, two rolling fingers on a part that is free to move, as the paper has it: the reference for the production
/// search. Prepared for one closed outline and any number of readings. Immutable; copies share their data; safe to use
/// from any number of threads. docs/march.md derives what the paper leaves open.
class PairMarch {
 public:
  /// Throws Refusal for an outline that eq. (6) excludes, InputError for an open one or options out of range.
  explicit PairMarch(const Outline& outline, const PairMarchOptions& options = {});

  /// Every (s_0, t_0) that satisfies (8) with the first reading and (9) with the second. Lengths have either sign and
  /// any size. Throws Refusal (continuum) where one of the four phi is constant or a curve of pairs fits, InputError
  /// for numbers that are not finite.
  PairResult pairs(const PairReading& first, const PairReading& second) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// The same for one question.
PairResult locate_pairs(const Outline& outline, const PairReading& first, const PairReading& second,
                        const PairMarchOptions& options = {});

}  // namespace rollfix::march
