#include "weighing.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "diagnosis.hpp"
#include "locate/corner_sets.hpp"
#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate.hpp"

// Notation:
//   D^6 u           sixth differences of a column: of a smooth course next to nothing, of noise their variance is
//                   (12 choose 6) sd^2, and neighbours are correlated by -6/7
//   jitter          sd of what is not smooth, by the median of |D^6 u|, `kMedianSize` of their standard deviation
//   rounding        half a unit of a column's last decimal
//   off             by how much a row misses a placement, against what digits leave open: `kOverTolerance` times
// Follows docs/belief.md, "Logs without noise".
// Idea: without noise a few rows are searched with, and all of them are held against what was found. Where none fits,
// the rows are weighed with the noise that they show; else with one so fine that the least mistake shows, then with
// that of usual sensors.
namespace rollfix {
namespace {

// Rows that a course is told by at least.
constexpr std::size_t kFewestRows = 12;
// Differences of this order leave little of a smooth course, and of noise all; neighbours are then correlated by -6/7.
constexpr int kOrder = 6;
constexpr double kLeastAgainst = 0.6;
// The median of a normal deviate's size.
constexpr double kMedianSize = 0.6744897501960817;
// Rows jitter where they are off by this many times what their digits leave open.
constexpr double kOverDigits = 4;
// A row contradicts a placement where it is off by this many times what the digits leave open.
constexpr double kOverTolerance = 10;
// Decimals that are looked at to tell how a column was rounded.
constexpr int kMostDecimals = 15;
// What logs whose rows do not jitter are weighed with to find out what is wrong: so fine first that the least mistake
// shows, then as sensors are. Shares of the perimeter, radians.
constexpr double kFineContact = 2e-6;
constexpr double kFineAngle = 1e-5;
constexpr double kUsualContact = 1e-3;
constexpr double kUsualAngle = 5e-3;
// And none with less than this.
constexpr double kLeastContact = 1e-6;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Neighbours' correlation.
double correlation(const std::vector<double>& values) {
  double products = 0;
  double squares = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    squares += values[k] * values[k];
    if (k > 0) products += values[k] * values[k - 1];
  }
  return squares > 0 ? products / squares : 0;
}

/// The standard deviation of what is not smooth in a column: of differences of its values, 0 where these are not as
/// noise leaves them, each against the one before.
double jitter(std::vector<double> values) {
  double weights = 1;  // the sum of the squared binomials: (2m choose m)
  for (int order = 1; order <= kOrder; ++order) {
    for (std::size_t k = 0; k + 1 < values.size(); ++k) values[k] = values[k + 1] - values[k];
    values.pop_back();
    weights *= 2.0 * (2.0 * order - 1) / order;
  }
  // Of white noise it is -m / (m + 1).
  if (correlation(values) > -kLeastAgainst) return 0;
  for (double& value : values) value = std::abs(value);
  return median(std::move(values)) / kMedianSize / std::sqrt(weights);
}

double beyond_digits(double sd, double half_unit) { return sd > kOverDigits * half_unit ? sd : 0; }

double widest(const Placement& placement) {
  double most = 0;
  for (const Interval& extent : placement.extent) most = std::max(most, extent.width());
  return most;
}

/// How far a placement may be off its true place.
double width_of(const Placement& placement) {
  return placement.kind == Kind::stretch || placement.kind == Kind::corner ? 0 : widest(placement);
}

class RowsCheck {
 public:
  RowsCheck(const Problem& problem, const Observation& observed, const Answer& answer)
      : part_(problem.part), observed_(observed), answer_(answer) {
    for (const FingerRows& rows : problem.measured.log->fingers) {
      centre_rounding_ += rounding_of_column(rows.x) + rounding_of_column(rows.y);
    }
    is_open_ = ContactEquations{part_, answer.readings}.is_open();
  }

  bool contradicts(const Placement& placement) const {
    if (is_open_) return false;
    if (placement.kind != Kind::corner && is_off(placement)) return true;
    const double tolerance = kOverTolerance * answer_.tolerance.value;
    const double width = width_of(placement);
    const double bend = bend_over(width);
    if (!placement.pose_residual || is_of_many(placement)) return false;
    const double length =
        kOverTolerance * (observed_.length_error() + centre_rounding_) + width + (tolerance + bend) * part_.perimeter();
    return placement.pose_residual->length > length + kLeastOff * part_.perimeter();
  }

  /// The row that is furthest off one place of many: others of them may fit it. Nothing where none is off so much.
  std::optional<std::size_t> row_to_ask() const {
    for (const Placement& placement : answer_.placements) {
      if (!is_open_ && is_of_many(placement) && is_off(placement)) return furthest(placement);
    }
    return std::nullopt;
  }

 private:
  static constexpr double kLeastOff = 1e-6;   // of the perimeter: an outline's own accuracy
  static constexpr double kContinuum = 1e-3;  // of the perimeter: far more than digits leave open of one place

