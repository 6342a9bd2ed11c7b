#include "profile.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "part/turning_range.hpp"

namespace rollfix {
namespace {

// Joints may be on either side of a cell's end by rounding: cells are looked at this share of them farther.
constexpr double kBeyondCell = 1e-6;
// Rounding in single precision: of sums of a few turns and lengths as they occur here.
constexpr double kTurnRounding = 2e-5;
constexpr double kShareRounding = 1e-6;
// A stretch is not halved below this share of the perimeter: the search takes over.
constexpr double kShortest = 1.0 / 4096;

constexpr float kNothingYet = std::numeric_limits<float>::infinity();

float below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded <= value ? rounded : std::nextafter(rounded, -kNothingYet);
}
float above(double value) { return -below(-value); }

double slack_of(const Clue& clue, double most_curvature) {
  return clue.turn_slack + clue.turn_slack_by_curvature * most_curvature;
}

/// Bounds on Theta over runs of cells, from a lap before the boundary to two behind it. Beyond an open end there is
/// nothing.
template <std::size_t N>
class Laps {
 public:
  Laps(const Profile<N>& profile, const Course& course) : course_(course) {
    for (std::size_t k = 0; k < kLaps * N; ++k) {
      const int lap = static_cast<int>(k / N) - 1;
      const bool is_there = course.closed || lap == 0;
      const float lift = static_cast<float>(lap) * course.period_turn;
      least_[k] = is_there ? profile.least[k % N] + lift : kNothingYet;
      most_[k] = is_there ? profile.most[k % N] + lift : -kNothingYet;
    }
  }

  /// Where the tangents may point at the ends of rolls that start anywhere in cell i, for each cell i. False: the
  /// length is known too badly to say.
  bool ends(double length, double length_slack, std::array<float, N>& least, std::array<float, N>& most) const {
    const double cell = static_cast<double>(course_.perimeter) / N;
    const double slack = length_slack + kShareRounding * (std::abs(length) + course_.perimeter);
    const double first = std::floor((length - slack) / cell);
    const double last = std::floor((length + slack) / cell) + 1;
    const double width = last - first + 1;
    if (!(width <= N)) return false;
    const double lap = course_.closed ? std::floor(first / N) : 0;
    const double from = course_.closed ? first - lap * N : std::clamp(first, -2.0 * N, 2.0 * N);
    const float lift = static_cast<float>(lap) * course_.period_turn;
    least.fill(kNothingYet);
    most.fill(-kNothingYet);
    for (int c = 0; c < static_cast<int>(width); ++c) {
      const int begin = static_cast<int>(N) + static_cast<int>(from) + c;    // of cell 0, in least_
      if (begin < 0 || begin > static_cast<int>((kLaps - 1) * N)) continue;  // beyond an open end
      const float* const lo = least_.data() + begin;
      const float* const hi = most_.data() + begin;
      for (std::size_t i = 0; i < N; ++i) {
        least[i] = std::min(least[i], lo[i]);
        most[i] = std::max(most[i], hi[i]);
      }
    }
    for (std::size_t i = 0; i < N; ++i) {
      least[i] += lift;
      most[i] += lift;
    }
    return true;
  }

 private:
  static constexpr std::size_t kLaps = 4;

  Course course_;
  std::array<float, kLaps * N> least_;
  std::array<float, kLaps * N> most_;
};

double rounding_of(double turn, const Course& course, double length) {
  const double laps = course.closed ? std::abs(length) / course.perimeter + 2 : 1;
  return kTurnRounding + kShareRounding * (std::abs(turn) + laps * std::abs(course.period_turn));
}

/// How far the turn may be off in single precision.
float slack_in_cells(const Clue& clue, const Course& course) {
  const double most_curvature = course.most_curvature * (1 + kShareRounding);
  double slack = slack_of(clue, most_curvature);
  for (const double length : clue.length) slack += rounding_of(clue.turn, course, length);
  return above(slack);
}

template <std::size_t N>
std::uint64_t bits_of(const std::array<float, N>& least, const std::array<float, N>& most) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < N; ++i) bits |= static_cast<std::uint64_t>(least[i] <= most[i]) << i;
  return bits;
}

/// The tangent at the start is in the cell's range, and each reading confines it further.
template <std::size_t N>
std::uint64_t cells_of_one(const Profile<N>& profile, const Course& course, const Clues& clues) {
  const Laps<N> laps(profile, course);
  std::array<float, N> least = profile.least;
  std::array<float, N> most = profile.most;
  std::uint64_t left = bits_of(least, most);
  for (const Clue& clue : clues.clues) {
    std::array<float, N> end_least;
    std::array<float, N> end_most;
    if (!laps.ends(clue.length[0], clue.length_slack, end_least, end_most)) continue;
    const auto turn = static_cast<float>(clue.turn);
    const float slack = slack_in_cells(clue, course);
    for (std::size_t i = 0; i < N; ++i) {
      least[i] = std::max(least[i], end_least[i] - turn - slack);
      most[i] = std::min(most[i], end_most[i] - turn + slack);
    }
    left = bits_of(least, most);
    if (left == 0) return 0;
  }
  return left;
}

