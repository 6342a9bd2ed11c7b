#include "march/sweep.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

// Notation (section 2.2, Figure 3; docs/march.md, "Non-convex boundary: the four modes")
//   s, t          ends of the sliding segment: `pair.s`, `pair.t`, t = s + L; arc lengths
//   g, phi, C     density (kappa, or kappa' for eq. (6)); phi(s) = its integral over [s, s + L]; the value wanted
//   z_k, z_l+1    first sign change of g after s, and after t: `next_s_`, `next_t_`
//   sigma(s)      end of the segment that starts at s: s + L
//   excess, side  phi(s) - C, and its sign
// Idea: between two sign changes g(s) and g(t) keep their signs, one of four modes. Both signs the same: the march of
// section 2.1 (alternation.cpp). Different: phi is monotone, and bisection finds its one root or none. Theorem 5 counts
// the steps.

namespace rollfix::march {

namespace {

/// Rounding errors of phi - C, as a part of the density's variation plus |C|.
constexpr double kIntegralRounding = 1e-14;

/// The sequence of modes that a pair passes through, from its first place to the end of the sweep: at s = P on a closed
/// outline, at t = P on an open one.
class Modes {
 public:
  /// `first` is the pair at s = 0.
  Modes(const Path& path, const Preprocessed& preprocessed, const Pair& first)
      : changes_(preprocessed.changes),
        loop_(preprocessed.loop),
        first_sign_(preprocessed.first_sign),
        closed_(path.closed()),
        segment_length_(first.problem.length) {
    if (closed_) {
      sweep_end_ = loop_.length;
      last_s_ = first.s.position().moved_by(loop_);
      last_t_ = first.t.position().moved_by(loop_);
    } else {
      sweep_end_ = std::max(0.0, loop_.length - segment_length_);
      last_t_ = preprocessed.back;
    }
  }

  double sweep_end() const { return sweep_end_; }

  /// The mode in which the pair is now.
  Mode at(const Pair& pair) {
    pass(next_s_, pair.s.length());
    pass(next_t_, pair.t.length());

    Mode mode;
    mode.sign_s = sign_before(next_s_);
    mode.sign_t = sign_before(next_t_);
    const bool s_may_end = exists(next_s_);
    const bool t_may_end = exists(next_t_);
    const double s_sign_change = s_may_end ? length_of(next_s_) : sweep_end_;                    // z_k
    const double t_sign_change = t_may_end ? length_of(next_t_) - segment_length_ : sweep_end_;  // sigma^-1(z_{l+1})
    mode.s_end = std::min({s_sign_change, t_sign_change, sweep_end_});  // Figure 3: min(z_k, sigma^-1(z_{l+1}))
    mode.t_end = mode.s_end + segment_length_;                          // sigma(s)
    if (mode.s_end == sweep_end_) {
      mode.s_mark = last_s_;
      mode.t_mark = last_t_;
      return mode;
    }
    if (s_may_end && s_sign_change == mode.s_end) mode.s_mark = position_of(next_s_);
    if (t_may_end && t_sign_change == mode.s_end) {
      mode.t_mark = position_of(next_t_);
      mode.t_end = mode.t_mark->here.length;
    }
    return mode;
  }

 private:
  // Sign changes are numbered on through all loops.
  bool exists(std::size_t number) const { return closed_ ? !changes_.empty() : number < changes_.size(); }

  Span loops_before(std::size_t number) const {
    const std::size_t loops = number / changes_.size();
    return loop_ * static_cast<double>(loops);
  }

  Position position_of(std::size_t number) const {
    return changes_[number % changes_.size()].at.moved_by(loops_before(number));
  }

  double length_of(std::size_t number) const {
    return changes_[number % changes_.size()].at.here.length + loops_before(number).length;
  }

  int sign_before(std::size_t number) const {
    return number == 0 ? first_sign_ : changes_[(number - 1) % changes_.size()].sign_after;
  }

  void pass(std::size_t& next, double length) const {
    while (exists(next) && length_of(next) <= length) ++next;
  }

