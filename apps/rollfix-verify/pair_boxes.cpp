#include "pair_boxes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <system_error>

#include "budget.hpp"
#include "document.hpp"

// Notation:
//   (s, t)          first contacts of finger a and of finger b
//   F(s, t)         A(s) - B(t), the equations: `equations_`
//   cover           text: `s` and `t` halve a box, and leaves follow: Leaf
//   stretch         first contacts of one finger between two cuts, where a contact comes to a corner: Stretch
// Follows docs/certificates.md, "Two fingers".
// Idea: each pair of two stretches of a box is proved by itself, by bounds on F there, or on both halves of the one
// that changes more.
namespace rollfix_verify {
namespace {

constexpr int kMostSplits = 200;
constexpr double kLeafWork = 0.1;  // in expansions
const std::string kLevels = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdef";

/// Reads the tree by recursive descent: `read` of a box reads its cell, or both of its halves.
class Reader {
 public:
  Reader(const std::string& text, const std::function<void(const Leaf&)>& use) : text_(text), use_(use) {}

  void read(const Box& box, int depth) {
    // Each node costs: a tree of any size ends.
    Budget::spend(kLeafWork);
    const char token = next();
    if (token == 's' || token == 't') {
      if (depth == kMostSplits) throw std::domain_error("its cells are halved too often");
      const std::size_t finger = token == 's' ? 0 : 1;
      // One double for both halves: they share their edge exactly.
      const double middle = box[finger].lo + 0.5 * box[finger].width();
      Box half = box;
      half[finger].hi = middle;
      read(half, depth + 1);
      half[finger] = {middle, box[finger].hi};
      read(half, depth + 1);
      return;
    }
    // `?` until something else is read.
    Leaf leaf{Leaf::unproved, box};
    if (token == '[') {
      leaf.kind = Leaf::placement;
      leaf.number = number();
    } else if (token != '?') {
      const std::size_t level = kLevels.find(token);
      if (level == std::string::npos) throw std::domain_error("its cells have an unknown letter");
      leaf.kind = Leaf::apart;
      // 2^-level.
      leaf.bound = std::ldexp(1.0, -static_cast<int>(level));
    }
    use_(leaf);
  }

  bool is_at_end() const { return at_ == text_.size(); }

 private:
  /// Throws std::domain_error at the end of the text.
  char next() {
    if (is_at_end()) throw std::domain_error("its cells do not cover everything");
    return text_[at_++];
  }

  /// The digits up to `]`.
  std::size_t number() {
    std::size_t value = 0;
    const char* const end = text_.data() + text_.size();
    const auto [behind, error] = std::from_chars(text_.data() + at_, end, value);
    if (error != std::errc() || behind == end || *behind != ']') {
      throw std::domain_error("its cells name a placement by no number");
    }
    at_ = static_cast<std::size_t>(behind - text_.data()) + 1;
    return value;
  }

