#include "steps.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "answer/steps.hpp"
#include "held_rows.hpp"
#include "log/log_rows.hpp"
#include "outline/turn.hpp"
#include "touch/steps.hpp"

// Logs without rows that jump away, and problems as they would be without a mistake. Notation:
//   jump            a row that a finger can't have been at, by how far it goes there and back: `without_strays`, asked
//                   forwards and, of the first rows, as if time went back
//   whose           all logs, or the number of one: none stands for all
//   factor          by what lengths or angles are multiplied where a unit was mistaken; n rows make the densities of
//                   their numbers n log(factor) more or less probable for each column: `log_stretch`
// Follows docs/two_fingers.md, "What may be wrong with three fingers"; which mistake it is hold_mistakes.cpp says.
namespace rollfix::hold {
namespace {

// The first rows, of which the search for jumps would take any for the roll, are looked at from behind.
constexpr std::size_t kFirstRows = 3;

/// Rows that jump away, from the log's first row on.
std::set<std::size_t> jumps_of(Log log, const HoldProblem& problem, std::size_t number) {
  log.fingers.front().line.clear();  // so that rows are reported by their numbers
  std::vector<std::size_t> numbers;
  // Only the numbers of the rows are asked for, from 1.
  without_strays(log, problem.part, {finger_of_log(problem, number)}, *problem.noise, &numbers);
  std::set<std::size_t> rows;
  for (const std::size_t one : numbers) rows.insert(one - 1);
  return rows;
}

/// The same from the last row on, as if time went back.
std::set<std::size_t> jumps_backwards(const Log& log, const HoldProblem& problem, std::size_t number) {
  const std::size_t count = log.rows();
  std::vector<std::size_t> rows;
  for (std::size_t row = count; row > 0; --row) rows.push_back(row - 1);
  Log back = with_rows(log, rows);
  // Times grow with the rows again.
  for (double& time : back.time) time = -time;
  std::set<std::size_t> found;
  for (const std::size_t row : jumps_of(std::move(back), problem, number)) found.insert(count - 1 - row);
  return found;
}

/// First those at the start, which would be taken for the roll, then the others.
std::set<std::size_t> jumps_in(const Log& log, const HoldProblem& problem, std::size_t number) {
  // Seen from the end, the roll is known before its first rows are looked at.
  const std::set<std::size_t> backwards = jumps_backwards(log, problem, number);
  std::size_t start = 0;
  // Rows from the first on, without a gap, that jump as seen from behind.
  while (start < kFirstRows && backwards.contains(start)) ++start;
  std::vector<std::size_t> rows;
  for (std::size_t row = start; row < log.rows(); ++row) rows.push_back(row);
  std::set<std::size_t> found;
  for (std::size_t row = 0; row < start; ++row) found.insert(row);
  for (const std::size_t row : jumps_of(with_rows(log, rows), problem, number)) found.insert(start + row);
  return found;
}

/// "b.csv, line 17"; of simulated rows their number.
std::string name_of_row(const Log& log, std::size_t row) {
  const std::vector<std::size_t>& lines = log.fingers.front().line;
  return row < lines.size() ? fmt::format("{}, line {}", log.name, lines[row])
                            : fmt::format("{}, row {}", log.name, row + 1);
}

// Angles that differ by less, in numbers, are not taken for degrees: a roll of two degrees says nothing.
constexpr double kLeastDegrees = 3;
// Fingers in another unit are no further apart than this share of the perimeter, and not all at one place.
constexpr double kMostApart = 2;
constexpr double kLeastApart = 0.02;

/// All logs of skins, or one: none stands for all. Those beside wheels are looked at one by one.
std::vector<std::optional<std::size_t>> whose_skins(const HoldProblem& problem) {
  std::vector<std::optional<std::size_t>> all;
  if (problem.wheels.empty()) all.emplace_back();
  for (std::size_t k = 0; k < problem.logs.size(); ++k) all.emplace_back(k);
  return all;
}

/// All logs, or one, wheels' as well.
std::vector<std::optional<std::size_t>> whose_logs(const HoldProblem& problem) {
  std::vector<std::optional<std::size_t>> all{std::nullopt};
  for (std::size_t k = 0; k < count_of_logs(problem); ++k) all.emplace_back(k);
  return all;
}

/// The problem with the rows of all logs, or of one, changed.
HoldProblem mended(const HoldProblem& problem, std::optional<std::size_t> whose,
                   const std::function<void(FingerRows&)>& mend) {
  HoldProblem result = problem;
  for (std::size_t k = 0; k < count_of_logs(result); ++k) {
    if (!whose || *whose == k) mend(log_of(result, k).fingers.front());
  }
  return result;
}

/// How many rows `whose` stands for.
double rows_of(const HoldProblem& problem, std::optional<std::size_t> whose) {
  return static_cast<double>(problem.logs.front().rows() * (whose ? 1 : count_of_logs(problem)));
}

/// Whether all columns have numbers as degrees of a roll would be.
bool may_be_degrees(const HoldProblem& problem, std::optional<std::size_t> whose,
                    const std::vector<RowColumn>& columns) {
  for (std::size_t k = 0; k < count_of_logs(problem); ++k) {
    if (whose && *whose != k) continue;
    for (const RowColumn column : columns) {
      if (range_of(log_of(problem, k).fingers.front().*column) < kLeastDegrees) return false;
    }
  }
  return true;
}

}  // namespace

/// Columns that the log lacks stay empty.
Log with_rows(const Log& log, const std::vector<std::size_t>& rows) {
  Log result = log;
  const auto choose = [&](auto& column, const auto& from) {
    if (from.size() != log.rows()) return;
    column.clear();
    for (const std::size_t row : rows) column.push_back(from[row]);
  };
  choose(result.time, log.time);
  const FingerRows& from = log.fingers.front();
  FingerRows& to = result.fingers.front();
  for (const auto column : kRowColumns) choose(to.*column, from.*column);
  choose(to.line, from.line);
  return result;
}

/// A row in which any finger jumps is taken out of all logs, so that row k stays one instant.
std::vector<std::string> leave_out_jumps(const HoldProblem& problem, std::vector<Log>& logs) {
  std::set<std::size_t> out;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < problem.logs.size(); ++k) {
    for (const std::size_t row : jumps_in(logs[k], problem, k)) {
      names.push_back(name_of_row(logs[k], row));
      out.insert(row);
    }
  }
  if (out.empty()) return names;
  std::vector<std::size_t> kept;
  for (std::size_t row = 0; row < logs.front().rows(); ++row) {
    if (!out.contains(row)) kept.push_back(row);
  }
  for (Log& log : logs) log = with_rows(log, kept);
  return names;
}

