#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/hold.hpp"
#include "touch/touch_cases.hpp"

// Fingers that roll on a part that moves, drawn by a simulator that knows the outline's points, tangents and corners
// alone. Part and contacts move as they are told; where each finger is then follows from its contact, so that it rolls
// without slip: no dynamics are needed.
namespace hold_cases {

using namespace touch_cases;
using rollfix::Corner;
using rollfix::HoldAnswer;
using rollfix::HoldPlacement;
using rollfix::HoldProblem;
using rollfix::Log;

/// How fingers roll and are measured.
struct Holding {
  std::size_t fingers = 3;
  double length = 0.08;  // that a finger's centre goes, a share of the perimeter
  std::size_t rows = 40;
  double radius = 0.03;  // of the diagonal, as are the next two
  double contact_sd = 0;
  double place_sd = 0;
  double angle_sd = 0;  // radians
  bool centres = true;
  double slip_sd = 0;
  double radius_sd = 0;  // of each radius, as a share of it
};

struct HoldCase {
  HoldProblem problem;
  std::vector<double> starts;
  std::vector<double> ends;
  Pose first;
  Pose last;
};

/// Where a contact is, and how the tangent points there.
struct OnWay {
  double s = 0;
  double tangent = 0;
};

/// The way of a disk's contact from s on: along the boundary, and about each convex corner by its turn.
class Way {
 public:
  Way(const Part& part, double radius, double start, int direction)
      : part_(part), radius_(radius), start_(start), direction_(direction) {}

  /// After the way `gone`, at least 0: a pivot of a radian is a way of one radius.
  OnWay at(double gone) const {
    double s = start_;
    double left = gone;
    double tangent = part_.tangent(s);
    while (true) {
      const Corner* next = nullptr;
      double ahead = 1e300;
      for (const Corner& corner : part_.corners()) {
        double way = direction_ * (corner.s - s);
        if (part_.closed()) way = std::fmod(std::fmod(way, part_.perimeter()) + part_.perimeter(), part_.perimeter());
        if (way > 1e-9 * part_.perimeter() && way < ahead) {
          ahead = way;
          next = &corner;
        }
      }
      if (next == nullptr || left <= ahead) return along(s, left, tangent);
      tangent = along(s, ahead * (1 - 1e-9), tangent).tangent;
      left -= ahead;
      s += direction_ * ahead;
      const double pivot = std::min(left / radius_, next->turn);
      tangent += direction_ * pivot;
      left -= pivot * radius_;
      if (pivot < next->turn) return {s, tangent};
    }
  }

 private:
  /// Along a smooth stretch, followed in small steps.
  OnWay along(double s, double way, double tangent) const {
    constexpr int kSteps = 60;
    for (int k = 1; k <= kSteps; ++k) {
      const double at = s + direction_ * way * k / kSteps * (1 - 1e-12);
      tangent += rollfix::nearest_angle(part_.tangent(at) - tangent);
    }
    return {s + direction_ * way, tangent};
  }

