#include "rollfix/rolling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rollfix/error.hpp"

namespace rollfix {
namespace {

/// The chord of an arc of this length that turns by this angle.
double chord_of(double length, double turn) {
  const double half = 0.5 * turn;
  return std::abs(half) < 1e-8 ? length : length * std::sin(half) / half;
}

}  // namespace

std::vector<ReckonedRow> dead_reckoned(const Log& log, const std::optional<Finger>& finger) {
  const bool is_contact = log.kind == LogKind::contact;
  if (log.fingers.size() > 1) throw InputError(fmt::format("{}: expected the log of one finger, found two", log.name));
  if (is_contact && (!finger || !finger->is_disk())) {
    throw InputError(fmt::format("{}: a log of u and psi takes a disk to add up, found none", log.name));
  }
  const FingerRows& felt = log.fingers[0];
  std::vector<Reading> readings = readings_as_given(log, finger ? std::vector<Finger>{*finger} : std::vector<Finger>{});
  if (!is_contact) readings.insert(readings.begin(), Reading{0, 0});
  const bool backwards = readings.back().length[0] < 0;
  if (backwards) std::reverse(readings.begin(), readings.end());

  ReckonedRow row;
  const double first_length = readings.front().length[0], first_turn = readings.front().turn;
  double direction = 0;
  if (is_contact) {
    const std::size_t k = backwards ? log.rows() - 1 : 0;
    const double facing = felt.u[k] + felt.psi[k];
    direction = facing - 0.5 * std::numbers::pi;
    const bool has_place = !felt.x.empty() && !felt.y.empty();
    if (has_place) {
      row.point = Vec2(felt.x[k], felt.y[k]) + finger->length_per_u() * Vec2(std::cos(facing), std::sin(facing));
    }
  }
  std::vector<ReckonedRow> rows;
  for (const Reading& reading : readings) {
    const double s = reading.length[0] - first_length, angle = direction + reading.turn - first_turn;
    if (!rows.empty()) {
      const double middle = 0.5 * (row.angle + angle);
      row.point += chord_of(s - row.s, angle - row.angle) * Vec2(std::cos(middle), std::sin(middle));
    }
    row.s = s;
    row.angle = angle;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace rollfix