/// Each mistake for all logs of fingers, where no wheel is beside, and for each alone; of encoders psi alone.
std::vector<Mended> without_column_mistakes(const HoldProblem& problem) {
  const std::vector<RowColumn> u{&FingerRows::u}, psi{&FingerRows::psi}, both{&FingerRows::u, &FingerRows::psi};
  std::vector<Mended> all;
  // `log_stretch`: 0 where only the sign changes, or where what counts keeps its unit.
  const auto add = [&](HoldCause cause, std::optional<std::size_t> whose, double log_stretch, const auto& mend) {
    HoldDiagnosis what{cause};
    what.finger = whose;
    all.push_back({std::move(what), mended(problem, whose, mend), log_stretch});
  };
  for (const auto& whose : whose_skins(problem)) {
    add(HoldCause::u_clockwise, whose, 0, [&](FingerRows& rows) { multiply(rows, u, -1); });
    add(HoldCause::psi_clockwise, whose, 0, [&](FingerRows& rows) { multiply(rows, psi, -1); });
    add(HoldCause::both_clockwise, whose, 0, [&](FingerRows& rows) { multiply(rows, both, -1); });
    add(HoldCause::u_psi_swapped, whose, 0, swap_u_and_psi);
    // Of a row one angle counts, u + psi: it is in degrees only if both are.
    if (may_be_degrees(problem, whose, u))
      add(HoldCause::u_degrees, whose, 0, [&](FingerRows& rows) { multiply(rows, u, kDegree); });
    if (may_be_degrees(problem, whose, psi))
      add(HoldCause::psi_degrees, whose, 0, [&](FingerRows& rows) { multiply(rows, psi, kDegree); });
    if (may_be_degrees(problem, whose, both))
      add(HoldCause::angles_degrees, whose, rows_of(problem, whose) * std::log(kDegree),
          [&](FingerRows& rows) { multiply(rows, both, kDegree); });
  }
  for (std::size_t k = 0; k < problem.wheels.size(); ++k) {
    if (!problem.wheels[k].log.has_encoder()) continue;
    const std::size_t whose = problem.logs.size() + k;
    add(HoldCause::psi_clockwise, whose, 0, [&](FingerRows& rows) { multiply(rows, psi, -1); });
    if (may_be_degrees(problem, whose, psi))
      add(HoldCause::psi_degrees, whose, rows_of(problem, whose) * std::log(kDegree),
          [&](FingerRows& rows) { multiply(rows, psi, kDegree); });
  }
  return all;
}

