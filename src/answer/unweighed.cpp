#include "steps.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "locate/searches.hpp"
#include "log/jitter.hpp"
#include "outline/turn.hpp"
#include "roll/noise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"

// Notation:
//   off             by how much a row misses a placement, against what digits leave open: `kOverTolerance` times
// Follows docs/belief.md, "Logs without noise".
// Idea: without noise a few rows are searched with, and all of them are held against what was found. Where none fits,
// the rows are weighed with the noise that they show; else with one so fine that the least mistake shows, then with
// that of usual sensors.
namespace rollfix::answer {
namespace {

// A row contradicts a placement where it is off by this many times what the digits leave open.
constexpr double kOverTolerance = 10;
// What logs whose rows do not jitter are weighed with to find out what is wrong: so fine first that the least mistake
// shows, then as sensors are. Shares of the perimeter, radians.
constexpr double kFineContact = 2e-6;
constexpr double kFineAngle = 1e-5;
constexpr double kUsualContact = 1e-3;
constexpr double kUsualAngle = 5e-3;
// And none with less than this.
constexpr double kLeastContact = 1e-6;

/// The largest extent of a placement, over fingers, arc length.
double widest(const Placement& placement) {
  double most = 0;
  for (const Interval& extent : placement.extent) most = std::max(most, extent.width());
  return most;
}

/// Holds all rows of a log against placements. A row is off by |f|, corners taken as sets.
class RowsCheck {
 public:
  RowsCheck(const Problem& problem, const Observation& observed, const Answer& answer)
      : part_(problem.part), observed_(observed), answer_(answer) {
    for (const FingerRows& rows : problem.measured.log->fingers) {
      centre_rounding_ += rounding_of_column(rows.x) + rounding_of_column(rows.y);
    }
    is_open_ = ContactEquations{part_, answer.readings}.is_open();
  }

  /// Whether some row, or the contacts in the world, are off beyond what digits and the placement's width explain.
  bool contradicts(const Placement& placement) const {
    // No reading is exact: placements are as wide as the fingers' corners leave them.
    if (is_open_) return false;
    if (is_off(placement)) return true;
    const double tolerance = kOverTolerance * answer_.tolerance.value;
    const double width = width_of(placement);
    const double bend = bend_over(width);
    if (!placement.pose_residual || is_of_many(placement)) return false;
    // What residuals of the pose may be: digits of lengths and centres, the width, and what a turn that is off does
    // across the part.
    const double length =
        kOverTolerance * (observed_.length_error() + centre_rounding_) + width + (tolerance + bend) * part_.perimeter();
    return placement.pose_residual->length > length + kLeastOff * part_.perimeter();
  }

  /// Rows that are furthest off one place of many, the worst first: others of them may fit. None where none is off so
  /// much.
  std::vector<std::size_t> rows_to_ask() const {
    for (const Placement& placement : answer_.placements) {
      if (is_open_ || !is_of_many(placement)) continue;
      if (off(placement, observed_.rolls) > kOverTolerance * answer_.tolerance.value) return furthest(placement);
    }
    return {};
  }

 private:
  static constexpr double kLeastOff = 1e-6;  // of the perimeter: an outline's own accuracy
  static constexpr double kNearlyAsBad = 0.5;
  static constexpr double kContinuum = 1e-3;  // of the perimeter: more than digits leave open of one place

  /// By how much a turn may differ over a width of starts, radians: both ends of the roll move.
  double bend_over(double width) const { return 2 * part_.turning().most_curvature() * width; }
  /// A continuum, of pairs also but for digits: the place that is listed need not be where the fingers were.
  bool is_of_many(const Placement& placement) const {
    return placement.kind == Kind::stretch || widest(placement) > kContinuum * part_.perimeter();
  }

  /// Within this arc length of a corner a contact may be at it: contacts are known no better.
  double near(const Placement& placement) const {
    return kOverTolerance * observed_.length_error() + (is_of_many(placement) ? 0 : width_of(placement));
  }

  /// Whether the worst row is off by more than the tolerance and the placement's width explain.
  bool is_off(const Placement& placement) const {
    const double most = kOverTolerance * answer_.tolerance.value + bend_over(width_of(placement));
    return off(placement, observed_.rolls) > most;
  }

  /// The largest |f| over these rows at the start, or at a listed root if that fits better; radians.
  double off(const Placement& placement, std::span<const Reading> rows) const {
    ContactEquations question{part_, rows, {}, near(placement)};
    if (answer_.facing) question.facing = without_laps(*answer_.facing);
    double least = residual_at(question, placement.start);
    for (const PerFinger<double>& root : placement.roots) least = std::min(least, residual_at(question, root));
    return least;
  }

