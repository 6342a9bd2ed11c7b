#include "bounds.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

// Notation, as in docs/identify.md, "How parts are ruled out":
//   N, i            cells of equal length, and the one that the roll starts in; four at a time: `Four`
//   [least, most]   Theta on a cell, or over all cells in which a roll may end: Profile, Laps::angles
//   L, theta, eps   a reading and its slack: `clue.length`, `Row::turn`, `Row::slack`
//   tau             the tangent at the start: in [least - theta - eps, most - theta + eps] of each reading: Tangents
//   sd              errors that only one reading has and one that all share: `turn_sd`, `shared_sd`; their squares may
//                   come to `most_cost` together
// Follows eqs. (4), (5), and of two fingers (8), (9) of the paper (Jia, IROS 2001); docs/identify.md as above.
// Idea: a cell is left where the intervals of tau of all readings meet. Bounds are covers and roundings go outwards, so
// that no start that fits is lost. Of two fingers pairs of cells are compared, and what both turn must differ by theta.
namespace rollfix::catalog {
namespace {

// The least of no cells; its negative is the most of none: an empty interval.
constexpr float kNothingYet = std::numeric_limits<float>::infinity();
// Of sums of squares in single precision, as a share.
constexpr double kCostRounding = 1e-2;
// Of a length, in cells: beyond that they can't be told from each other.
constexpr double kMostCells = 1e9;

/// The largest whole number that is not above the value, which has to be one of 64 bits.
std::int64_t floor_of(double value) {
  const auto towards_zero = static_cast<std::int64_t>(value);
  return towards_zero - (static_cast<double>(towards_zero) > value ? 1 : 0);
}

/// The cells of one larger cell, side by side.
using Four = Eigen::Array4f;
using Cells4 = Eigen::Map<const Four>;

/// Where rolls end that start in cell i: in `count` cells from i + `first` on, counted in Laps.
struct Ends {
  std::size_t first = 0;
  std::size_t count = 0;  // 0: nowhere on an open boundary
  float lift = 0;         // of whole laps that were taken off
};

/// Bounds on Theta over cells in a row: of a closed boundary over three laps, of an open one with nothing on either
/// side of it.
template <std::size_t N>
class Laps {
 public:
  Laps(const Profile<N>& profile, const Course& course)
      : closed_(course.closed), perimeter_(course.perimeter), cells_per_length_(N / perimeter_) {
    for (std::size_t lap = 0; lap < kLaps; ++lap) {
      const float lift = static_cast<float>(lap) * course.period_turn;
      const bool is_there = closed_ || lap == kOpenLap;
      for (std::size_t k = 0; k < N; ++k) {
        least_[lap * N + k] = is_there ? profile.least[k] + (closed_ ? lift : 0) : kNothingYet;
        most_[lap * N + k] = is_there ? profile.most[k] + (closed_ ? lift : 0) : -kNothingYet;
      }
    }
    period_turn_ = course.period_turn;
  }

  /// False: the length is known too badly to say.
  bool ends(double length, double length_slack, Ends& ends) const {
    const double slack = length_slack + kShareRounding * (std::abs(length) + perimeter_);
    const double from = (length - slack) * cells_per_length_;
    const double to = (length + slack) * cells_per_length_;
    constexpr auto kN = static_cast<std::int64_t>(N);
    // Not known to within a lap, or so long that single cells are lost in rounding: the reading says nothing.
    if (!(to - from <= N && std::abs(from) <= kMostCells)) return false;
    const std::int64_t first = floor_of(from);
    const std::int64_t last = floor_of(to) + 1;  // rolls that start at the end of a cell
    if (last - first >= kN) return false;
    ends = {};
    // Whole laps are taken off, each with its turn: `first` is in [0, N), and i + first + count stays within three
    // laps.
    if (closed_) {
      const std::int64_t lap = (first >= 0 ? first : first - kN + 1) / kN;
      ends.first = static_cast<std::size_t>(first - lap * kN);
      ends.count = static_cast<std::size_t>(last - first + 1);
      ends.lift = static_cast<float>(lap) * period_turn_;
    } else if (first < kN && last > -kN) {
      // Ends before the boundary and behind it are cells of the empty laps: they leave the bounds as they are.
      const std::int64_t on_it = std::max(first, -kN);
      ends.first = static_cast<std::size_t>(on_it + kN);
      ends.count = static_cast<std::size_t>(std::min(last, kN - 1) - on_it + 1);
    }
    return true;
  }