/// Only where x and y are evidence.
std::vector<Mended> without_exchanged_axes(const HoldProblem& problem) {
  std::vector<Mended> all;
  if (problem.noise->position <= 0) return all;
  for (const auto& whose : whose_logs(problem)) {
    HoldDiagnosis what{HoldCause::x_y_swapped};
    what.finger = whose;
    all.push_back({std::move(what), mended(problem, whose, [](FingerRows& rows) { std::swap(rows.x, rows.y); })});
  }
  return all;
}

/// Only where x and y are evidence, and with the new unit the fingers are as far apart as on such a part.
std::vector<Mended> without_units(const HoldProblem& problem) {
  std::vector<Mended> all;
  if (problem.noise->position <= 0) return all;
  const std::vector<RowColumn> centre{&FingerRows::x, &FingerRows::y};
  for (const auto& whose : whose_logs(problem)) {
    for (const MistakenUnit& scale : kMistakenUnits) {
      HoldDiagnosis what{HoldCause::unit};
      what.finger = whose;
      what.factor = scale.factor;
      what.unit = scale.from;
      what.into = scale.to;
      HoldProblem without = mended(problem, whose, [&](FingerRows& rows) { multiply(rows, centre, scale.factor); });
      // The farthest that a log's first centre is from the first log's.
      double apart = 0;
      for (std::size_t k = 0; k < count_of_logs(without); ++k) {
        const FingerRows &one = log_of(without, k).fingers.front(), &first = without.logs.front().fingers.front();
        if (one.x.empty() || first.x.empty()) continue;
        apart = std::max(apart, std::hypot(one.x.front() - first.x.front(), one.y.front() - first.y.front()));
      }
      const double perimeter = problem.part.perimeter();
      // With this unit all centres would be at one place, or far beyond the part.
      if (apart < kLeastApart * perimeter || apart > kMostApart * perimeter) continue;
      // Two columns of each row.
      all.push_back({std::move(what), std::move(without), 2 * rows_of(problem, whose) * std::log(scale.factor)});
    }
  }
  return all;
}

/// Each pair of fingers that differ. With one finger for all logs there are none.
std::vector<Mended> without_swaps(const HoldProblem& problem) {
  std::vector<Mended> all;
  const std::vector<Finger>& fingers = problem.fingers;
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    for (std::size_t j = i + 1; j < fingers.size(); ++j) {
      const bool are_alike = fingers[i].name() == fingers[j].name() && fingers[i].outline() == fingers[j].outline() &&
                             fingers[i].length_per_u() == fingers[j].length_per_u();
      // Exchanged they would give the same problem.
      if (are_alike) continue;
      Mended one{{HoldCause::fingers_swapped}, problem};
      one.what.finger = i;
      one.what.other = j;
      std::swap(one.problem.fingers[i], one.problem.fingers[j]);
      all.push_back(std::move(one));
    }
  }
  return all;
}

