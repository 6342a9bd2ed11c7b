#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "rollfix/march.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/paper/claim.hpp"
#include "rollfix/part.hpp"

// What the paper says of one finger, computed again and compared.
// Notation:
//   a, b            start and end of a segment that fits: `root`, `root` + L; s_i, t_i: the march's sequences
//   Phi(s, t)       `turn_of`, by the turning function, which the march does not know
//   T / h           steps of one loop: `steps_per_loop`; m: steps until t_0
//   z_k             inflections: `breakpoints`; sigma(s) = s + L
// Follows the paper (Jia, IROS 2001), sections 2.1 and 2.2: Lemmas 1 and 2, Theorems 4 and 5, Figures 2, 3 and 7.
// docs/march.md has the results.
// Idea: questions with a known answer are planted on gallery parts; the march answers them and counts its steps and
// rounds; the turning function, built in another way, tells whether its claims hold.
namespace rollfix::app {
namespace {

constexpr std::array<const char*, 3> kConvex = {"ellipse,a=2,b=1", "limacon,a=2.5,b=1", "cam"};
constexpr std::array<const char*, 3> kWavy = {"limacon,a=1.5,b=1", "spline,n=9,seed=7,wobble=0.2", "spline"};
/// T/h, roughly: the curves of an outline divide it.
constexpr std::array<int, 3> kStepsPerLoop = {128, 512, 2048};
/// Limits that take longer take no steps either.
constexpr std::size_t kRounds = 20000;

/// A question with a known answer, so that at least one segment fits; all numbers by the turning function, which the
/// march does not know.
struct Planted {
  double length = 0;  // L
  double turn = 0;    // theta = Phi of the roll that was planted, radians
};

/// Phi(s, s + length), radians.
double turn_of(const Part& part, double s, double length) {
  return part.turning().angle(s + length) - part.turning().angle(s);
}

/// Four lengths times three starts, as shares of the perimeter.
std::vector<Planted> planted_on(const Part& part) {
  std::vector<Planted> questions;
  for (const double length : {0.13, 0.29, 0.57, 0.81}) {
    for (const double start : {0.11, 0.47, 0.76}) {
      const double roll = length * part.perimeter();
      questions.push_back({roll, turn_of(part, start * part.perimeter(), roll)});
    }
  }
  return questions;
}

/// The step h that divides the parameters of all curves into about so many.
march::Options with_steps(const Outline& outline, int steps) {
  double range = 0;  // the paper's T
  for (const Curve& curve : outline.curves) range += curve.domain().width();
  march::Options options;
  options.step = range / steps;
  options.iterations = kRounds;
  return options;
}

/// The largest counts, in parts of T/h.
struct Counts {
  std::size_t runs = 0;
  double start = 0;     // the paper's m
  double marching = 0;  // by s and t
  double total = 0;
  double exponent = 0;  // the total's growth with T/h: furthest from 1
};

/// Runs each planted question with each step length. The growth of the total is its exponent between the coarsest and
/// the finest step: 1 if it is linear in T / h.
template <class Shapes>
Counts count_steps(const Shapes& shapes) {
  Counts most;
  for (const char* shape : shapes) {
    const Outline outline = gallery(shape);
    std::vector<std::pair<double, double>> ends;  // of each question: log T/h and log total at the coarsest step
    for (const int steps : kStepsPerLoop) {
      const march::March prepared(outline, march::curvature_density(), with_steps(outline, steps));
      const std::vector<Planted> questions = planted_on(Part(outline));
      for (std::size_t i = 0; i < questions.size(); ++i) {
        const march::Result result = prepared.segments(questions[i].length, questions[i].turn);
        const auto loop = static_cast<double>(result.steps_per_loop);
        const auto total = static_cast<double>(result.steps.total());
        ++most.runs;
        most.start = std::max(most.start, static_cast<double>(result.steps.start) / loop);
        most.marching = std::max(most.marching, static_cast<double>(result.steps.marching) / loop);
        most.total = std::max(most.total, total / loop);
        // Kept until the same question comes with the finest step.
        if (steps == kStepsPerLoop.front()) ends.emplace_back(std::log(loop), std::log(total));
        if (steps != kStepsPerLoop.back()) continue;
        const double exponent = (std::log(total) - ends[i].second) / (std::log(loop) - ends[i].first);
        if (most.exponent == 0 || std::fabs(exponent - 1) > std::fabs(most.exponent - 1)) most.exponent = exponent;
      }
    }
  }
  return most;
}

/// Convex parts: largest counts of the marches, as multiples of T / h.
Claim theorem_4() {
  const Counts most = count_steps(kConvex);
  return {"Theorem 4",
          "convex: s and t at most 2 T/h steps, t_0 at most T/h",
          fmt::format("at most {:.3f} T/h and {:.3f} T/h, {} runs", most.marching, most.start, most.runs),
          most.marching <= 2 && most.start <= 1,
          {{"runs", most.runs}, {"marching", most.marching}, {"start", most.start}}};
}

/// Parts with inflections: the total of all steps, and its growth.
void add_theorem_5(std::vector<Claim>& claims) {
  constexpr double kLinear = 0.05;  // a step more or less at the coarsest h
  const Counts most = count_steps(kWavy);
  claims.push_back({"Theorem 5",
                    "any boundary: at most 5 T/h steps in all",
                    fmt::format("at most {:.3f} T/h, {} runs", most.total, most.runs),
                    most.total <= 5,
                    {{"runs", most.runs}, {"total", most.total}}});
  claims.push_back(
      {"Theorem 5",
       "linear in T/h",
       fmt::format("its power {:.3f}, from T/h = {} to {}", most.exponent, kStepsPerLoop.front(), kStepsPerLoop.back()),
       std::fabs(most.exponent - 1) < kLinear,
       {{"exponent", most.exponent}}});
}

/// A march with its sequences, and what is true of the place that they tend to.
struct Limit {
  march::Segment segment;
  double root = 0;  // by Newton's iteration on the turning function
  double rate = 0;  // kappa(a) / kappa(b), or its inverse, by the turning function
};

/// The limit of a march by three Newton steps on f(s) = Phi(s, s + L) - theta, from where the march ended; the rate of
/// Lemma 2 by the curvatures there.
Limit limit_of(const Part& part, const Planted& asked, const march::Segment& segment) {
  const auto curvature = [&](double s) { return part.turning().curvature(s); };
  Limit limit{segment, segment.start, 0};
  for (int i = 0; i < 3; ++i) {
    const double slope = curvature(limit.root + asked.length) - curvature(limit.root);
    limit.root -= (turn_of(part, limit.root, asked.length) - asked.turn) / slope;
  }
  // Case 1 converges by kappa(a) / kappa(b), Case 2 by its inverse.
  const double ratio = curvature(limit.root) / curvature(limit.root + asked.length);
  limit.rate = segment.found == march::Found::case_1 ? ratio : 1 / ratio;
  return limit;
}

/// By how much the error shrinks in a round, where it is small and rounding does not matter yet.
/// The geometric mean of the ratios of successive errors, between two sizes of the error; nothing where rounds are few.
std::optional<double> measured_rate(const Limit& limit, double perimeter) {
  constexpr double kFrom = 1e-4, kTo = 1e-9;
  constexpr std::size_t kFewest = 8;  // rounds that tell a rate
  std::vector<double> errors;
  for (const march::Iterate& iterate : limit.segment.sequence) {
    const double error = (limit.root - iterate.start) / perimeter;
    if (error < kFrom && error > kTo) errors.push_back(error);
  }
  if (errors.size() < kFewest) return std::nullopt;
  return std::pow(errors.back() / errors.front(), 1.0 / static_cast<double>(errors.size() - 1));
}

/// What the rounds of Cases 1 and 2 look like: Figure 2 and Lemmas 1 and 2.
struct Rounds {
  std::array<std::size_t, 2> rounds{};    // by case
  std::array<std::size_t, 2> as_drawn{};  // those that are as in Figure 2
  std::array<double, 2> off{};            // largest error of the equation that holds there
  std::size_t limits = 0;                 // with a measured rate
  double fastest = 1, slowest = 0;        // rates
  double rate_error = 0;                  // of the measured rate, the largest
  bool rising = true;                     // s_i < s_{i+1} < a