  double laps_per_length() const { return cells_per_length_ / N; }  // 1 / P

  /// Where the tangents may point at the ends of rolls that start in each of the four cells from i on.
  void angles(const Ends& ends, std::size_t i, Four& least, Four& most) const {
    // The cells that a roll from cell i ends in are `count` neighbours; lane by lane those of the next starts.
    least.setConstant(kNothingYet);
    most.setConstant(-kNothingYet);
    for (std::size_t k = ends.first + i; k < ends.first + i + ends.count; ++k) {
      least = least.min(Cells4(&least_[k]));
      most = most.max(Cells4(&most_[k]));
    }
    least += ends.lift;
    most += ends.lift;
  }

 private:
  static constexpr std::size_t kLaps = 3;
  static constexpr std::size_t kOpenLap = 1;  // where an open boundary lies: rolls may end on either side of it

  bool closed_;
  double perimeter_;
  double cells_per_length_;
  float period_turn_ = 0;               // turn of a lap, radians
  std::array<float, kLaps * N> least_;  // Theta on each cell, lap after lap
  std::array<float, kLaps * N> most_;
};

/// How far the turn may be off in single precision.
float slack_in_cells(const Clue& clue, const Course& course, double laps_per_length) {
  const double most_curvature = course.most_curvature * (1 + kShareRounding);
  double slack = clue.slack(most_curvature);
  // Rounding of single precision: of sums of a few turns, and of each whole lap that is added as a turn.
  for (const double length : clue.length) {
    const double laps = course.closed ? std::abs(length) * laps_per_length + 2 : 1;
    slack += kTurnRounding + kShareRounding * (std::abs(clue.turn) + laps * std::abs(course.period_turn));
  }
  return static_cast<float>(slack * (1 + kShareRounding));
}

/// What the tangent at the start may be in four cells, as far as is known.
struct Tangents {
  std::size_t larger;  // the cell that these four lie in
  Four least;          // radians; above `most`: that cell is ruled out
  Four most;

