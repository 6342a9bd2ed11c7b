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
// section 2.1 (march.cpp). Different: phi is monotone, and bisection finds its one root or none. Theorem 5 counts
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
    // A closed sweep ends where it began, one loop on: both last places are known without a step.
    if (closed_) {
      sweep_end_ = loop_.length;
      last_s_ = first.s.position().moved_by(loop_);
      last_t_ = first.t.position().moved_by(loop_);
    } else {
      // An open one ends with t at the outline's end. L = P leaves the one start s = 0.
      sweep_end_ = std::max(0.0, loop_.length - segment_length_);
      last_t_ = preprocessed.back;
    }
  }

  /// The last start s of the sweep, arc length: P when closed, P - L when open.
  double sweep_end() const { return sweep_end_; }

  /// The mode in which the pair is now.
  Mode at(const Pair& pair) {
    // Both numbers only grow: over the whole sweep each sign change is passed once by s and once by t.
    pass(next_s_, pair.s.length());
    pass(next_t_, pair.t.length());

    Mode mode;
    // g keeps its sign from one sign change to the next: it is the sign after the last one passed.
    mode.sign_s = sign_before(next_s_);
    mode.sign_t = sign_before(next_t_);
    const bool s_may_end = exists(next_s_);
    const bool t_may_end = exists(next_t_);
    const double s_sign_change = s_may_end ? length_of(next_s_) : sweep_end_;                    // z_k
    const double t_sign_change = t_may_end ? length_of(next_t_) - segment_length_ : sweep_end_;  // sigma^-1(z_{l+1})
    mode.s_end = std::min({s_sign_change, t_sign_change, sweep_end_});  // Figure 3: min(z_k, sigma^-1(z_{l+1}))
    mode.t_end = mode.s_end + segment_length_;                          // sigma(s)
    // The copies make the jumps to z_k and z_{l+1} free of steps, and exact: no landing is needed there.
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
  /// Whether the density changes its sign once more. On a closed outline the numbers never end, if there is any.
  bool exists(std::size_t number) const { return closed_ ? !changes_.empty() : number < changes_.size(); }

  /// Length and integral of the whole loops that a sign change's number stands for.
  Span loops_before(std::size_t number) const {
    const std::size_t loops = number / changes_.size();
    return loop_ * static_cast<double>(loops);
  }

  /// A sign change as a place, with the sums that an endpoint has when it comes there.
  Position position_of(std::size_t number) const {
    return changes_[number % changes_.size()].at.moved_by(loops_before(number));
  }

  /// Its arc length from s = 0, whole loops included.
  double length_of(std::size_t number) const {
    return changes_[number % changes_.size()].at.here.length + loops_before(number).length;
  }

  /// The sign of g between the sign change before this one and this one.
  int sign_before(std::size_t number) const {
    return number == 0 ? first_sign_ : changes_[(number - 1) % changes_.size()].sign_after;
  }

  /// Moves `next` to the first sign change that lies ahead of `length`.
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
  // At each turn: the root lies in (low.s, high], phi - C has the sign `side` at low, and `low` is a pair that can go
  // on.
  Pair low{start.s.counted_by(tally), start.t.counted_by(tally), start.problem};
  const int side = side_of(low.excess());
  Bisected result{low, 0};
  while (high - low.s.length() > tolerance) {
    result.at = low;
    // From a copy of the lower end, so that no endpoint backs up: the ways are 1/2, 1/4, ... of the mode.
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

  /// From s = 0 to the sweep's end, mode by mode. At each turn every root behind the pair is noted, up to the reset
  /// amount and to what a doubt names, and `side_` is the sign of phi - C at the pair.
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

  /// A root at s = 0 belongs to no mode's inside: it is noted here, and left by a reset.
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
    // The pair goes to the mode's end at once; the copy at its beginning is for the bisection.
    const Pair first = pair_;
    mode.finish(pair_);
    // phi is monotone on the mode: equal signs at both ends, no root between.
    if (side_of(pair_.excess()) == side_of(first.excess())) return arrive();

    const Bisected root = bisect(first, pair_.s.length(), rule_.tolerance, bisection_tally_);
    result_.iterations += root.iterations;
    // `pair_` stands at the mode's end already, beyond the root: no reset is needed.
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
    // phi is within |phi'| times the tolerance of C if it is straight that far; at phi' = 0 rounding decides.
    return std::fabs(pair_.excess()) <= std::fmax(rounding_of_integral_, std::fabs(pair_.slope()) * rule_.tolerance);
  }

  /// The sweep's last place, and the counts. On an open outline a root at its end is noted: no mode follows to do so.
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

  /// The pair's place as a root, off by one Newton step: |phi - C| / |phi'|.
  void note_boundary() {
    note(pair_, {Approach::End::limit, 0, 0, std::fabs(pair_.excess() / pair_.slope())}, Found::boundary);
  }

  /// Adds a segment. Starts are met in increasing order, so that only the last one can be the same root.
  void note(const Pair& at, const Approach& approach, Found found) {
    std::vector<Segment>& segments = result_.segments;
    const double start = at.s.length();
    if (!segments.empty() && start - segments.back().start <= kSameRoot * rule_.tolerance) {
      ++result_.found_again;
      segments.pop_back();  // the march is nearer to the root now
    }
    segments.push_back({start, at.t.length(), std::fabs(at.excess()), approach.error, approach.rate,
                        approach.iterations, found, sequence_});
    // A find ends a series of limits out of reach: the next escape begins small again.
    escape_amount_ = reset_amount_;
  }

  /// "Reset s_0 to be the sum of a very small positive amount and s_i for large enough i." Beyond a root phi - C has
  /// the sign of phi' at the root. If it has not, and moves on away from zero, then another root was passed with it.
  void reset() {
    const double from = pair_.s.length();
    const int expected = side_of(pair_.slope());
    pair_.slide_to(std::min(from + reset_amount_, modes_.sweep_end()));
    side_ = side_of(pair_.excess());
    // Two signs are compared only where rounding does not decide them.
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
    // `flat`: phi = C to rounding at all places so far. `past`: the pair is beyond what made the march slow.
    bool flat = doubt.residual <= rounding_of_integral_;
    bool past = false;
    for (; !past && pair_.s.length() < modes_.sweep_end(); escape_amount_ *= 2) {
      pair_.slide_to(std::min(pair_.s.length() + escape_amount_, modes_.sweep_end()));
      const double excess = pair_.excess();
      const bool tells = std::fabs(excess) > rounding_of_integral_;
      flat = flat && !tells;
      // (phi - C) phi' > 0: |phi - C| grows with s, so that the near miss lies behind.
      past = tells && (side_of(excess) != side_ || excess * pair_.slope() > 0);
      if (flat && pair_.s.length() - doubt.where.lo > kContinuum * perimeter_) {
        throw Refusal(Reason::continuum, doubt.where.lo,
                      fmt::format("march: expected isolated segments, found that every start from s = {:.17g} to "
                                  "s = {:.17g} at least fits; rollfix::locate reports such stretches",
                                  doubt.where.lo, pair_.s.length()));
      }
    }
    // Roots between where.lo and where.hi may be missing from the answer.
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