  /// One march's rounds: how many are as drawn, and the largest error of the equation that they keep.
  void take(const Part& part, const Planted& asked, const Limit& limit) {
    const bool first_case = limit.segment.found == march::Found::case_1;
    const std::size_t k = first_case ? 0 : 1;
    const double rounding = 1e-11 * part.perimeter();
    double before = -part.perimeter();
    for (const march::Iterate& at : limit.segment.sequence) {
      // Phi(s_i, t_i) - theta is 0 in Case 1, l(s_i, t_i) - L in Case 2; the other one is above 0 until the limit.
      const double turn = part.turning().angle(at.end) - part.turning().angle(at.start) - asked.turn;
      const double length = at.end - at.start - asked.length;
      ++rounds[k];
      as_drawn[k] += (first_case ? length > -rounding : turn > -rounding) ? 1 : 0;
      off[k] = std::max(off[k], std::fabs(first_case ? turn : length));
      // Lemma 1.
      rising = rising && at.start > before && at.start < limit.root + rounding;
      before = at.start;
    }
    const std::optional<double> measured = measured_rate(limit, part.perimeter());
    if (!measured) return;
    ++limits;
    fastest = std::min(fastest, *measured);
    slowest = std::max(slowest, *measured);
    rate_error = std::max(rate_error, std::fabs(*measured - limit.rate));
  }
};

/// Marches on convex parts with their sequences recorded.
void add_rounds(std::vector<Claim>& claims) {
  constexpr double kSameRate = 1e-3;  // the rate of a finite error is not that of the limit
  constexpr double kHolds = 1e-10;
  Rounds seen;
  for (const char* shape : kConvex) {
    const Part part(gallery(shape));
    march::Options options;
    options.record = true;
    options.iterations = kRounds;
    const march::March prepared(part.outline(), march::curvature_density(), options);
    for (const Planted& asked : planted_on(part)) {
      for (const march::Segment& segment : prepared.segments(asked.length, asked.turn).segments) {
        if (!segment.sequence.empty()) seen.take(part, asked, limit_of(part, asked, segment));
      }
    }
  }
  claims.push_back({"Lemma 2",
                    "a round shrinks the error by kappa(a)/kappa(b)",
                    fmt::format("{} limits, {:.3f} to {:.3f}, off by {:.0e} at most", seen.limits, seen.fastest,
                                seen.slowest, seen.rate_error),
                    seen.rising && seen.limits > 0 && seen.rate_error < kSameRate,
                    {{"limits", seen.limits},
                     {"fastest", seen.fastest},
                     {"slowest", seen.slowest},
                     {"largest_error", seen.rate_error},
                     {"lemma_1_holds", seen.rising}}});
  const std::array<const char*, 2> drawn = {"case 1: Phi(s_i, t_i) = theta, l(s_i, t_i) > L",
                                            "case 2: l(s_i, t_i) = L, Phi(s_i, t_i) > theta"};
  for (std::size_t k = 0; k < 2; ++k) {
    claims.push_back({k == 0 ? "Figure 2a" : "Figure 2b",
                      drawn[k],
                      fmt::format("{} of {} rounds, = to {:.0e}", seen.as_drawn[k], seen.rounds[k], seen.off[k]),
                      seen.rounds[k] > 0 && seen.as_drawn[k] == seen.rounds[k] && seen.off[k] < kHolds,
                      {{"rounds", seen.rounds[k]}, {"as_drawn", seen.as_drawn[k]}, {"largest_error", seen.off[k]}}});
  }
}

/// Signs of the curvature at s and t: the paper's four modes.
using Signs = std::pair<bool, bool>;
constexpr bool kConvexSign = true, kConcaveSign = false;

/// What Figure 3 shows, counted over all marches.
struct Modes {
  std::map<Signs, std::size_t> met;
  std::size_t kept = 0;  // modes in which the curvatures keep their signs
  std::size_t all = 0;
  std::size_t as_drawn = 0;            // convex-convex, concave-convex, concave-concave one after the other
  std::array<std::size_t, 2> finds{};  // where the signs agree, where they differ
  std::array<std::size_t, 2> bisections{};
};

/// The modes end where s comes to a z_k or t to a z_{l+1}, whichever is first.
void slide(const Part& part, const std::vector<march::Breakpoint>& z, double length, Modes& modes) {
  std::vector<double> ends;
  for (const march::Breakpoint& point : z) {
    ends.push_back(point.s);
    // t = s + L comes to z there.
    ends.push_back(wrap(point.s - length, part.perimeter()).base);  // sigma^-1(z)
  }
  std::sort(ends.begin(), ends.end());
  std::vector<Signs> sequence;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const double end = i + 1 < ends.size() ? ends[i + 1] : ends.front() + part.perimeter();
    // At a share of the way through the mode: in its middle, and near both ends.
    const auto signs = [&](double share) {
      const double s = ends[i] + share * (end - ends[i]);
      return Signs(part.turning().curvature(s) > 0, part.turning().curvature(s + length) > 0);
    };
    sequence.push_back(signs(0.5));
    ++modes.all;
    ++modes.met[sequence.back()];
    modes.kept += signs(0.01) == sequence.back() && signs(0.99) == sequence.back() ? 1 : 0;
  }
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const auto at = [&](std::size_t k) { return sequence[(i + k) % sequence.size()]; };
    modes.as_drawn += at(0) == Signs(kConvexSign, kConvexSign) && at(1) == Signs(kConcaveSign, kConvexSign) &&
                              at(2) == Signs(kConcaveSign, kConcaveSign)
                          ? 1
                          : 0;
  }
}

