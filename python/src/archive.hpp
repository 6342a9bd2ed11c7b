#pragma once

#include <Eigen/Core>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/question.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"

// Values as bytes, for pickle and for ==. Each struct is taken apart by a structured binding, which does not compile
// when a field is added and not named here. Not for other machines or versions: no more than pickle promises.
namespace rollfix::python {

class Writer {
 public:
  static constexpr bool kReads = false;
  template <class T>
  void raw(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(const std::string& value) {
    raw(value.size());
    bytes_ += value;
  }
  std::string bytes() && { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  void raw(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(static_cast<void*>(&value), take(sizeof value).data(), sizeof value);
  }
  void text(std::string& value) {
    std::size_t size = 0;
    raw(size);
    value = take(size);
  }
  std::size_t left() const { return bytes_.size(); }
  /// Throws InputError unless all was read.
  void require_end() const {
    if (left() > 0) throw InputError("pickle: is longer than expected: made by another version of rollfix?");
  }

 private:
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) throw InputError("pickle: is cut short, or made by another version of rollfix");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  std::string_view bytes_;
};

template <class A, class... T>
void all(A& a, T&... values) {
  (visit(a, values), ...);
}

template <class A, class T>
std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>> visit(A& a, T& value) {
  a.raw(value);
}
template <class A>
void visit(A& a, std::string& value) {
  a.text(value);
}
template <class A, int Rows, int Columns, int Options>
void visit(A& a, Eigen::Matrix<double, Rows, Columns, Options>& matrix) {
  for (Eigen::Index k = 0; k < matrix.size(); ++k) a.raw(matrix.data()[k]);
}

template <class A, class T>
void visit(A& a, std::optional<T>& value);
template <class A, class T>
void visit(A& a, std::vector<T>& values);
template <class A, class T>
void visit(A& a, PerFinger<T>& values);
template <class A, class T>
void visit(A& a, ShortList<T>& values);

template <class A>
void visit(A& a, Interval& v) {
  auto& [lo, hi] = v;
  all(a, lo, hi);
}
template <class A>
void visit(A& a, Pivot& v) {
  auto& [start, end] = v;
  all(a, start, end);
}
template <class A>
void visit(A& a, Pose& v) {
  auto& [x, y, heading] = v;
  all(a, x, y, heading);
}
template <class A>
void visit(A& a, PoseSpread& v) {
  auto& [mean, covariance] = v;
  all(a, mean, covariance);
}
template <class A>
void visit(A& a, PoseResidual& v) {
  auto& [length, turn] = v;
  all(a, length, turn);
}
template <class A>
void visit(A& a, Reading& v) {
  auto& [length, turn, pivot] = v;
  all(a, length, turn, pivot);
}
template <class A>
void visit(A& a, Accuracy& v) {
  auto& [length, turn, alike, walk] = v;
  all(a, length, turn, alike, walk);
}
template <class A>
void visit(A& a, Noise& v) {
  auto& [contact, angle, slip, radius, position, correlation, drift, walk, gyro, part] = v;
  all(a, contact, angle, slip, radius, position, correlation, drift, walk, gyro, part);
}
template <class A>
void visit(A& a, Prior& v) {
  auto& [s, sd] = v;
  all(a, s, sd);
}
template <class A>
void visit(A& a, PosePrior& v) {
  auto& [mean, heading_sd, place_sd] = v;
  all(a, mean, heading_sd, place_sd);
}
template <class A>
void visit(A& a, Evidence& v) {
  auto& [peak, volume, gathered] = v;
  all(a, peak, volume, gathered);
}
template <class A>
void visit(A& a, Tolerance& v) {
  auto& [value, source] = v;
  all(a, value, source);
}
template <class A>
void visit(A& a, Verdict& v) {
  auto& [name, places, stretches, fits_badly] = v;
  all(a, name, places, stretches, fits_badly);
}
template <class A>
void visit(A& a, Sensitivity& v) {
  auto& [per_turn, per_length, per_facing] = v;
  all(a, per_turn, per_length, per_facing);
}
template <class A>
void visit(A& a, PlaceFound& v) {
  auto& [kind, start, end, extent, whole_loop, roots, error, residual, point, tangent, sensitivity, pivot, family,
         family_error, clockwise] = v;
  all(a, kind, start, end, extent, whole_loop, roots, error, residual, point, tangent, sensitivity, pivot, family,
      family_error, clockwise);
}
template <class A>
void visit(A& a, PlaceWeight& v) {
  auto& [probability, mean, sd, covariance, interval, end_mean, end_sd] = v;
  all(a, probability, mean, sd, covariance, interval, end_mean, end_sd);
}
template <class A>
void visit(A& a, PlacePoses& v) {
  auto& [pose, pose_residual, is_contradicted, pose_spread] = v;
  all(a, pose, pose_residual, is_contradicted, pose_spread);
}
template <class A>
void visit(A& a, Placement& v) {
  all(a, static_cast<PlaceFound&>(v), static_cast<PlaceWeight&>(v), static_cast<PlacePoses&>(v));
}
template <class A>
void visit(A& a, DroppedCounts& v) {
  auto& [reach, overlap, improbable] = v;
  all(a, reach, overlap, improbable);
}
template <class A>
void visit(A& a, Hit& v) {
  auto& [contact, s, depth, point] = v;
  all(a, contact, s, depth, point);
}
template <class A>
void visit(A& a, Obstruction& v) {
  auto& [s, concave_corner, hit] = v;
  all(a, s, concave_corner, hit);
}
template <class A>
void visit(A& a, Impossible& v) {
  auto& [placement, reason, finger, obstruction, instant, depth] = v;
  all(a, placement, reason, finger, obstruction, instant, depth);
}
template <class A>
void visit(A& a, SearchCounts& v) {
  auto& [intervals, evaluations] = v;
  all(a, intervals, evaluations);
}
template <class A>
void visit(A& a, DensityPiece& v) {
  auto& [s, probability] = v;
  all(a, s, probability);
}
template <class A>
void visit(A& a, Fit& v) {
  auto& [chi_square, freedom, sigmas, correlation, correlation_sigmas, trend_sigmas, row_sigmas, stray, prior_sigmas,
         excess, widened, alike_over, turn_gathered, length_scale, length_scale_sd, turn_scale, turn_scale_sd,
         turn_bias, turn_bias_sd] = v;
  all(a, chi_square, freedom, sigmas, correlation, correlation_sigmas, trend_sigmas, row_sigmas, stray, prior_sigmas,
      excess, widened, alike_over, turn_gathered, length_scale, length_scale_sd, turn_scale, turn_scale_sd, turn_bias,
      turn_bias_sd);
}
template <class A>
void visit(A& a, Weighing& v) {
  auto& [noise, prior, pose, robust, samples, fit, evidence, rest, improbable, density] = v;
  all(a, noise, prior, pose, robust, samples, fit, evidence, rest, improbable, density);
}
template <class A>
void visit(A& a, Mode& v) {
  auto& [start, end, tangent, probability, mean, sd, covariance, interval, region, end_mean, end_sd] = v;
  all(a, start, end, tangent, probability, mean, sd, covariance, interval, region, end_mean, end_sd);
}
template <class A>
void visit(A& a, ColumnSource& v) {
  auto& [column, name, unit] = v;
  all(a, column, name, unit);
}
template <class A>
void visit(A& a, Diagnosis& v) {
  auto& [cause, excess, log_odds, length_scale, length_scale_sd, finger, turn_scale, turn_scale_sd, noise_scale, noise,
         stray, slip, gyro, columns, verdict, modes] = v;
  all(a, cause, excess, log_odds, length_scale, length_scale_sd, finger, turn_scale, turn_scale_sd, noise_scale, noise,
      stray, slip, gyro, columns, verdict, modes);
}
template <class A>
void visit(A& a, CornerRows& v) {
  auto& [count, first, last] = v;
  all(a, count, first, last);
}
/// Without the part and the fingers, which Python pickles itself.
template <class A>
void visit(A& a, Answer& v) {
  auto& [part, fingers, readings, times, facing, tolerance, status, verdict, placements, pose_time, has_reach, dropped,
         impossible, unresolved, counts, weighing, diagnoses, strays, mirrored, either_way, other_way, lengths_reversed,
         corner_rows] = v;
  all(a, readings, times, facing, tolerance, status, verdict, placements, pose_time, has_reach, dropped, impossible,
      unresolved, counts, weighing, diagnoses, strays, mirrored, either_way, other_way, lengths_reversed, corner_rows);
}
template <class A>
void visit(A& a, Rounding& v) {
  auto& [length, turn] = v;
  all(a, length, turn);
}
template <class A>
void visit(A& a, Log& v);
template <class A>
void visit(A& a, PinLog& v) {
  auto& [rows] = v;
  all(a, rows);
}
template <class A>
void visit(A& a, PassiveWheel& v) {
  auto& [log, radius] = v;
  all(a, log, radius);
}
template <class A>
void visit(A& a, MeasuredTouch& v) {
  auto& [at, normal, position_sd, normal_sd] = v;
  all(a, at, normal, position_sd, normal_sd);
}
template <class A>
void visit(A& a, Clear& v) {
  auto& [from, to] = v;
  all(a, from, to);
}
template <class A>
void visit(A& a, TouchTolerance& v) {
  auto& [length, angle] = v;
  all(a, length, angle);
}
template <class A>
void visit(A& a, Measurements& v) {
  auto& [readings, roundings, rolls, wheels, touches, clear, at_rest] = v;
  all(a, readings, roundings, rolls, wheels, touches, clear, at_rest);
}
/// Without the part and the fingers, as an answer.
template <class A>
void visit(A& a, Question& v) {
  auto& [part, contacts, fingers, noise, tolerance, budget, facing, at, prior, pose, squeezed, direction, mirrored,
         robust, may_overlap, diagnose] = v;
  all(a, contacts, noise, tolerance, budget, facing, at, prior, pose, squeezed, direction, mirrored, robust,
      may_overlap, diagnose);
}
template <class A>
void visit(A& a, FingerRows& v) {
  auto& [name, line, u, psi, length, turn, x, y, u_period, place_rounding, angle_rounding, u_dimension, columns,
         distance, dturn, u_wrapped, psi_wrapped] = v;
  all(a, name, line, u, psi, length, turn, x, y, u_period, place_rounding, angle_rounding, u_dimension, columns,
      distance, dturn, u_wrapped, psi_wrapped);
}
template <class A>
void visit(A& a, Log& v) {
  auto& [name, kind, time, fingers, contact_was_off, unit, notes, skipped] = v;
  all(a, name, kind, time, fingers, contact_was_off, unit, notes, skipped);
}
template <class A>
void visit(A& a, Roll& v) {
  auto& [log, s, angle, pose] = v;
  all(a, log, s, angle, pose);
}
template <class A>
void visit(A& a, RollError& v) {
  auto& [slip, radius] = v;
  all(a, slip, radius);
}
template <class A>
void visit(A& a, NoisyRoll& v) {
  auto& [log, truth, error] = v;
  all(a, log, truth, error);
}
template <class A>
void visit(A& a, CurveRecord& v) {
  auto& [kind, numbers] = v;
  all(a, kind, numbers);
}
template <class A>
void visit(A& a, std::vector<Curve>& curves) {
  std::vector<CurveRecord> records;
  for (const Curve& curve : curves) records.push_back(curve.record().value());
  visit(a, records);
  if constexpr (A::kReads) {
    curves.clear();
    for (const CurveRecord& record : records) curves.push_back(curve_from(record));
  }
}
template <class A>
void visit(A& a, Outline& v) {
  auto& [name, curves, closed, reversed, hole, gallery, unit, gap, accuracy] = v;
  all(a, name, curves, closed, reversed, hole, gallery, unit, gap, accuracy);
}
template <class A>
void visit(A& a, Loop& v) {
  auto& [outline, first, length, area, depth, gap] = v;
  all(a, outline, first, length, area, depth, gap);
}

template <class A, class T>
void visit(A& a, std::optional<T>& value) {
  bool has = value.has_value();
  a.raw(has);
  if constexpr (A::kReads) {
    value.reset();
    if (has) value.emplace();
  }
  if (has) visit(a, *value);
}

template <class A, class T>
void visit(A& a, std::vector<T>& values) {
  std::size_t size = values.size();
  a.raw(size);
  if constexpr (A::kReads) {
    if (size > a.left()) throw InputError("pickle: is cut short, or made by another version of rollfix");
    values.assign(size, T{});
  }
  for (T& value : values) visit(a, value);
}

template <class A, class T>
void visit(A& a, PerFinger<T>& values) {
  std::size_t size = values.size();
  a.raw(size);
  if constexpr (A::kReads) values = PerFinger<T>::of(size);
  for (T& value : values) visit(a, value);
}

template <class A, class T>
void visit(A& a, ShortList<T>& values) {
  std::size_t size = values.size();
  a.raw(size);
  if constexpr (A::kReads) {
    values.clear();
    for (std::size_t k = 0; k < size && k <= a.left(); ++k) values.push_back(T{});
  }
  for (T& value : values) visit(a, value);
}

template <class T>
std::string bytes_of(const T& value) {
  Writer writer;
  visit(writer, const_cast<T&>(value));  // a writer changes nothing
  return std::move(writer).bytes();
}

/// Throws InputError: not made by bytes_of.
template <class T>
void read_bytes(std::string_view bytes, T& value) {
  Reader reader(bytes);
  visit(reader, value);
  reader.require_end();
}

}  // namespace rollfix::python
