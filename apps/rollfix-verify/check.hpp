#pragma once

#include <cstddef>
#include <exception>
#include <limits>
#include <string>

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

/// A longer text is not looked at: 100 times as long as any that is known.
inline constexpr std::size_t kMostBytes = std::size_t{1} << 25U;

/// What checking a certificate came to.
struct Verdict {
  std::size_t placements = 0;
  std::size_t families = 0;  // of them: lines of pairs all of which fit
  std::size_t cells = 0;
  std::size_t open = 0;         // cells that exclude nothing, of which not all is proved to fit either
  double share = 0;             // of all starts (of two fingers: of all pairs) that are in such cells
  std::size_t unproved = 0;     // placements of which no more is proved than that their starts fit
  bool of_touches = false;      // then placements are sets of poses, and cells boxes of poses
  bool of_holds = false;        // then placements are sets of first contacts, and cells boxes of them
  std::size_t unwitnessed = 0;  // of a hold: sets of which it is not shown that anything in them fits
  std::size_t left_out = 0;     // sets that the answer does not list
  std::size_t inside = 0;       // poses that the answer lists by themselves, though they are in another one's set
  std::string open_contact;     // "touch 0": whose place is known of the poses that are left open
  std::string question;         // which part, readings, facing and tolerance
  std::string refusal;          // why it is refused; empty: all but what is open is proved

  bool is_complete() const { return refusal.empty() && open == 0 && unproved == 0 && unwitnessed == 0; }
};

/// Proves what a certificate claims, or says why not. Throws std::exception: a text that is no certificate.
Verdict check(const std::string& text);

class Document;
/// The same of what one finger's certificate claims, two fingers', and those of touches and of holds. Throw
/// std::domain_error: it is refused.
Verdict check_one_finger(const Document& document);
Verdict check_two_fingers(const Document& document);
Verdict check_touches(const Document& document);
Verdict check_holds(const Document& document);

/// The verdict as it is printed.
std::string described(const Verdict& verdict);

}  // namespace rollfix_verify