/// Radii of disks, or of a wheel, times `scale`. None: no finger meant is a disk.
std::optional<HoldProblem> with_lengths(const HoldProblem& problem, std::optional<std::size_t> whose, double scale) {
  HoldProblem result = problem;
  // A wheel's length rolled is r times its turn.
  if (whose && *whose >= problem.logs.size()) {
    result.wheels[*whose - problem.logs.size()].radius *= scale;
    return result;
  }
  // One finger that held for all becomes one for each log.
  if (whose && result.fingers.size() == 1) result.fingers.assign(problem.logs.size(), problem.fingers.front());
  bool any = false;
  for (std::size_t k = 0; k < result.fingers.size(); ++k) {
    if ((whose && *whose != k) || !result.fingers[k].is_disk()) continue;
    // Lengths of a disk are r times angles; other fingers measure lengths themselves.
    result.fingers[k] = disk(scale * result.fingers[k].disk()->radius);
    any = true;
  }
  return any ? std::optional<HoldProblem>(std::move(result)) : std::nullopt;
}

/// Logs lose |rows| rows: the shifted one those at one end, the others those at the other. Times are those of a log
/// that is not shifted.
HoldProblem shifted(const HoldProblem& problem, std::size_t log, int rows) {
  HoldProblem result = problem;
  const std::size_t count = problem.logs.front().rows();
  const auto by = static_cast<std::size_t>(std::abs(rows));
  std::vector<std::size_t> first, last;
  for (std::size_t row = 0; row + by < count; ++row) {
    first.push_back(row);
    last.push_back(row + by);
  }
  for (std::size_t k = 0; k < count_of_logs(result); ++k) {
    // rows > 0: row k + rows of the log goes with row k of the others.
    log_of(result, k) = with_rows(log_of(problem, k), (k == log) == (rows > 0) ? last : first);
  }
  const std::vector<double> time = log_of(result, log == 0 ? 1 : 0).time;
  for (std::size_t k = 0; k < count_of_logs(result); ++k) log_of(result, k).time = time;
  return result;
}

/// Slip, radius and the part's own accuracy stay as they are. No angle's error exceeds what is taken as noise.
HoldProblem noisier(const HoldProblem& problem, double times) {
  HoldProblem result = problem;
  for (double* const sd : {&result.noise->contact, &result.noise->angle, &result.noise->position}) *sd *= times;
  result.noise->angle = std::min(result.noise->angle, BeliefOptions::kMostAngle);
  return result;
}

HoldProblem thinned(const HoldProblem& problem, std::size_t rows) {
  HoldProblem result = problem;
  const std::size_t last = problem.logs.front().rows() - 1;
  std::vector<std::size_t> chosen;
  const std::size_t steps = std::min(last, rows - 1);
  for (std::size_t k = 0; k <= steps; ++k) chosen.push_back(steps == 0 ? 0 : k * last / steps);
  for (std::size_t k = 0; k < count_of_logs(result); ++k) {
    FingerRows& of = log_of(result, k).fingers.front();
    if (!of.psi.empty()) {
      // Angles are unwrapped by all rows: between those that are left they may go more than half around.
      const std::vector<Contact> contacts = contacts_of(of, shape_of(problem, k));
      for (std::size_t row = 0; row < contacts.size(); ++row) {
        of.u[row] = contacts[row].u;
        of.psi[row] = contacts[row].psi;
      }
    }
    of.u_wrapped = of.psi_wrapped = false;
    log_of(result, k) = with_rows(log_of(result, k), chosen);
  }
  return result;
}

}  // namespace rollfix::hold