  /// Whether any of the four cells is left.
  bool is_any() const { return (most - least).maxCoeff() >= 0; }
};

/// What one reading says of all cells.
struct Row {
  Ends ends;     // where it ends, from each cell
  float turn;    // radians
  float slack;   // as if its own error were none, and ...
  float reach;   // ... with the most that it can be
  float weight;  // 1 / its variance; 0: there is none
};

/// What a reading says of all cells; nothing where its length is known too badly.
template <std::size_t N>
std::optional<Row> row_of(const Laps<N>& laps, const Course& course, const Clues& clues, const Clue& clue) {
  Row row;
  if (!laps.ends(clue.length[0], clue.length_slack, row.ends)) return std::nullopt;
  row.turn = static_cast<float>(clue.turn);
  row.slack = slack_in_cells(clue, course, laps.laps_per_length());
  row.reach = row.slack;
  row.weight = 0;
  if (clues.most_cost > 0) {
    // If all of `most_cost` is this row's, its own error is sqrt(most_cost) sd; the shared one likewise.
    const double most_error = std::sqrt(clues.most_cost) * (clue.turn_sd + clues.shared_sd);
    row.reach += static_cast<float>(most_error * (1 + kShareRounding));
    if (clue.turn_sd > 0) row.weight = static_cast<float>(1 / (clue.turn_sd * clue.turn_sd));
  }
  return row;
}

/// Takes out what would need larger errors than all readings can have together.
template <std::size_t N>
void drop_costly(const Profile<N>& profile, const Laps<N>& laps, const Clues& clues, const std::vector<Row>& rows,
                 std::array<Tangents, N / 4>& tangents, std::size_t& left) {
  // Rounded up: a sum that is too large by rounding must not rule out a cell.
  const auto enough = static_cast<float>(clues.most_cost * (1 + kCostRounding));
  std::vector<Asked<Four>> asked;
  // Tangents that are left move to the front, in place: [0, left) of those that were looked at.
  const std::size_t count = left;
  left = 0;
  for (std::size_t k = 0; k < count; ++k) {
    Tangents one = tangents[k];
    asked.clear();
    for (const Row& row : rows) {
      if (row.weight == 0) continue;
      Four least;
      Four most;
      laps.angles(row.ends, 4 * one.larger, least, most);
      asked.push_back({least - row.turn - row.slack, most - row.turn + row.slack, row.weight});
    }
    const Start<Four> start{Cells4(&profile.least[4 * one.larger]), Cells4(&profile.most[4 * one.larger]),
                            static_cast<float>(clues.shared_sd)};
    const auto is_too_much = (least_cost(start, asked, enough) > enough).eval();
    one.most = is_too_much.select(-kNothingYet, one.most);
    if (one.is_any()) tangents[left++] = one;
  }
}

/// Each reading confines the tangent at the start further, until nothing is left of most cells.
template <std::size_t N>
Cells<N> cells_of_one(const Profile<N>& profile, const Course& course, const Clues& clues, const Cells<N / 4>& within) {
  // Four cells are looked at together. Invariant: tau of [0, left) is what all readings so far leave of it.
  std::array<Tangents, N / 4> tangents;
  std::size_t left = 0;
  // Of the larger cells that are left all four: tau is one of the tangents on them.
  for (std::size_t k = 0; k < N / 4; ++k) {
    if (within[k]) tangents[left++] = {k, Cells4(&profile.least[4 * k]), Cells4(&profile.most[4 * k])};
  }
  const Laps<N> laps(profile, course);
  std::vector<Row> rows;
  for (const Clue& clue : clues.clues) {
    const std::optional<Row> row = row_of(laps, course, clues, clue);
    // Says nothing: no cell is lost by it.
    if (!row) continue;
    if (clues.most_cost > 0) rows.push_back(*row);
    const std::size_t count = left;
    left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      Tangents one = tangents[k];
      Four least;
      Four most;
      laps.angles(row->ends, 4 * one.larger, least, most);
      // tau is in [least - theta - eps, most - theta + eps]: eq. (5) over cells.
      one.least = one.least.max(least - row->turn - row->reach);
      one.most = one.most.min(most - row->turn + row->reach);
      tangents[left] = one;
      left += one.is_any() ? 1 : 0;
    }
    // Nothing is left of any cell: the part is ruled out.
    if (left == 0) break;
  }
  // First each row by itself, which is cheap, then all together.
  if (clues.most_cost > 0 && left > 0) drop_costly(profile, laps, clues, rows, tangents, left);
  Cells<N> cells;
  for (std::size_t k = 0; k < left; ++k) {
    const Tangents& one = tangents[k];
    for (Eigen::Index lane = 0; lane < 4; ++lane) {
      cells[4 * one.larger + static_cast<std::size_t>(lane)] = one.least[lane] <= one.most[lane];
    }
  }
  return cells;
}

/// How far the tangent may turn on the way of one of two fingers, for each cell that it may start in.
template <std::size_t N>
struct Turned {
  std::array<float, N> least;
  std::array<float, N> most;
};

/// Bounds on Theta(end) - Theta(start) of one finger, for each cell: the least end less the largest start, and the
/// other way round.
template <std::size_t N>
Turned<N> turned(const Profile<N>& profile, const Laps<N>& laps, const Ends& ends) {
  Turned<N> turned;
  for (std::size_t i = 0; i < N; i += 4) {
    Four least;
    Four most;
    laps.angles(ends, i, least, most);
    Eigen::Map<Four>(&turned.least[i]) = least - Cells4(&profile.most[i]);
    Eigen::Map<Four>(&turned.most[i]) = most - Cells4(&profile.least[i]);
  }
  return turned;
}

/// What one reading of two fingers says.
template <std::size_t N>
struct PairRow {
  Turned<N> a;
  Turned<N> b;
  float turn = 0;
  float slack = 0;
};

template <std::size_t N>
std::vector<PairRow<N>> pair_rows(const Profile<N>& profile, const Course& course, const Clues& clues) {
  const Laps<N> laps(profile, course);
  std::vector<PairRow<N>> rows;
  for (const Clue& clue : clues.clues) {
    Ends of_a;
    Ends of_b;
    const bool is_known =
        laps.ends(clue.length[0], clue.length_slack, of_a) && laps.ends(clue.length[1], clue.length_slack, of_b);
    // One of both lengths is known too badly: the reading says nothing.
    if (!is_known) continue;
    rows.push_back({turned(profile, laps, of_a), turned(profile, laps, of_b), static_cast<float>(clue.turn),
                    slack_in_cells(clue, course, laps.laps_per_length())});
  }
  return rows;
}

/// Whether the facing, with any whole number of turns added, lies in [lo, hi], radians.
bool faces(double facing, double lo, double hi) {
  // The least number of turns that brings it to `lo` or above.
  const double turns = std::ceil((lo - facing) / (2 * std::numbers::pi));
  return facing + 2 * std::numbers::pi * turns <= hi;
}

/// Pairs of cells: the cell that finger a starts in is left where any cell of finger b's goes with it. O(N^2) for each
/// reading. The tangents at both starts have to differ by the facing, and what both tangents turn by theta: eqs. (8)
/// and (9) over cells.
template <std::size_t N>
Cells<N> cells_of_two(const Profile<N>& profile, const Course& course, const Clues& clues, const Cells<N / 4>& within) {
  const std::vector<PairRow<N>> rows = pair_rows(profile, course, clues);
  const double slack = clues.facing_slack + clues.facing_slack_by_curvature * course.most_curvature + kTurnRounding;
  Cells<N> left;
  // For each start of finger a all starts of finger b side by side.
  for (std::size_t i = 0; i < N; ++i) {
    if (!within[i / 4]) continue;
    std::array<std::uint8_t, N> goes;  // with cell j of finger b's
    for (std::size_t j = 0; j < N; ++j) {
      goes[j] = static_cast<std::uint8_t>(
          !clues.facing || faces(*clues.facing, static_cast<double>(profile.least[i]) - profile.most[j] - slack,
                                 static_cast<double>(profile.most[i]) - profile.least[j] + slack));
    }
    for (const PairRow<N>& row : rows) {
      // Phi_b has to be Phi_a - theta: the intervals have to meet.
      const float lo = row.a.least[i] - row.turn - row.slack;
      const float hi = row.a.most[i] - row.turn + row.slack;
      for (std::size_t j = 0; j < N; ++j) {
        const bool both = lo <= row.b.most[j] && hi >= row.b.least[j];
        goes[j] = static_cast<std::uint8_t>(both ? goes[j] : 0);
      }
    }
    left[i] = std::any_of(goes.begin(), goes.end(), [](std::uint8_t one) { return one != 0; });
  }
  return left;
}

}  // namespace

template <std::size_t N>
Cells<N> cells_left(const Profile<N>& profile, const Course& course, const Clues& clues, const Cells<N / 4>& within) {
  return clues.fingers == 1 ? cells_of_one(profile, course, clues, within)
                            : cells_of_two(profile, course, clues, within);
}

template Cells<kCoarseCells> cells_left(const Profile<kCoarseCells>&, const Course&, const Clues&,
                                        const Cells<kCoarseCells / 4>&);
template Cells<kCells> cells_left(const Profile<kCells>&, const Course&, const Clues&, const Cells<kCoarseCells>&);
template Cells<kFineCells> cells_left(const Profile<kFineCells>&, const Course&, const Clues&, const Cells<kCells>&);

}  // namespace rollfix::catalog
