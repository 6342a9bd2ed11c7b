#pragma once

#include <cstddef>
#include <vector>

#include "index.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/touch.hpp"
#include "touch/cell_search.hpp"

namespace rollfix {

/// Rules out parts of a catalog that touches can't be of, by cells of their boundaries.
class TouchBounds {
 public:
  /// REQUIRES that the problem is valid of some part, which does not matter.
  TouchBounds(const Catalog& catalog, const TouchProblem& like);

  /// Those of the parts that are left. Throws InputError: it was told to stop, or the file is damaged.
  std::vector<std::size_t> left_of(const std::vector<std::size_t>& parts, const IdentifyOptions& options) const;

 private:
  const Catalog& catalog_;
  std::vector<touch::Measured> touches_;
  touch::TouchPair pair_;
  double radius_ = 0;
};

}  // namespace rollfix
