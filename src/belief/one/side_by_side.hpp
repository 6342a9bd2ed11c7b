#pragma once

#include <functional>

#include "belief/one/roll_filter.hpp"

namespace rollfix::belief {

struct GridPoint;

/// Nodes that a filter is to take, in order.
struct Errand {
  GridPoint* point = nullptr;  // that it is for
  int pass = 0;                // how often it has gone through them
  RollFilter* filter = nullptr;
  const Node* next = nullptr;
  const Node* end = nullptr;
  bool whole = false;  // all of them, however large the deviance gets
};

/// What rows tell of besides lengths and turns.
struct RowEquations {
  bool centres = false;          // two equations more
  bool gyroscope_scale = false;  // one unknown more, ...
  bool bias = false;             // ... and another
};

/// Gives the next errand; false: there is none. It is called with the one that is over, to go on from: its filter has
/// taken all nodes, or those before `next` and is beyond the limit. The first ones are called for with an empty one.
using NextErrand = std::function<bool(Errand&)>;

/// Runs errands, several side by side, for each is one long chain of operations that wait for each other. What comes of
/// one does not depend on the others. `limit`: of the deviance, as it is by then.
void run_errands(const NextErrand& next, const RowEquations& equations, const double& limit, const Outliers& outliers);

}  // namespace rollfix::belief
