#include "jitter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

// What the columns of a log tell of their own noise.
// Notation:
//   D^6 u           sixth differences of a column: of a smooth course they are small by the sixth power of the rows'
//                   distance, of white noise their variance is (12 choose 6) sd^2, and neighbours have the
//                   correlation -6/7
//   jitter          sd of what is not smooth, by the median of |D^6 u|, `kMedianSize` of their standard deviation
//   rounding        half a unit of a column's last decimal
// Follows docs/belief.md, "Logs without noise".
// Idea: differences take a smooth course away and leave the noise. They count only if neighbours are correlated as
// those of noise are; the median ignores the few rows at corners, where the course is not smooth.
namespace rollfix {
namespace {

// Rows that are needed: fewer leave too few differences for a median and a correlation.
constexpr std::size_t kFewestRows = 12;
// Differences of this order leave little of a smooth course and all of the noise. A higher order asks for more rows.
// Neighbours of white noise have the correlation -6/7 then; above -`kLeastAgainst` the column does not look like noise.
constexpr int kOrder = 6;
constexpr double kLeastAgainst = 0.6;
// The median of a normal deviate's size.
constexpr double kMedianSize = 0.6744897501960817;
// Rows jitter where they are off by this many times what their digits leave open.
constexpr double kOverDigits = 4;
// Decimals that are tried to tell how a column was rounded: more are beyond a double's digits.
constexpr int kMostDecimals = 15;

/// The middle value; of an even number the upper one of the two. REQUIRES at least one.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Correlation of neighbours, of values with the mean 0; 0 where all are 0.
double correlation(const std::vector<double>& values) {
  double products = 0;
  double squares = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    squares += values[k] * values[k];
    if (k > 0) products += values[k] * values[k - 1];
  }
  return squares > 0 ? products / squares : 0;
}

/// The standard deviation of what is not smooth in a column, in its unit; 0 where its differences are not as noise
/// leaves them: mostly of the other sign than the one before.
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

/// The same where it is more than digits explain, else 0: rounding jitters as well.
double beyond_digits(double sd, double half_unit) { return sd > kOverDigits * half_unit ? sd : 0; }

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
      // u of a disk is an angle, and `contact` a length: times the radius. The largest of all fingers counts.
      noise.contact = std::max(noise.contact, finger.length_per_u() * beyond_digits(jitter(u), rows.place_rounding));
      noise.angle = std::max(noise.angle, beyond_digits(jitter(psi), rows.angle_rounding));
    } else {
      noise.contact = std::max(noise.contact, beyond_digits(jitter(rows.length), rows.place_rounding));
      noise.angle = std::max(noise.angle, beyond_digits(jitter(rows.turn), rows.angle_rounding));
    }
  }
  // No column jitters.
  if (noise.contact <= 0 && noise.angle <= 0) return std::nullopt;
  return noise;
}

double rounding_of_column(const std::vector<double>& values) {
  double unit = 1;
  for (int decimals = 0; decimals < kMostDecimals; ++decimals, unit /= 10) {
    // All numbers are whole multiples of this unit: no more decimals are written.
    const bool is_whole = std::all_of(values.begin(), values.end(), [&](double value) {
      return std::abs(value / unit - std::round(value / unit)) <= 1e-6;
    });
    if (is_whole) return 0.5 * unit;
  }
  return 0;
}

double jitter_of_centres(const Log& log) {
  double most = 0;
  // Of all fingers and both coordinates the largest.
  for (const FingerRows& rows : log.fingers) {
    if (rows.x.size() >= kFewestRows) most = std::max({most, jitter(rows.x), jitter(rows.y)});
  }
  return most;
}

}  // namespace rollfix