  double bend_over(double width) const { return 2 * part_.turning().most_curvature() * width; }
  /// A continuum of pairs, but for digits: the one that is listed need not be where the fingers were.
  bool is_of_many(const Placement& placement) const {
    return placement.start.size() == 2 &&
           (placement.kind == Kind::stretch || widest(placement) > kContinuum * part_.perimeter());
  }

  /// Where contacts are known no better.
  double near(const Placement& placement) const {
    return kOverTolerance * observed_.length_error() + (is_of_many(placement) ? 0 : width_of(placement));
  }

  bool is_off(const Placement& placement) const {
    const double most = kOverTolerance * answer_.tolerance.value + bend_over(width_of(placement));
    return off(placement, observed_.rolls) > most;
  }

  double off(const Placement& placement, std::span<const Reading> rows) const {
    ContactEquations question{part_, rows, {}, near(placement)};
    if (answer_.facing) question.facing = without_laps(*answer_.facing);
    double least = residual_at(question, placement.start);
    for (const PerFinger<double>& root : placement.roots) least = std::min(least, residual_at(question, root));
    return least;
  }

  std::size_t furthest(const Placement& placement) const {
    std::vector<double> each;
    for (const Reading& row : observed_.rolls) each.push_back(off(placement, {&row, 1}));
    return static_cast<std::size_t>(std::max_element(each.begin(), each.end()) - each.begin());
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
  if (belief->fit().is_bad()) {
    std::vector<Diagnosis> found = diagnose(noisy, observed, *belief);
    for (Diagnosis& one : found) {
      if (!rows_are_exact || !is_mended_exactly(one.cause)) one.noise = *noisy.noise;  // the cure says it all
      if (one.cause != Cause::noise) continue;
      one.cause = Cause::unsaid_noise;
      one.noise.contact *= one.noise_scale;
      one.noise.angle *= one.noise_scale;
    }
    return found;
  }
  Diagnosis diagnosis;
  diagnosis.cause = Cause::unsaid_noise;
  diagnosis.noise = noise;
  diagnosis.verdict = belief->verdict();
  diagnosis.modes = modes_of(*belief);
  return {std::move(diagnosis)};
}

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

std::optional<Noise> noise_that_shows(const Log& log, const std::vector<Finger>& fingers) {
  if (log.rows() < kFewestRows) return std::nullopt;
  Noise noise;
  for (std::size_t which = 0; which < log.fingers.size(); ++which) {
    const FingerRows& rows = log.fingers[which];
    if (log.kind == LogKind::contact) {
      const Finger& finger = *finger_of(fingers, which);
      std::vector<double> u;
      std::vector<double> psi;
      for (const Contact& contact : contacts_of(rows, finger)) {
        u.push_back(contact.u);
        psi.push_back(contact.psi);
      }
      noise.contact = std::max(noise.contact, finger.length_per_u() * beyond_digits(jitter(u), rows.place_rounding));
      noise.angle = std::max(noise.angle, beyond_digits(jitter(psi), rows.angle_rounding));
    } else {
      noise.contact = std::max(noise.contact, beyond_digits(jitter(rows.length), rows.place_rounding));
      noise.angle = std::max(noise.angle, beyond_digits(jitter(rows.turn), rows.angle_rounding));
    }
  }
  if (noise.contact <= 0 && noise.angle <= 0) return std::nullopt;
  return noise;
}

double rounding_of_column(const std::vector<double>& values) {
  double unit = 1;
  for (int decimals = 0; decimals < kMostDecimals; ++decimals, unit /= 10) {
    const bool is_whole = std::all_of(values.begin(), values.end(), [&](double value) {
      return std::abs(value / unit - std::round(value / unit)) <= 1e-6;
    });
    if (is_whole) return 0.5 * unit;
  }
  return 0;
}

double jitter_of_centres(const Log& log) {
  double most = 0;
  for (const FingerRows& rows : log.fingers) {
    if (rows.x.size() >= kFewestRows) most = std::max({most, jitter(rows.x), jitter(rows.y)});
  }
  return most;
}

std::optional<std::size_t> row_to_ask(const Problem& problem, const Observation& observed, const Answer& answer) {
  return RowsCheck(problem, observed, answer).row_to_ask();
}

bool check_rows(const Problem& problem, const Observation& observed, bool explains, Answer& answer) {
  const RowsCheck check(problem, observed, answer);
  for (Placement& placement : answer.placements) placement.is_contradicted = check.contradicts(placement);
  const auto contradicted =
      std::stable_partition(answer.placements.begin(), answer.placements.end(),
                            [](const Placement& placement) { return !placement.is_contradicted; });
  if (contradicted != answer.placements.begin()) return true;
  if (explains) answer.diagnoses = diagnoses_of(problem, observed);
  return false;
}

}  // namespace rollfix