/// How far the tangent may turn on the way of one of two fingers, for each cell that it may start in.
template <std::size_t N>
struct Turned {
  std::array<float, N> least;
  std::array<float, N> most;
};

template <std::size_t N>
Turned<N> turned(const Profile<N>& profile, const std::array<float, N>& end_least,
                 const std::array<float, N>& end_most) {
  Turned<N> turned;
  for (std::size_t i = 0; i < N; ++i) {
    turned.least[i] = end_least[i] - profile.most[i];
    turned.most[i] = end_most[i] - profile.least[i];
  }
  return turned;
}

/// Whether some whole number of turns of the facing lies in [lo, hi].
bool faces(double facing, double lo, double hi) {
  const double turns = std::ceil((lo - facing) / (2 * std::numbers::pi));
  return facing + 2 * std::numbers::pi * turns <= hi;
}

/// Pairs of cells: the cell that finger a starts in is left where any cell of finger b's goes with it.
template <std::size_t N>
std::uint64_t cells_of_two(const Profile<N>& profile, const Course& course, const Clues& clues) {
  struct Row {
    Turned<N> a;
    Turned<N> b;
    float turn;
    float slack;
  };
  const Laps<N> laps(profile, course);
  std::vector<Row> rows;
  for (const Clue& clue : clues.clues) {
    std::array<float, N> least;
    std::array<float, N> most;
    Row row;
    if (!laps.ends(clue.length[0], clue.length_slack, least, most)) continue;
    row.a = turned(profile, least, most);
    if (!laps.ends(clue.length[1], clue.length_slack, least, most)) continue;
    row.b = turned(profile, least, most);
    row.turn = static_cast<float>(clue.turn);
    row.slack = slack_in_cells(clue, course);
    rows.push_back(row);
  }
  std::uint64_t left = 0;
  for (std::size_t i = 0; i < N; ++i) {
    std::array<std::uint8_t, N> goes;  // with cell j of finger b's
    for (std::size_t j = 0; j < N; ++j) {
      const double slack = clues.facing_slack + clues.facing_slack_by_curvature * course.most_curvature + kTurnRounding;
      goes[j] = static_cast<std::uint8_t>(
          !clues.facing || faces(*clues.facing, static_cast<double>(profile.least[i]) - profile.most[j] - slack,
                                 static_cast<double>(profile.most[i]) - profile.least[j] + slack));
    }
    for (const Row& row : rows) {
      const float lo = row.a.least[i] - row.turn - row.slack;
      const float hi = row.a.most[i] - row.turn + row.slack;
      for (std::size_t j = 0; j < N; ++j) {
        const bool both = lo <= row.b.most[j] && hi >= row.b.least[j];
        goes[j] = static_cast<std::uint8_t>(both ? goes[j] : 0);
      }
    }
    const bool any = std::any_of(goes.begin(), goes.end(), [](std::uint8_t one) { return one != 0; });
    left |= static_cast<std::uint64_t>(any) << i;
  }
  return left;
}

/// The halves of stretches of one part.
class Halving {
 public:
  Halving(const Part& part, const Clues& clues) : part_(part), turning_(part.turning()), clues_(clues) {
    for (const Clue& clue : clues.clues) {
      slack_.push_back(slack_of(clue, turning_.most_curvature()) + kTurnRounding);
      box_.push_back(slack_.back() + std::sqrt(clues.most_cost) * (clue.turn_sd + clues.shared_sd));
    }
  }

  bool may_start(const Interval& stretch) const {
    if (!fits(stretch)) return false;
    if (stretch.width() <= kShortest * part_.perimeter()) return true;
    const double middle = stretch.lo + 0.5 * stretch.width();
    return may_start({stretch.lo, middle}) || may_start({middle, stretch.hi});
  }

 private:
  bool fits(const Interval& stretch) const {
    const Interval start = angles_over(turning_, stretch);
    Interval tangent = start;
    std::vector<Interval> asked;  // of the tangent at the start, by each reading, as if that were exact
    for (std::size_t k = 0; k < slack_.size(); ++k) {
      const Clue& clue = clues_.clues[k];
      const double off = clue.length_slack + kShareRounding * (std::abs(clue.length[0]) + part_.perimeter());
      Interval end{stretch.lo + clue.length[0] - off, stretch.hi + clue.length[0] + off};
      if (!part_.closed()) {
        end = {std::max(end.lo, 0.0), std::min(end.hi, part_.perimeter())};
        if (end.hi < end.lo) return false;
      }
      const Interval angles = angles_over(turning_, end);
      tangent = {std::max(tangent.lo, angles.lo - clue.turn - box_[k]),
                 std::min(tangent.hi, angles.hi - clue.turn + box_[k])};
      if (!(tangent.lo <= tangent.hi)) return false;
      asked.push_back({angles.lo - clue.turn - slack_[k], angles.hi - clue.turn + slack_[k]});
    }
    return clues_.most_cost == 0 || least_cost(start, asked) <= clues_.most_cost;
  }

