#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "march/pairs.hpp"
#include "rollfix/march.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/paper/claim.hpp"
#include "rollfix/part.hpp"

// What the paper says of two fingers, computed again and compared.
// Notation:
//   phi_1, phi_2    total curvatures of finger a's two rolls from s
//   phi_3, phi_4    of finger b's from t, here with theta_1 and theta_2 added: (8) is phi_1 = phi_3, (9) phi_2 = phi_4
//   [a_i, a_i+1]    intervals on which phi_1 and phi_2 are monotone: `a.intervals`; [b_j, b_j+1]: `b.intervals`
//   x, y; w, z      ends of s and of t between which (8) pairs them: march::Correspondence
// Follows the paper (Jia, IROS 2001), sections 3.1, 3.2 and 4: Figures 5, 6 and 8. docs/march.md, "x, y, w, z".
// Idea: the march's intervals and iterations are looked at one by one, and the turning function tells whether they are
// as the figures show them.
namespace rollfix::app {
namespace {

/// A roll of both fingers, and by how much their turns differ: (8) or (9).
struct Rolls {
  double a = 0;     // length of finger a's roll
  double b = 0;     // of finger b's
  double turn = 0;  // theta, radians
};

/// A part and rolls with the paper's theta_1 and theta_2 and its numbers of intervals:
/// examples/studies/figure8_search.cpp.
constexpr const char* kPart = "spline,n=9,seed=7,wobble=0.2";
constexpr Rolls kFirst{0.58, 0.94, -0.725248}, kSecond{1.01, 1.92, -1.99849}, kThird{1.25, 2.37, -1.966238};
constexpr double kHolds = 1e-10;  // radians: what march and turning function may differ by

/// Phi(s, s + length), radians.
double phi(const Part& part, double s, double length) {
  return part.turning().angle(s + length) - part.turning().angle(s);
}

/// The pairs of monotone intervals of section 3.2, and the turning function, which the march does not know.
struct Section3 {
  Section3(const Part& on, const Rolls& one, const Rolls& two)
      : part(on), first(one), second(two), rolls_a{{one.a, two.a}, {}}, rolls_b{{one.b, two.b}, {}} {}
  Section3(const Section3&) = delete;
  Section3& operator=(const Section3&) = delete;

  Part part;
  Rolls first, second;
  march::Segments rolls_a, rolls_b;
  march::PairProblem problem{{first.turn, second.turn}, 1e-13};
  march::March rate{part.outline(), march::curvature_rate_density()};
  march::Path path{part.outline(), march::curvature_density(), 0};
  march::Tally tally;
  march::PairSteps steps;
  march::Partition a = divide({path, rate, part.perimeter()}, rolls_a, tally, steps);
  march::Partition b = divide({path, rate, part.perimeter()}, rolls_b, tally, steps);

  double phi_1(double s) const { return phi(part, s, first.a); }
  double phi_2(double s) const { return phi(part, s, second.a); }
  double phi_3(double t) const { return phi(part, t, first.b) + first.turn; }    // and theta_1
  double phi_4(double t) const { return phi(part, t, second.b) + second.turn; }  // and theta_2

  /// All n m pairs of intervals, with their correspondence; none where the values of phi_1 and phi_3 do not meet.
  template <class Look>
  void each(const Look& look) {
    for (const march::MonotoneInterval& i : a.intervals) {
      for (const march::MonotoneInterval& j : b.intervals) look(i, j, correspond(i, j, problem, tally));
    }
  }
};

/// phi_1 falls, phi_3 rises, and the values overlap as they are drawn.
struct Figure5 {
  std::size_t drawn = 0, agree = 0, rectangles = 0, rejected = 0;
  double off = 0;  // of (8)

  /// Counts the pairs of intervals that are as in the figure, and of them those whose x and z are as drawn.
  void take(Section3& section) {
    section.each([&](const auto& i, const auto& j, const auto& way) {
      ++rectangles;
      rejected += way ? 0 : 1;
      const double a = i.lo.s(), a_next = i.hi.s(), b = j.lo.s(), b_next = j.hi.s();
      // The figure has phi_1 falling and phi_3 rising.
      if (!way || i.trend[0] > 0 || j.trend[0] < 0) return;
      if (section.phi_1(a_next) <= section.phi_3(b) || section.phi_1(a) <= section.phi_3(b_next)) return;
      ++drawn;
      agree += way->x() == a_next && way->z() == b_next && way->x() > way->y() && way->w() < way->z() ? 1 : 0;
      for (const auto& [s, t] : {std::pair(way->x(), way->w()), std::pair(way->y(), way->z())}) {
        off = std::max(off, std::fabs(section.phi_1(s) - section.phi_3(t)));
      }
    });
  }

