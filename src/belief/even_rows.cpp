#include "belief/even_rows.hpp"

#include <cmath>

// Notation:
//   m             means of a measurement over lots of as many neighbouring rows
//   D2 m          their second differences, m_(k-1) - 2 m_k + m_(k+1), or where lots have not as many rows each what
//   they
//                 would be if all had as many as the one in the middle, by divided differences
//   m - D2 m / 24   what the measurement was in the middle of the lot, if it goes as a cubic from lot to lot
// Idea: a row alone may be explained by a pivot at a corner, or by another pose of the part, that takes up its noise.
// The rows of a smooth motion say together what none of them says alone, and their mean has little noise to take up.
namespace rollfix::belief {
namespace {

constexpr double kSmooth = 2;    // times the noise: what rows are off from their neighbours, in the mean square
constexpr double kNoKink = 3.5;  // standard deviations by which a bend may differ from those on both sides of it
// Of D2 m less the mean of what it is two lots before and after, or less the one of both that there is: in variances of
// a mean.
constexpr double kBothSides = 7;
constexpr double kOneSide = 10;

/// Second differences; at both ends that of the neighbour.
std::vector<double> bends(const Course& course) {
  const std::vector<double>& m = course.values;
  const auto rows = [&](std::size_t k) { return course.rows.empty() ? 1 : course.rows[k]; };
  const auto slope = [&](std::size_t k) { return (m[k + 1] - m[k]) / (0.5 * (rows(k) + rows(k + 1))); };
  std::vector<double> result(m.size());
  for (std::size_t k = 1; k + 1 < m.size(); ++k) {
    const double apart = 0.25 * rows(k - 1) + 0.5 * rows(k) + 0.25 * rows(k + 1);
    result[k] = (slope(k) - slope(k - 1)) / apart * rows(k) * rows(k);
  }
  result.front() = result[1];
  result.back() = result[m.size() - 2];
  return result;
}

}  // namespace

bool is_even(const Course& rows) {
  double sum = 0;
  for (const double bend : bends(rows)) sum += bend * bend;
  const double of_noise = (1 + 4 + 1) * rows.sd * rows.sd;
  return sum <= kSmooth * of_noise * static_cast<double>(rows.values.size());
}

std::optional<std::vector<double>> at_middles(const Course& means) {
  const std::vector<double> bent = bends(means);
  for (std::size_t k = 1; k + 1 < bent.size(); ++k) {
    const bool has_before = k > 2;
    const bool has_after = k + 3 < bent.size();
    const double before = bent[has_before ? k - 2 : k + 2];
    const double after = bent[has_after ? k + 2 : k - 2];
    const double variance = has_before && has_after ? kBothSides : kOneSide;
    if (std::abs(bent[k] - 0.5 * (before + after)) > kNoKink * std::sqrt(variance) * means.sd) return std::nullopt;
  }
  std::vector<double> result = means.values;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] -= bent[k] / 24;
  return result;
}

}  // namespace rollfix::belief