  const std::vector<SignChange>& changes_;
  Span loop_;
  int first_sign_;
  bool closed_;
  double segment_length_;
  double sweep_end_ = 0;
  std::optional<Position> last_s_;  // the sweep's last places, where they are known
  std::optional<Position> last_t_;
  std::size_t next_s_ = 0;  // the first sign change after s
  std::size_t next_t_ = 0;  // ... after t
};

/// A root of phi(s) = C between two places of a pair.
struct Bisected {
  Pair at;
  std::size_t iterations = 0;
};

/// Halves [s of start, high] until it is shorter than `tolerance`. REQUIRES that phi - C changes its sign once between.
/// Integrates forward from the lower end only, so that all halvings together cost about one more slide.
Bisected bisect(const Pair& start, double high, double tolerance, Tally& tally) {
  Pair low{start.s.counted_by(tally), start.t.counted_by(tally), start.problem};
  const int side = side_of(low.excess());
  Bisected result{low, 0};
  while (high - low.s.length() > tolerance) {
    result.at = low;
    result.at.slide_to(low.s.length() + 0.5 * (high - low.s.length()));
    ++result.iterations;
    if (side_of(result.at.excess()) == side) {
      low = result.at;
    } else {
      high = result.at.s.length();
    }
  }
  return result;
}

/// The sliding segment and what it has met.
class Sweep {
 public:
  Sweep(const Path& path, const Preprocessed& preprocessed, const Problem& problem, const Options& options,
        Result& result)
      : result_(result),
        path_(path),
        record_(options.record),
        perimeter_(preprocessed.loop.length),
        reset_amount_(options.reset * perimeter_),
        pair_(first_pair(preprocessed, problem)),
        modes_(path, preprocessed, pair_),
        rule_(limit_rule(options.limit, options.reset, options.iterations, perimeter_)),
        rounding_of_integral_(kIntegralRounding * (preprocessed.variation + std::fabs(problem.integral))),
        escape_amount_(reset_amount_) {
    result_.steps.start = tally_.steps;
  }

  void run() {
    start();
    while (pair_.s.length() < modes_.sweep_end()) {
      const Mode mode = modes_.at(pair_);
      if (mode.mixed()) {
        cross_mixed(mode);
      } else {
        march_same_signs(mode);
      }
    }
    finish();
  }

 private:
  /// s_0 = 0 and t_0 = sigma(s_0): the paper's m steps, from the last sign change before t_0.
  Pair first_pair(const Preprocessed& preprocessed, const Problem& problem) {
    Pair pair{Walker(path_, preprocessed.front, tally_), Walker(path_, preprocessed.front, tally_), problem};
    for (const SignChange& change : preprocessed.changes) {
      if (change.at.here.length <= problem.length) pair.t.jump(change.at);
    }
    pair.t.to_length(problem.length);
    return pair;
  }

  void start() {
    side_ = side_of(pair_.excess());
    if (!root_here()) return;
    note_boundary();
    reset();
  }

  /// Convex-convex and concave-concave: Cases 1 and 2 to the next root or to the mode's end.
  void march_same_signs(const Mode& mode) {
    sequence_.clear();
    const Found found = case_of(pair_, mode);
    const Approach approach = alternate(pair_, mode, rule_, record_ ? &sequence_ : nullptr);
    result_.iterations += approach.iterations;
    if (approach.end == Approach::End::limit) {
      note(pair_, approach, found);
      reset();
    } else if (approach.end == Approach::End::exit) {
      mode.finish(pair_);
      arrive();
    } else {
      escape(approach.iterations);
    }
  }

  /// Convex-concave and concave-convex: phi' = g(t) - g(s) has one sign, so phi is monotone up to the mode's end.
  void cross_mixed(const Mode& mode) {
    sequence_.clear();
    const Pair first = pair_;
    mode.finish(pair_);
    if (side_of(pair_.excess()) == side_of(first.excess())) return arrive();

    const Bisected root = bisect(first, pair_.s.length(), rule_.tolerance, bisection_tally_);
    result_.iterations += root.iterations;
    note(root.at, {Approach::End::limit, root.iterations, 0, rule_.tolerance}, Found::bisection);
    side_ = side_of(pair_.excess());
  }

  /// The side of phi - C at a mode's end. It has changed on the way only if the root lies there, within rounding.
  void arrive() {
    const int side = side_of(pair_.excess());
    if (side != side_) note_boundary();
    side_ = side;
  }

  /// Whether a root lies at the pair's place or within the limit's tolerance of it.
  bool root_here() const {
    return std::fabs(pair_.excess()) <= std::fmax(rounding_of_integral_, std::fabs(pair_.slope()) * rule_.tolerance);
  }