  /// As the program prints it.
  Claim claim() const {
    return {"Figure 5",
            "s from x = a_i+1 to y, t from w to z = b_j+1",
            fmt::format("{} of {} cases, (8) to {:.0e}; {} of {} rejected", agree, drawn, off, rejected, rectangles),
            drawn > 0 && agree == drawn && off < kHolds,
            {{"cases", drawn},
             {"agree", agree},
             {"largest_error", off},
             {"rectangles", rectangles},
             {"rejected", rejected}}};
  }
};

/// One iteration of Figure 6, a round at a time.
struct Iteration {
  std::size_t rounds = 0;
  bool reached = false;
  bool forward = true;  // neither s nor t ever turns back
  double off = 0;       // (9) where it ends
};

/// One round at a time until it reaches its limit, or s or t leaves its interval.
Iteration follow(const Section3& section, const march::Correspondence& way, march::StartsOfBoth at) {
  constexpr std::size_t kMostRounds = 20000;
  const double perimeter = section.part.perimeter();
  const march::LimitRule one_round{1e-11 * perimeter, 4e-15 * perimeter, 1e-9 * perimeter, 1};
  Iteration seen;
  while (!seen.reached && seen.rounds < kMostRounds) {
    const double s = at.a.s(), t = at.b.s();
    const march::Approach round = iterate(at, way, one_round);
    if (round.end == march::Approach::End::exit) break;
    ++seen.rounds;
    // Each round moves s from x towards y, and t from w towards z.
    seen.forward =
        seen.forward && (at.a.s() - s) * (way.y() - way.x()) >= 0 && (at.b.s() - t) * (way.z() - way.w()) >= 0;
    seen.reached = round.end == march::Approach::End::limit;
  }
  seen.off = std::fabs(section.phi_4(at.b.s()) - section.phi_2(at.a.s()));
  return seen;
}

/// phi_2 and phi_4 fall, and phi_4(w_0) + theta_2 > phi_2(x_0): t goes first.
struct Figure6 {
  std::size_t drawn = 0, reached = 0, rounds = 0;
  bool forward = true;
  double off = 0;  // of (9)

  /// Follows the iteration of each pair of intervals on which phi_2 and phi_4 both fall and t moves first.
  void take(Section3& section) {
    section.each([&](const auto&, const auto&, const auto& way) {
      if (!way || way->trend_2 > 0 || way->trend_4 > 0) return;
      const march::StartsOfBoth begin = way->begin.counted_by(section.tally);
      if (s_moves_first(begin, *way)) return;
      const Iteration seen = follow(section, *way, begin);
      ++drawn;
      rounds += seen.rounds;
      forward = forward && seen.forward;
      reached += seen.reached ? 1 : 0;
      if (seen.reached) off = std::max(off, seen.off);
    });
  }

  /// As the program prints it.
  Claim claim() const {
    return {"Figure 6",
            "phi_4 + theta_2 - phi_2 gets small, or s or t exits",
            fmt::format("{} times small ({:.0e}), {} exits, {} rounds", reached, off, drawn - reached, rounds),
            reached > 0 && forward && off < kHolds,
            {{"iterations", drawn}, {"reached", reached}, {"rounds", rounds}, {"largest_error", off}}};
  }
};

/// Rolls by these parts of the perimeter, from s and t likewise.
Rolls planted(const Part& part, double s, double t, double a, double b) {
  const double perimeter = part.perimeter();
  return {a * perimeter, b * perimeter,
          phi(part, s * perimeter, a * perimeter) - phi(part, t * perimeter, b * perimeter)};
}

/// Three parts, two places of finger b each.
void add_figures_5_and_6(std::vector<Claim>& claims) {
  Figure5 figure_5;
  Figure6 figure_6;
  for (const char* shape : {kPart, "spline", "cam"}) {
    const Part part(gallery(shape));
    for (const double t : {0.31, 0.64}) {
      Section3 section(part, planted(part, 0.12, t, 0.17, 0.28), planted(part, 0.12, t, 0.41, 0.36));
      figure_5.take(section);
      figure_6.take(section);
    }
  }
  claims.push_back(figure_5.claim());
  claims.push_back(figure_6.claim());
}

/// The pairs that satisfy (8) and (9), by either order of moves.
march::PairResult pairs_by(const Part& part, march::MoveOrder order) {
  march::PairMarchOptions options;
  options.order = order;
  return march::PairMarch(part.outline(), options)
      .pairs({kFirst.a, kFirst.b, kFirst.turn}, {kSecond.a, kSecond.b, kSecond.turn});
}

/// The numbers of intervals and of pairs, and what a third roll leaves.
void add_figure_8(std::vector<Claim>& claims) {
  const Part part(gallery(kPart));
  constexpr std::size_t kIntervals = 16, kPairs = 15;  // the paper's
  constexpr double kFits = 1e-4;                       // radians: the readings are rounded
  const march::PairResult found = pairs_by(part, march::MoveOrder::towards_root);
  const march::PairResult printed = pairs_by(part, march::MoveOrder::printed);
  // Pairs that the third roll fits as well.
  const auto left = std::count_if(found.pairs.begin(), found.pairs.end(), [&](const march::StartPair& pair) {
    return std::fabs(phi(part, pair.s, kThird.a) - phi(part, pair.t, kThird.b) - kThird.turn) < kFits;
  });
  claims.push_back({"Figure 8",
                    "16 intervals for s, 16 for t",
                    fmt::format("{} and {}", found.n(), found.m()),
                    found.n() == kIntervals && found.m() == kIntervals,
                    {{"n", found.n()}, {"m", found.m()}}});
  claims.push_back(
      {"Figure 8",
       "15 pairs of feasible locations",
       fmt::format("{}; {} with t always first, as Figure 6 prints it", found.pairs.size(), printed.pairs.size()),
       found.pairs.size() == kPairs,
       {{"pairs", found.pairs.size()}, {"as_printed", printed.pairs.size()}}});
  claims.push_back({"Figure 8",
                    "a fourth pair of contacts leaves one",
                    fmt::format("{} of {}", left, found.pairs.size()),
                    left == 1,
                    {{"left", left}}});
}

}  // namespace

void add_two_finger_claims(std::vector<Claim>& claims) {
  add_figures_5_and_6(claims);
  add_figure_8(claims);
}

}  // namespace rollfix::app