  const Part& part_;
  double radius_;
  double start_;
  int direction_;
};

/// Whether the disk enters the part nowhere on its way.
inline bool is_free_way(const Part& part, const Way& way, double length, double radius,
                        const std::vector<Vec2>& boundary) {
  constexpr int kPlaces = 40;
  constexpr double kLarger = 1.05;
  const double from = std::min(way.at(0).s, way.at(length).s), to = std::max(way.at(0).s, way.at(length).s);
  for (const Corner& corner : part.corners()) {
    if (corner.turn < 0 && part.boundary().contains({from, to}, corner.s, 2 * radius)) return false;
  }
  for (int k = 0; k <= kPlaces; ++k) {
    const OnWay at = way.at(length * k / kPlaces);
    if (!part.closed() && (at.s < 0 || at.s > part.perimeter())) return false;
    const Vec2 centre = part.point(at.s) + kLarger * radius * outward(at.tangent);
    for (const Vec2& point : boundary) {
      if ((point - centre).norm() < kLarger * radius * (1 - 1e-3)) return false;
    }
  }
  return true;
}

/// How the part moves: as a share of the time that has gone.
inline Pose moved(const Pose& first, double share, double size) {
  return {first.x + 0.4 * size * share + 0.1 * size * std::sin(3 * share), first.y - 0.3 * size * share * share,
          first.heading + 0.7 * share - 0.3 * share * share};
}

/// One finger's log.
inline Log finger_log(const Part& part, const Way& way, double length, double radius, const Pose& first, double size,
                      const Holding& holding, double slowness, std::mt19937_64& generator) {
  Log log;
  log.name = "finger";
  rollfix::FingerRows& rows = log.fingers.front();
  rows.u_wrapped = rows.psi_wrapped = false;
  const double u_first = uniform(generator, -3, 3);
  const double slip = normal(generator, holding.slip_sd);
  const OnWay start = way.at(0);
  for (std::size_t k = 0; k <= holding.rows; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(holding.rows);
    const Pose pose = moved(first, share, size);
    const OnWay at = way.at(length * std::pow(share, slowness));
    const double u = u_first - (at.s - start.s) / radius;
    const double psi = at.tangent + pose.heading + 0.5 * std::numbers::pi - u;
    const Vec2 centre = pose.world(part.point(at.s) + radius * outward(at.tangent));
    rows.u.push_back(u_first + (u - u_first) * (1 + slip) + normal(generator, holding.contact_sd * size) / radius);
    rows.psi.push_back(psi + (u - u_first) * -slip + normal(generator, holding.angle_sd));
    log.time.push_back(0.1 * static_cast<double>(k));
    if (!holding.centres) continue;
    rows.x.push_back(centre.x() + normal(generator, holding.place_sd * size));
    rows.y.push_back(centre.y() + normal(generator, holding.place_sd * size));
  }
  return log;
}

/// A disk that starts at s and rolls forwards or backwards over a share of the perimeter.
struct Rolled {
  double start = 0;
  double length = 0;  // of its centre's way, below 0 for backwards; in perimeters
};

/// Fingers that roll so, without noise, at a fixed first pose.
inline HoldCase hold_of(const Part& part, const std::vector<Rolled>& rolled, const Holding& holding = {}) {
  std::mt19937_64 generator(5);
  const double size = diagonal(part);
  const double radius = holding.radius * size;
  HoldCase result{HoldProblem{part, {}, {rollfix::disk(radius)}}, {}, {}, {0.3 * size, -0.2 * size, 0.4}, {}};
  result.last = moved(result.first, 1, size);
  for (const Rolled& one : rolled) {
    const Way way(part, radius, one.start, one.length < 0 ? -1 : 1);
    const double length = std::abs(one.length) * part.perimeter();
    result.problem.logs.push_back(finger_log(part, way, length, radius, result.first, size, holding, 1, generator));
    result.starts.push_back(one.start);
    result.ends.push_back(way.at(length).s);
  }
  return result;
}

/// Of the finger's centre on the part, at each row.
inline std::vector<Vec2> track_of(const Part& part, const Way& way, double length, double radius, std::size_t rows,
                                  double slowness) {
  std::vector<Vec2> track;
  for (std::size_t k = 0; k <= rows; ++k) {
    const OnWay at = way.at(length * std::pow(static_cast<double>(k) / static_cast<double>(rows), slowness));
    track.push_back(part.point(at.s) + radius * outward(at.tangent));
  }
  return track;
}

/// Whether disks of this radius with such centres keep apart.
inline bool are_apart(const std::vector<Vec2>& one, const std::vector<Vec2>& other, double radius) {
  constexpr double kLarger = 1.1;
  for (std::size_t k = 0; k < one.size(); ++k) {
    if ((one[k] - other[k]).norm() < 2 * kLarger * radius) return false;
  }
  return true;
}

/// Fingers that enter neither the part nor each other.
inline HoldCase random_hold(const Part& part, const Holding& holding, std::mt19937_64& generator) {
  const double size = diagonal(part);
  const double said = holding.radius * size;
  const double length = holding.length * part.perimeter();
  const std::vector<Vec2> boundary = dense(part);
  HoldCase result{HoldProblem{part, {}, {rollfix::disk(said)}}, {}, {}, {}, {}};
  result.first = {uniform(generator, -size, size), uniform(generator, -size, size),
                  uniform(generator, -std::numbers::pi, std::numbers::pi)};
  result.last = moved(result.first, 1, size);
  std::vector<std::vector<Vec2>> tracks;
  while (result.problem.logs.size() < holding.fingers) {
    const int direction = uniform(generator, -1, 1) > 0 ? 1 : -1;
    const double radius = holding.radius_sd > 0 ? said * (1 + normal(generator, holding.radius_sd)) : said;
    const Way way(part, radius, uniform(generator, 0, part.perimeter()), direction);
    if (!is_free_way(part, way, length, radius, boundary)) continue;
    const double slowness = uniform(generator, 0.7, 1.6);
    const std::vector<Vec2> track = track_of(part, way, length, radius, holding.rows, slowness);
    if (!std::all_of(tracks.begin(), tracks.end(),
                     [&](const std::vector<Vec2>& other) { return are_apart(track, other, radius); })) {
      continue;
    }
    tracks.push_back(track);
    result.problem.logs.push_back(
        finger_log(part, way, length, radius, result.first, size, holding, slowness, generator));
    result.starts.push_back(way.at(0).s);
    result.ends.push_back(way.at(length).s);
  }
  if (holding.contact_sd > 0 || holding.angle_sd > 0) {
    rollfix::Noise noise;
    noise.contact = holding.contact_sd * size;
    noise.angle = holding.angle_sd;
    noise.slip = holding.slip_sd;
    noise.radius = holding.radius_sd * said;
    noise.position = holding.centres ? holding.place_sd * size : 0;
    result.problem.noise = noise;
  }
  return result;
}

/// Whether the answer's extents hold the true first contacts.
inline bool holds(const HoldPlacement& placement, const HoldCase& one, double slack = 0) {
  for (std::size_t k = 0; k < one.starts.size(); ++k) {
    if (!one.problem.part.boundary().contains(placement.contacts[k].extent, one.starts[k], slack)) return false;
  }
  return true;
}

/// The placement that is nearest to the truth: how far off its worst first contact is, length.
inline double nearest_miss(const HoldAnswer& answer, const HoldCase& one) {
  double least = 1e300;
  for (const HoldPlacement& placement : answer.placements) {
    double most = 0;
    for (std::size_t k = 0; k < one.starts.size(); ++k) {
      most = std::max(most, one.problem.part.distance(placement.contacts[k].start, one.starts[k]));
    }
    least = std::min(least, most);
  }
  return least;
}

}  // namespace hold_cases