  void finish() {
    if (!path_.closed() && root_here()) note_boundary();
    std::vector<Segment>& segments = result_.segments;
    if (path_.closed() && segments.size() > 1) {  // s = P is s = 0 again
      const double gap = segments.front().start + modes_.sweep_end() - segments.back().start;
      if (gap <= kSameRoot * rule_.tolerance) {
        segments.pop_back();
        ++result_.found_again;
      }
    }
    result_.steps.marching = tally_.steps - result_.steps.start;
    result_.steps.bisection = bisection_tally_.steps;
    result_.steps.landings = tally_.landings + bisection_tally_.landings;
    result_.steps.refinements = tally_.refinements + bisection_tally_.refinements;
  }

  void note_boundary() {
    note(pair_, {Approach::End::limit, 0, 0, std::fabs(pair_.excess() / pair_.slope())}, Found::boundary);
  }

  void note(const Pair& at, const Approach& approach, Found found) {
    std::vector<Segment>& segments = result_.segments;
    const double start = at.s.length();
    if (!segments.empty() && start - segments.back().start <= kSameRoot * rule_.tolerance) {
      ++result_.found_again;
      segments.pop_back();  // the march is nearer to the root now
    }
    segments.push_back({start, at.t.length(), std::fabs(at.excess()), approach.error, approach.rate,
                        approach.iterations, found, sequence_});
    escape_amount_ = reset_amount_;
  }

  /// "Reset s_0 to be the sum of a very small positive amount and s_i for large enough i." Beyond a root phi - C has
  /// the sign of phi' at the root. If it has not, and moves on away from zero, then another root was passed with it.
  void reset() {
    const double from = pair_.s.length();
    const int expected = side_of(pair_.slope());
    pair_.slide_to(std::min(from + reset_amount_, modes_.sweep_end()));
    side_ = side_of(pair_.excess());
    const bool tells = std::fabs(pair_.excess()) > rounding_of_integral_;
    if (tells && side_ != expected && pair_.excess() * pair_.slope() > 0) {
      result_.doubts.push_back({Doubt::Why::jumped, {from, pair_.s.length()}, 0, std::fabs(pair_.excess())});
    }
  }

  /// A limit that is not reached: a double root, two roots close together, or a near miss. Resets by doubling amounts
  /// until phi - C has changed its sign or moves away from zero, and says so. Without a find in between the next escape
  /// goes on with the doubling: where phi is almost C everywhere, a near symmetry, limit after limit is out of reach.
  void escape(std::size_t iterations) {
    Doubt doubt{Doubt::Why::slow, {pair_.s.length(), pair_.s.length()}, iterations, std::fabs(pair_.excess())};
    bool flat = doubt.residual <= rounding_of_integral_;
    bool past = false;
    for (; !past && pair_.s.length() < modes_.sweep_end(); escape_amount_ *= 2) {
      pair_.slide_to(std::min(pair_.s.length() + escape_amount_, modes_.sweep_end()));
      const double excess = pair_.excess();
      const bool tells = std::fabs(excess) > rounding_of_integral_;
      flat = flat && !tells;
      past = tells && (side_of(excess) != side_ || excess * pair_.slope() > 0);
      if (flat && pair_.s.length() - doubt.where.lo > kContinuum * perimeter_) {
        throw Refusal(Reason::continuum, doubt.where.lo,
                      fmt::format("march: expected isolated segments, found that every start from s = {:.17g} to "
                                  "s = {:.17g} at least fits; rollfix::locate reports such stretches",
                                  doubt.where.lo, pair_.s.length()));
      }
    }
    doubt.where.hi = pair_.s.length();
    side_ = side_of(pair_.excess());
    result_.doubts.push_back(doubt);
  }

  Result& result_;
  const Path& path_;
  bool record_;
  double perimeter_;
  double reset_amount_;
  Tally tally_;
  Tally bisection_tally_;
  Pair pair_;
  Modes modes_;
  LimitRule rule_;
  double rounding_of_integral_;  // |phi - C| below this can't be told from zero
  double escape_amount_;         // by which the next escape begins
  int side_ = 1;                 // of phi - C at the pair's last place
  std::vector<Iterate> sequence_;
};

}  // namespace

void sweep(const Path& path, const Preprocessed& preprocessed, const Problem& problem, const Options& options,
           Result& result) {
  Sweep(path, preprocessed, problem, options, result).run();
}

}  // namespace rollfix::march