  /// Beside what was asked, which says how a finger stands on a corner where it begins: the worst row, and the first
  /// and the last of those nearly as bad. Where lines meet at a corner these leave the least of a continuum.
  std::vector<std::size_t> furthest(const Placement& placement) const {
    std::vector<Reading> asked = answer_.readings;
    std::vector<double> each;
    for (const Reading& row : observed_.rolls) {
      // Each row together with those searched with: pivots at the first contact are the same for all.
      asked.push_back(row);
      each.push_back(off(placement, asked));
      asked.pop_back();
    }
    const auto worst = std::max_element(each.begin(), each.end());
    const auto is_bad = [&](double misfit) { return misfit >= kNearlyAsBad * *worst; };
    const auto first = std::find_if(each.begin(), each.end(), is_bad);
    const auto last = std::prev(std::find_if(each.rbegin(), each.rend(), is_bad).base());
    std::vector<std::size_t> rows;
    for (const auto row : {worst, first, last}) {
      const auto index = static_cast<std::size_t>(row - each.begin());
      if (std::find(rows.begin(), rows.end(), index) == rows.end()) rows.push_back(index);
    }
    return rows;
  }

  const Part& part_;
  const Observation& observed_;
  const Answer& answer_;
  double centre_rounding_ = 0;
  bool is_open_ = false;  // in every row a finger with corners was on one: placements are as wide as that leaves them
};

/// Whether rows that are exact fit exactly where that mistake is mended: the cure says no number that was estimated.
bool is_mended_exactly(Cause cause) {
  return cause != Cause::radius && cause != Cause::slip && cause != Cause::gyroscope && cause != Cause::noise &&
         cause != Cause::unsaid_noise && cause != Cause::stray;
}

/// What is wrong, found out with noise that the log was not said to have.
std::vector<Diagnosis> diagnoses_with(const Problem& problem, const Observation& observed, const Noise& noise,
                                      bool rows_are_exact = false) {
  Problem noisy = problem;
  noisy.noise = noise;
  noisy.noise->contact = std::max(noise.contact, kLeastContact * problem.part.perimeter());
  std::optional<Belief> belief = believe(noisy, observed);
  // Even with that noise the rows are off: the usual mistakes are tried.
  if (belief->fit().is_bad()) {
    std::vector<Diagnosis> found = diagnose(noisy, observed, *belief);
    for (Diagnosis& one : found) {
      if (!rows_are_exact || !is_mended_exactly(one.cause)) one.noise = *noisy.noise;  // the cure says it all
      // No noise was stated: the cause is not more noise than stated, but noise of this size that was not stated.
      if (one.cause != Cause::noise) continue;
      one.cause = Cause::unsaid_noise;
      one.noise = with_rows_as_noisy(one.noise, one.noise_scale);
    }
    return found;
  }
  // The rows fit with that noise: that none was stated is all that is wrong.
  Diagnosis diagnosis;
  diagnosis.cause = Cause::unsaid_noise;
  diagnosis.noise = noise;
  diagnosis.verdict = belief->verdict();
  diagnosis.modes = modes_of(*belief);
  return {std::move(diagnosis)};
}

/// With the noise that the rows show by their jitter. Else with very little, so that the least mistake is seen, and if
/// that finds none with usual noise.
std::vector<Diagnosis> diagnoses_of(const Problem& problem, const Observation& observed) {
  const double P = problem.part.perimeter();
  if (const auto shown = noise_that_shows(*problem.measured.log, problem.fingers)) {
    return diagnoses_with(problem, observed, *shown);
  }
  std::vector<Diagnosis> fine = diagnoses_with(problem, observed, {kFineContact * P, kFineAngle}, true);
  if (fine.front().cause != Cause::part && fine.front().cause != Cause::correlation) return fine;
  return diagnoses_with(problem, observed, {kUsualContact * P, kUsualAngle});
}

}  // namespace

double width_of(const Placement& placement) {
  return placement.kind == Kind::stretch || placement.kind == Kind::corner ? 0 : widest(placement);
}

std::vector<std::size_t> rows_to_ask(const Problem& problem, const Observation& observed, const Answer& answer) {
  return RowsCheck(problem, observed, answer).rows_to_ask();
}

/// Marks contradicted placements and puts them last; looks for what is wrong if none is left.
RowsChecked check_rows(const Problem& problem, const Observation& observed, bool explains, const Answer& answer) {
  const RowsCheck check(problem, observed, answer);
  RowsChecked rows{answer.placements};
  for (Placement& placement : rows.placements) placement.is_contradicted = check.contradicts(placement);
  const auto contradicted =
      std::stable_partition(rows.placements.begin(), rows.placements.end(),
                            [](const Placement& placement) { return !placement.is_contradicted; });
  rows.fits_badly = contradicted == rows.placements.begin();
  if (rows.fits_badly && explains) rows.diagnoses = diagnoses_of(problem, observed);
  return rows;
}

}  // namespace rollfix::answer