/// Where the modes end, and which of them search by bisection.
void add_figure_3(std::vector<Claim>& claims) {
  Modes modes;
  for (const char* shape : kWavy) {
    const Part part(gallery(shape));
    march::Options options;
    options.iterations = kRounds;
    const march::March prepared(part.outline(), march::curvature_density(), options);
    for (const Planted& asked : planted_on(part)) {
      slide(part, prepared.breakpoints(), asked.length, modes);
      for (const march::Segment& segment : prepared.segments(asked.length, asked.turn).segments) {
        // Signs of kappa at start and end differ: convex-concave or concave-convex.
        const bool mixed = part.turning().curvature(segment.start) * part.turning().curvature(segment.end) < 0;
        ++modes.finds[mixed ? 1 : 0];
        modes.bisections[mixed ? 1 : 0] += segment.found == march::Found::bisection ? 1 : 0;
      }
    }
  }
  claims.push_back(
      {"Figure 3",
       "a mode ends at s = min(z_k, sigma^-1(z_l+1))",
       fmt::format("{} of {} modes, {} kinds; (b) after (a) {} times", modes.kept, modes.all, modes.met.size(),
                   modes.as_drawn),
       modes.kept == modes.all && modes.met.size() == 4 && modes.as_drawn > 0,
       {{"modes", modes.all}, {"signs_kept", modes.kept}, {"kinds", modes.met.size()}, {"as_drawn", modes.as_drawn}}});
  claims.push_back({"Figure 3",
                    "bisection where the signs differ, else the march",
                    fmt::format("{} of {} by bisection there, {} of {} elsewhere", modes.bisections[1], modes.finds[1],
                                modes.bisections[0], modes.finds[0]),
                    modes.finds[1] > 0 && modes.bisections[1] == modes.finds[1] && modes.bisections[0] == 0,
                    {{"mixed", modes.finds[1]},
                     {"mixed_by_bisection", modes.bisections[1]},
                     {"same", modes.finds[0]},
                     {"same_by_bisection", modes.bisections[0]}}});
}

