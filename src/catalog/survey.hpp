#pragma once

#include <cstddef>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "rollfix/identify.hpp"
#include "rollfix/solve.hpp"

namespace rollfix {

/// What has been found out about parts so far: bounds rule out most, with noise a glance most others, and those that
/// are left are solved.
class Survey {
 public:
  Survey(const Catalog& catalog, const Problem& like, const IdentifyOptions& options)
      : catalog_(catalog), like_(like), options_(options) {}

  /// Looks at those that may be it with so many times the noise, and that were not looked at before.
  void look(const std::vector<std::size_t>& parts, double excess, Identified& found);

  /// Of a part that something fits on.
  const Answer& answer(std::size_t part) const { return answers_.at(part); }

 private:
  const Catalog& catalog_;
  const Problem& like_;
  const IdentifyOptions& options_;
  std::unordered_set<std::size_t> searched_;
  std::unordered_map<std::size_t, Answer> answers_;
};

}  // namespace rollfix
