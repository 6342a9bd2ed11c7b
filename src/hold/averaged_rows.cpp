#include "averaged_rows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "belief/nodes.hpp"

// Rows between the first and the last one go together, as few means as even motion allows: belief/nodes.hpp.
namespace rollfix::hold {
namespace {

constexpr double kMedianVariance = 0.5 * std::numbers::pi;  // of a median, in those of a mean
constexpr std::size_t kMostMeans = 512;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// What an outlier does not move: each number of a finger's rows is their median, but for how the contact lies on it.
HeldContact median_of(const std::vector<HeldRow>& rows, std::size_t from, std::size_t to, std::size_t finger,
                      HeldContact mean) {
  const auto of = [&](auto number) {
    std::vector<double> values;
    for (std::size_t k = from; k < to; ++k) values.push_back(number(rows[k].contacts[finger]));
    return median(std::move(values));
  };
  mean.travelled = of([](const HeldContact& one) { return one.travelled; });
  mean.tangent = of([](const HeldContact& one) { return one.tangent; });
  mean.orientation = of([](const HeldContact& one) { return one.orientation; });
  mean.at = {of([](const HeldContact& one) { return one.at.x(); }),
             of([](const HeldContact& one) { return one.at.y(); })};
  mean.lever = {of([](const HeldContact& one) { return one.lever.x(); }),
                of([](const HeldContact& one) { return one.lever.y(); })};
  return mean;
}

/// The mean of the rows from one to before another.
HeldRow mean_of(const std::vector<HeldRow>& rows, std::size_t from, std::size_t to, bool robust) {
  HeldRow mean = rows[from];
  if (to - from == 1) return mean;
  const auto count = static_cast<double>(to - from);
  mean.time = 0;
  for (std::size_t k = from; k < to; ++k) mean.time += rows[k].time / count;
  for (std::size_t finger = 0; finger < mean.contacts.size(); ++finger) {
    HeldContact sum{0, 0, Vec2::Zero(), Vec2::Zero(), 0, 0, 0};
    for (std::size_t k = from; k < to; ++k) {
      const HeldContact& one = rows[k].contacts[finger];
      sum.travelled += one.travelled / count;
      sum.tangent += one.tangent / count;
      sum.at += one.at / count;
      sum.lever += one.lever / count;
      sum.orientation += one.orientation / count;
      sum.finger_curvature += one.finger_curvature / count;
      sum.rows_alike += one.rows_alike / count;
    }
    mean.contacts[finger] = robust ? median_of(rows, from, to, finger, sum) : sum;
  }
  for (std::size_t pin = 0; pin < mean.pins.size(); ++pin) {
    HeldPin sum;
    for (std::size_t k = from; k < to; ++k) {
      sum.at += rows[k].pins[pin].at / count;
      sum.spin += rows[k].pins[pin].spin / count;
    }
    mean.pins[pin] = sum;
  }
  mean.weight = robust ? count / kMedianVariance : count;
  return mean;
}

/// A number that was measured, and its standard deviation.
struct Measured {
  std::function<double&(HeldRow&)> of;
  double sd = 0;
};

std::vector<Measured> measured_numbers(const HeldRows& rows) {
  std::vector<Measured> all;
  for (std::size_t k = 0; k < rows.fingers(); ++k) {
    const HeldErrors& errors = rows.errors[k];
    double curvature = 0;
    for (const HeldRow& row : rows.rows) curvature = std::max(curvature, row.contacts[k].finger_curvature);
    const double turn = std::hypot(errors.angle, curvature * errors.travel);
    all.push_back({[k](HeldRow& row) -> double& { return row.contacts[k].travelled; }, errors.travel});
    all.push_back({[k](HeldRow& row) -> double& { return row.contacts[k].tangent; }, turn});
    if (!errors.has_place) continue;
    const double place = std::hypot(errors.place, errors.travel);
    all.push_back({[k](HeldRow& row) -> double& { return row.contacts[k].at.x(); }, place});
    all.push_back({[k](HeldRow& row) -> double& { return row.contacts[k].at.y(); }, place});
  }
  for (std::size_t k = 0; k < rows.wheels.size(); ++k) {
    const HeldWheel& wheel = rows.wheels[k];
    all.push_back({[k](HeldRow& row) -> double& { return row.pins[k].at.x(); }, wheel.place});
    all.push_back({[k](HeldRow& row) -> double& { return row.pins[k].at.y(); }, wheel.place});
    if (wheel.spin) all.push_back({[k](HeldRow& row) -> double& { return row.pins[k].spin; }, *wheel.spin});
  }
  return all;
}

belief::Course course_of(std::vector<HeldRow>& rows, const Measured& measured) {
  belief::Course course{{}, measured.sd / std::sqrt(rows.front().weight)};
  for (HeldRow& row : rows) {
    course.values.push_back(measured.of(row));
    course.rows.push_back(row.weight);
  }
  return course;
}

/// Lots of rows between the first and the last one, about as many in each.
std::vector<HeldRow> means(const HeldRows& rows, std::size_t lots) {
  const std::size_t count = rows.rows.size() - 2;
  std::vector<HeldRow> result;
  for (std::size_t k = 0; k < lots; ++k) {
    result.push_back(mean_of(rows.rows, 1 + k * count / lots, 1 + (k + 1) * count / lots, rows.outlier_share > 0));
  }
  return result;
}

/// What was in the middles of such means; none: they go too uneven for that.
std::optional<std::vector<HeldRow>> middles_of(std::vector<HeldRow> means, const std::vector<Measured>& numbers) {
  for (const Measured& measured : numbers) {
    const auto middles = belief::at_middles(course_of(means, measured));
    if (!middles) return std::nullopt;
    for (std::size_t k = 0; k < means.size(); ++k) measured.of(means[k]) = (*middles)[k];
  }
  return means;
}

HeldRows between_ends(const HeldRows& rows, std::vector<HeldRow> means) {
  HeldRows result = rows;
  result.rows = std::move(means);
  result.rows.insert(result.rows.begin(), rows.rows.front());
  result.rows.push_back(rows.rows.back());
  return result;
}

}  // namespace

HeldRows averaged(const HeldRows& rows) {
  const std::size_t count = rows.rows.size() - std::min<std::size_t>(2, rows.rows.size());
  const std::vector<Measured> numbers = measured_numbers(rows);
  std::vector<HeldRow> all = rows.rows;
  // Several fingers leave a row one pose.
  const bool is_smooth =
      rows.fingers() == 1 && rows.outlier_share == 0 && count >= 2 * belief::kFewestMeans &&
      std::ranges::all_of(numbers, [&](const Measured& one) { return belief::is_even(course_of(all, one)); });
  const auto middles = [&](std::size_t lots) { return middles_of(means(rows, lots), numbers); };
  if (is_smooth) {
    auto few = belief::fewest_means(std::min(count / 2, kMostMeans - 1), middles);
    if (few) return between_ends(rows, *std::move(few));
  }
  return rows.rows.size() <= kMostMeans ? rows : between_ends(rows, means(rows, kMostMeans));
}

}  // namespace rollfix::hold
