#include "rollfix/locate/march/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "locate/march/limits.hpp"
#include "rollfix/locate/march/bisection.hpp"
#include "rollfix/locate/march/refusal.hpp"

namespace rollfix::march {

namespace {

/// Rounding errors of phi - C, as a part of the density's variation plus |C|.
constexpr double kIntegralRounding = 1e-14;
/// Two finds of one root differ by the estimated distances to it: by no more than this many limit tolerances.
constexpr double kSameRoot = 4;

}  // namespace

Sweep::Sweep(const Path& path, const Preprocessed& preprocessed, const Problem& problem, const Options& options)
    : path_(path),
      preprocessed_(preprocessed),
      options_(options),
      pair_(first_pair(problem)),
      modes_(path, preprocessed, pair_),
      escape_amount_(options.reset * preprocessed.loop.length) {
  const double perimeter = preprocessed.loop.length;
  const double tolerance = options.limit * perimeter;
  const double loosest = std::fmax(tolerance, kPartOfReset * options.reset * perimeter);
  rule_ = {tolerance, kLengthRounding * perimeter, loosest, options.iterations};
  rounding_of_integral_ = kIntegralRounding * (preprocessed.variation + std::fabs(problem.integral));
  result_.steps.start = tally_.steps;
}

/// s_0 = 0 and t_0 = sigma(s_0): the paper's m steps, from the last sign change before t_0.
Pair Sweep::first_pair(const Problem& problem) {
  Pair pair{Walker(path_, preprocessed_.front, tally_), Walker(path_, preprocessed_.front, tally_), problem};
  for (const SignChange& change : preprocessed_.changes) {
    if (change.at.here.length <= problem.length) pair.t.jump(change.at);
  }
  pair.t.to_length(problem.length);
  return pair;
}

Result Sweep::run() {
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
  return std::move(result_);
}

/// Convex-convex and concave-concave: Cases 1 and 2 to the next root or to the mode's end.
void Sweep::march_same_signs(const Mode& mode) {
  sequence_.clear();
  const Alternation found = alternate(pair_, mode, rule_, options_.record ? &sequence_ : nullptr);
  result_.iterations += found.iterations;
  switch (found.end) {
    case Alternation::End::limit:
      note(pair_, found);
      reset();
      break;
    case Alternation::End::mode_end:
      mode.finish(pair_);
      arrive();
      break;
    case Alternation::End::stalled:
      escape(found.iterations);
      break;
  }
}

/// Convex-concave and concave-convex: phi' = g(t) - g(s) has one sign, so phi is monotone up to the mode's end.
void Sweep::cross_mixed(const Mode& mode) {
  sequence_.clear();
  const Pair first = pair_;
  mode.finish(pair_);
  if (side_of(pair_.excess()) == side_of(first.excess())) return arrive();

  const Bisected root = bisect(first, pair_.s.length(), rule_.tolerance, bisection_tally_);
  result_.iterations += root.iterations;
  note(root.at, {Alternation::End::limit, Found::bisection, root.iterations, 0, rule_.tolerance});
  side_ = side_of(pair_.excess());
}

/// The side of phi - C at a mode's end. It has changed on the way only if the root lies there, within rounding.
void Sweep::arrive() {
  const int side = side_of(pair_.excess());
  if (side != side_) note_boundary();
  side_ = side;
}

/// Whether a root lies at the pair's place or within the limit's tolerance of it.
bool Sweep::root_here() const {
  return std::fabs(pair_.excess()) <= std::fmax(rounding_of_integral_, std::fabs(pair_.slope()) * rule_.tolerance);
}

void Sweep::start() {
  side_ = side_of(pair_.excess());
  if (!root_here()) return;
  note_boundary();
  reset();
}

void Sweep::finish() {
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

void Sweep::note_boundary() {
  note(pair_, {Alternation::End::limit, Found::boundary, 0, 0, std::fabs(pair_.excess() / pair_.slope())});
}

void Sweep::note(const Pair& at, const Alternation& found) {
  Segment segment;
  segment.start = at.s.length();
  segment.end = at.t.length();
  segment.integral_error = std::fabs(at.excess());
  segment.error = found.error;
  segment.rate = found.rate;
  segment.iterations = found.iterations;
  segment.found = found.found;
  segment.sequence = sequence_;
  std::vector<Segment>& segments = result_.segments;
  const bool again = !segments.empty() && segment.start - segments.back().start <= kSameRoot * rule_.tolerance;
  if (again) {
    ++result_.found_again;
    segments.pop_back();  // the march is nearer to the root now
  }
  segments.push_back(std::move(segment));
  escape_amount_ = options_.reset * preprocessed_.loop.length;
}

/// "Reset s_0 to be the sum of a very small positive amount and s_i for large enough i." Beyond a root phi - C has the
/// sign of phi' at the root. If it has not, and moves on away from zero, then another root was passed with it.
void Sweep::reset() {
  const double from = pair_.s.length();
  const int expected = side_of(pair_.slope());
  pair_.slide_to(std::min(from + options_.reset * preprocessed_.loop.length, modes_.sweep_end()));
  side_ = side_of(pair_.excess());
  const bool tells = std::fabs(pair_.excess()) > rounding_of_integral_;
  if (tells && side_ != expected && pair_.excess() * pair_.slope() > 0) {
    result_.doubts.push_back({Doubt::Why::jumped, {from, pair_.s.length()}, 0, std::fabs(pair_.excess())});
  }
}

/// A limit that is not reached: a double root, two roots close together, or a near miss. Resets by doubling amounts
/// until phi - C has changed its sign or moves away from zero, and says so. Without a find in between the next escape
/// goes on with the doubling: where phi is almost C everywhere, a near symmetry, limit after limit is out of reach.
void Sweep::escape(std::size_t iterations) {
  const double perimeter = preprocessed_.loop.length;
  Doubt doubt{Doubt::Why::slow, {pair_.s.length(), pair_.s.length()}, iterations, std::fabs(pair_.excess())};
  bool flat = doubt.residual <= rounding_of_integral_;
  bool past = false;
  for (; !past && pair_.s.length() < modes_.sweep_end(); escape_amount_ *= 2) {
    pair_.slide_to(std::min(pair_.s.length() + escape_amount_, modes_.sweep_end()));
    const double excess = pair_.excess();
    const bool tells = std::fabs(excess) > rounding_of_integral_;
    flat = flat && !tells;
    past = tells && (side_of(excess) != side_ || excess * pair_.slope() > 0);
    if (flat && pair_.s.length() - doubt.where.lo > kContinuum * perimeter) {
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

}  // namespace rollfix::march