/// The roll of `rollfix demo`: from a to b, and on to c.
void add_figure_7(std::vector<Claim>& claims) {
  constexpr double kStart = 6.2, kToB = 1.0, kOnToC = 0.95;
  constexpr double kFits = 1e-6;  // radians
  const Part part(gallery("spline,n=9,seed=7,wobble=0.2"));
  const march::Result at_b = march::locate(part.outline(), {kToB, turn_of(part, kStart, kToB)});
  // The second roll's turn, which the march at b has not been told.
  const double further = turn_of(part, kStart + kToB, kOnToC);
  const auto left = std::count_if(at_b.segments.begin(), at_b.segments.end(), [&](const march::Segment& segment) {
    return std::fabs(turn_of(part, segment.end, kOnToC) - further) < kFits;
  });
  claims.push_back({"Figure 7",
                    "six segments on a spline, one after rolling on",
                    fmt::format("{} segments, then {}", at_b.segments.size(), left),
                    at_b.complete() && at_b.segments.size() == 6 && left == 1,
                    {{"segments", at_b.segments.size()}, {"left", left}}});
}

}  // namespace

/// In the order in which the program prints them.
void add_one_finger_claims(std::vector<Claim>& claims) {
  add_rounds(claims);
  claims.push_back(theorem_4());
  add_theorem_5(claims);
  add_figure_3(claims);
  add_figure_7(claims);
}

}  // namespace rollfix::app