  /// A lower bound on the sum of squares, over all tangents at the start and all shared errors. As a function of the
  /// two together, x, it is convex: its slope is bisected, and the bound is where two tangents of it meet at worst.
  double least_cost(const Interval& start, const std::vector<Interval>& asked) const {
    const auto off = [](const Interval& range, double x) {
      return x < range.lo ? x - range.lo : std::max(0.0, x - range.hi);
    };
    const auto at = [&](double x) {
      double cost = 0;
      double slope = 0;
      for (std::size_t k = 0; k < asked.size(); ++k) {
        const double sd = clues_.clues[k].turn_sd;
        if (sd <= 0) continue;
        const double miss = off(asked[k], x) / sd;
        cost += miss * miss;
        slope += 2 * miss / sd;
      }
      if (clues_.shared_sd > 0) {
        const double miss = off(start, x) / clues_.shared_sd;
        cost += miss * miss;
        slope += 2 * miss / clues_.shared_sd;
      }
      return std::pair{cost, slope};
    };
    const double room = std::sqrt(clues_.most_cost) * clues_.shared_sd;
    double lo = start.lo - room;
    double hi = start.hi + room;
    auto [cost_lo, slope_lo] = at(lo);
    auto [cost_hi, slope_hi] = at(hi);
    constexpr int kHalvings = 12;
    for (int k = 0; k < kHalvings && slope_lo < 0 && slope_hi > 0; ++k) {
      const double middle = lo + 0.5 * (hi - lo);
      const auto [cost, slope] = at(middle);
      if (cost <= clues_.most_cost) return cost;  // that will do
      (slope < 0 ? lo : hi) = middle;
      (slope < 0 ? cost_lo : cost_hi) = cost;
      (slope < 0 ? slope_lo : slope_hi) = slope;
    }
    if (slope_lo >= 0) return cost_lo;
    if (slope_hi <= 0) return cost_hi;
    return std::max(cost_lo + slope_lo * (hi - lo), cost_hi + slope_hi * (lo - hi));
  }

  const Part& part_;
  const TurningFunction& turning_;
  const Clues& clues_;
  std::vector<double> slack_;
  std::vector<double> box_;
};

}  // namespace

Profile<kCells> profile_of(const Part& part) {
  Profile<kCells> profile;
  const double step = part.perimeter() / kCells;
  for (std::size_t k = 0; k < kCells; ++k) {
    const auto at = static_cast<double>(k);
    Interval arc{step * (at - kBeyondCell), step * (at + 1 + kBeyondCell)};
    if (!part.closed()) arc = {std::max(arc.lo, 0.0), std::min(arc.hi, part.perimeter())};
    const Interval angles = angles_over(part.turning(), arc);
    profile.least[k] = below(angles.lo);
    profile.most[k] = above(angles.hi);
  }
  return profile;
}

Profile<kCoarseCells> coarse_of(const Profile<kCells>& fine) {
  constexpr std::size_t kEach = kCells / kCoarseCells;
  Profile<kCoarseCells> coarse;
  for (std::size_t k = 0; k < kCoarseCells; ++k) {
    const auto least = fine.least.begin() + static_cast<std::ptrdiff_t>(k * kEach);
    const auto most = fine.most.begin() + static_cast<std::ptrdiff_t>(k * kEach);
    coarse.least[k] = *std::min_element(least, least + kEach);
    coarse.most[k] = *std::max_element(most, most + kEach);
  }
  return coarse;
}

std::string bytes_of(const Profile<kCells>& profile) {
  std::string bytes;
  for (const auto* cells : {&profile.least, &profile.most}) {
    for (const float value : *cells) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((bits >> shift) & 0xFFU));
    }
  }
  return bytes;
}

std::optional<Profile<kCells>> profile_from(std::string_view bytes) {
  if (bytes.size() != 2 * kCells * sizeof(float)) return std::nullopt;
  Profile<kCells> profile;
  std::size_t next = 0;
  for (auto* cells : {&profile.least, &profile.most}) {
    for (float& value : *cells) {
      std::uint32_t bits = 0;
      for (int shift = 0; shift < 32; shift += 8) {
        bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[next++])) << shift;
      }
      value = std::bit_cast<float>(bits);
    }
  }
  return profile;
}

std::uint64_t cells_left(const Profile<kCoarseCells>& profile, const Course& course, const Clues& clues) {
  return clues.fingers == 1 ? cells_of_one(profile, course, clues) : cells_of_two(profile, course, clues);
}

std::uint64_t cells_left(const Profile<kCells>& profile, const Course& course, const Clues& clues) {
  return clues.fingers == 1 ? cells_of_one(profile, course, clues) : cells_of_two(profile, course, clues);
}

bool may_start(const Part& part, const Clues& clues, std::uint64_t cells) {
  const Halving halving(part, clues);
  const double step = part.perimeter() / kCells;
  for (std::size_t k = 0; k < kCells; ++k) {
    if (((cells >> k) & 1U) == 0) continue;
    const auto at = static_cast<double>(k);
    if (halving.may_start({step * at, step * (at + 1)})) return true;
  }
  return false;
}

}  // namespace rollfix