  const std::string& text_;
  const std::function<void(const Leaf&)>& use_;
  std::size_t at_ = 0;
};

constexpr int kDeepest = 120;
constexpr std::size_t kMostPairs = 400000;  // of a box, before it is given up
constexpr std::size_t kMostParts = 24;      // of a box in which what may fit is looked for
constexpr std::size_t kMostBeside = 400;    // the same of a box by a line that fits, ...
constexpr int kDeepestBeside = 16;          // ... halved so often at the most

}  // namespace

/// The text must be one tree: so its leaves hold the whole box, without gaps.
void read_cover(const std::string& text, const Box& whole, const std::function<void(const Leaf&)>& use) {
  Reader reader(text, use);
  reader.read(whole, 0);
  if (!reader.is_at_end()) throw std::domain_error("its cells go on behind the last one");
}

/// Whether that is so of each pair of two stretches in a box.
template <class Is>
bool PairBoxes::all_of(const Box& box, Cuts cuts, const Is& is) {
  const std::vector<Stretch>& all_b = curves_[1].over(box[1].lo, box[1].hi, cuts);
  // Stretches are cached by finger: both lists stay valid here.
  for (const Stretch& a : curves_[0].over(box[0].lo, box[0].hi, cuts)) {
    for (const Stretch& b : all_b) {
      if (!is(a, b)) return false;
    }
  }
  return true;
}

/// Of the one on which the angles change more; nothing: on neither they do.
std::optional<PairBoxes::Halves> PairBoxes::halves(const Stretch& a, const Stretch& b) {
  // Radians.
  const double by_a = a.change();
  const double by_b = b.change();
  if (!(std::max(by_a, by_b) > 0)) return std::nullopt;
  if (by_a > by_b || (by_a == by_b && a.width() > b.width())) {
    // Of equal change the longer one.
    const auto& [first, second] = curves_[0].halved(a);
    return Halves{{{&first, &b}, {&second, &b}}};
  }
  const auto& [first, second] = curves_[1].halved(b);
  return Halves{{{&a, &first}, {&a, &second}}};
}

/// All pairs of stretches share one count of parts.
void PairBoxes::prove_apart(const Box& box, double bound) {
  std::size_t parts = 0;
  all_of(box, Cuts::corners, [&](const Stretch& a, const Stretch& b) {
    prove_apart(a, b, bound, 0, parts);
    return true;
  });
}

void PairBoxes::prove_apart(const Stretch& a, const Stretch& b, double bound, int depth, std::size_t& parts) {
  if (equations_.are_apart(a, b, bound)) return;
  // Not excluded as a whole: both halves must be.
  const std::optional<Halves> both = depth == kDeepest || ++parts > kMostPairs ? std::nullopt : halves(a, b);
  if (!both) refuse("it could not be proved near s = " + std::to_string(a.lo) + ", t = " + std::to_string(b.lo));
  for (const auto& [half_a, half_b] : *both) prove_apart(*half_a, *half_b, bound, depth + 1, parts);
}

/// Exactly one pair of stretches has one root; each other one is proved apart, or the answer is unknown.
PairBoxes::Roots PairBoxes::roots_in(const Box& box, double tolerance) {
  Roots result = Roots::unknown;
  std::size_t parts = 0;
  const auto is_the_only_one = [&](const Stretch& a, const Stretch& b) {
    if (!equations_.have_one_root(curves_[0], a, curves_[1], b, tolerance)) {
      // Throws where it can't be proved: then the answer is unknown.
      prove_apart(a, b, tolerance, 0, parts);
      return true;
    }
    // A second root.
    if (result != Roots::unknown) return false;
    result = a.pivot || b.pivot ? Roots::one_pivot : Roots::one;
    return true;
  };
  try {
    return all_of(box, Cuts::corners, is_the_only_one) ? result : Roots::unknown;
  } catch (const std::domain_error&) {
    return Roots::unknown;
  }
}

bool PairBoxes::may_fit(const Box& box, double most) {
  return !all_of(box, Cuts::corners,
                 [&](const Stretch& a, const Stretch& b) { return !equations_.fit_together(a, b, most); });
}

/// Cut at jumps of curvature as well, beyond which equations are no planes.
std::optional<std::vector<Polygon>> PairBoxes::remains(const Box& box, double tolerance, const PairLine* line) {
  std::vector<Polygon> result;
  std::size_t parts = 0;
  try {
    const bool is_told = all_of(box, Cuts::bends, [&](const Stretch& a, const Stretch& b) {
      return add_remains(a, b, tolerance, line, 0, parts, result);
    });
    return is_told ? std::optional(result) : std::nullopt;
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
}

/// By the shares of two stretches that are behind. Where equations are planes to some tolerances, a convex set holds
/// all that fits, and what it holds is off by kNear tolerances at the most; so it is beside a line that fits.
std::optional<Polygon> PairBoxes::remains(const Stretch& a, const Stretch& b, double tolerance,
                                          const PairLine* line) const {
  const std::vector<PairEquations::Plane> planes = equations_.planes(a, b);
  // A set where |plane| <= tolerance + off has |equation| <= tolerance + 2 off: no more than kNear tolerances.
  const auto is_flat = [&](const PairEquations::Plane& plane) { return plane.off <= 0.5 * (kNear - 1) * tolerance; };
  if (planes.empty() || !std::all_of(planes.begin(), planes.end(), is_flat)) {
    return line != nullptr ? line->beside(curves_[0], equations_, a, b, tolerance) : std::nullopt;
  }
  Polygon set{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const PairEquations::Plane& plane : planes) {
    set = clipped(set, plane.at, {plane.by_a, plane.by_b}, tolerance + plane.off);
    set = clipped(set, -plane.at, {-plane.by_a, -plane.by_b}, tolerance + plane.off);
  }
  return set;
}

/// False where what may fit can't be told within the allowed number of parts.
bool PairBoxes::add_remains(const Stretch& a, const Stretch& b, double tolerance, const PairLine* line, int depth,
                            std::size_t& parts, std::vector<Polygon>& remains) {
  if (equations_.are_apart(a, b, tolerance)) return true;
  if (std::optional<Polygon> set = this->remains(a, b, tolerance, line)) {
    // From shares of both stretches to arc lengths.
    for (auto& [s, t] : *set) {
      s = a.lo + s * a.width();
      t = b.lo + t * b.width();
    }
    if (!set->empty()) remains.push_back(*set);
    return true;
  }
  // Beside a line many small parts are needed; elsewhere few parts tell, or none.
  const std::size_t most = line != nullptr ? kMostBeside : kMostParts;
  const bool is_too_deep = line != nullptr && depth == kDeepestBeside;
  const std::optional<Halves> both = ++parts > most || is_too_deep ? std::nullopt : halves(a, b);
  return both && std::all_of(both->begin(), both->end(), [&](const auto& half) {
           return add_remains(*half[0], *half[1], tolerance, line, depth + 1, parts, remains);
         });
}

}  // namespace rollfix_verify
