#pragma once

#include <exception>
#include <limits>

namespace rollfix_verify {

/// A check came to the end of what it may spend.
class OutOfBudget : public std::exception {
 public:
  const char* what() const noexcept override { return "not decided within the budget of work"; }
};

/// While one of these lives, work is counted, in expansions of an ordinary curve at one place. It bounds memory as
/// well: whatever is kept was paid for.
class Budget {
 public:
  explicit Budget(double most) : before_(left()) { left() = most; }
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;
  ~Budget() { left() = before_; }

  /// Throws OutOfBudget.
  static void spend(double work) {
    if (!((left() -= work) >= 0)) throw OutOfBudget();
  }
  /// What may still be spent; infinite while no budget lives. Each thread has its own.
  static double& left() {
    thread_local double work = std::numeric_limits<double>::infinity();
    return work;
  }

 private:
  double before_;  // what was left of the budget around this one
};

}  // namespace rollfix_verify
