#pragma once

// What sensors say between two instants, and how far off that may be.
//
//     const Reading one(1.0, 0.5);           // length on the part, turn in radians
//     const Reading two(0.58, 0.94, -0.725);  // of two fingers: both lengths, the difference of the turns
//     two.fingers();                          // 2

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"

namespace rollfix {

/// One entry for each finger, one or two, kept in place.
template <class T>
class PerFinger {
 public:
  PerFinger() = default;                                 // of one finger
  PerFinger(T only) : entries_{std::move(only), T{}} {}  // NOLINT: one finger's is an entry
  PerFinger(T of_a, T of_b) : entries_{std::move(of_a), std::move(of_b)}, size_(2) {}
  PerFinger(const std::array<T, 2>& of_both) : entries_(of_both), size_(2) {}  // NOLINT: it is of both fingers
  /// The same for each of so many fingers, 1 or 2.
  static PerFinger of(std::size_t fingers, const T& entry = T{}) {
    return fingers == 2 ? PerFinger(entry, entry) : PerFinger(entry);
  }

  std::size_t size() const { return size_; }
  T& operator[](std::size_t finger) { return entries_[finger]; }
  const T& operator[](std::size_t finger) const { return entries_[finger]; }
  T* begin() { return entries_.data(); }
  T* end() { return entries_.data() + size_; }
  const T* begin() const { return entries_.data(); }
  const T* end() const { return entries_.data() + size_; }

  bool operator==(const PerFinger& other) const {
    return size_ == other.size_ && entries_[0] == other.entries_[0] && (size_ == 1 || entries_[1] == other.entries_[1]);
  }

 private:
  std::array<T, 2> entries_{};
  std::size_t size_ = 1;
};

/// A list that is mostly short: up to two entries are kept in place.
template <class T>
class ShortList {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return size_ > kInPlace ? many_.data() : few_.data(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return size_ > kInPlace ? many_.data() : few_.data(); }
  const T* end() const { return begin() + size_; }
  T& operator[](std::size_t k) { return begin()[k]; }
  const T& operator[](std::size_t k) const { return begin()[k]; }
  const T& front() const { return *begin(); }
  const T& back() const { return end()[-1]; }

  void push_back(T entry) {
    if (size_ < kInPlace) {
      few_[size_++] = std::move(entry);
      return;
    }
    if (size_ == kInPlace) many_.assign(few_.begin(), few_.end());
    many_.push_back(std::move(entry));
    ++size_;
  }
  void clear() {
    many_.clear();
    size_ = 0;
  }

 private:
  static constexpr std::size_t kInPlace = 2;
  std::array<T, kInPlace> few_{};
  std::vector<T> many_;
  std::size_t size_ = 0;
};

/// What the sensors say of one instant, measured from the first contact: of one finger on a part that does not move
/// (L, theta), of two on a part that may have moved in the meantime (La, Lb, theta), eqs. (7)-(9).
struct Reading {
  Reading() = default;
  Reading(double travelled, double turned) : length(travelled), turn(turned) {}
  Reading(double length_a, double length_b, double turned) : length(length_a, length_b), turn(turned) {}

  PerFinger<double> length;  // arc length travelled on the part, positive along the stored outline; may exceed P
  double turn = 0;           // theta: total curvature along it, Phi(s0, s0 + L), of two fingers
                             // Phi(s0, s0 + La) - Phi(t0, t0 + Lb); radians, unwrapped, may exceed pi in size
  double pivot = 0;          // of a contact on a corner of the finger: theta is anywhere in turn -+ pivot, radians

  std::size_t fingers() const { return length.size(); }
  bool is_exact() const { return pivot == 0; }  // but for noise and digits
};

/// How far the rounding of written numbers can have moved something.
struct Rounding {
  double length = 0;  // in the outline's unit; of two fingers both lengths' together
  double turn = 0;    // radians
};

/// Where a part is in the world: the place of its frame's origin there, and how its frame is turned.
struct Pose {
  double x = 0;
  double y = 0;
  double heading = 0;  // radians, counter-clockwise

  /// A vector of the part's frame as the world sees it.
  Vec2 turned(const Vec2& vector) const {
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    return {c * vector.x() - s * vector.y(), s * vector.x() + c * vector.y()};
  }
  /// A point of the part's frame as the world sees it.
  Vec2 world(const Vec2& point) const { return Vec2(x, y) + turned(point); }
};

/// A pose with noise, and how sure it is: of x, y and heading.
struct PoseSpread {
  Pose mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // length^2, length times radians, radians^2
};

/// How far sensors are off: standard deviations.
struct Noise {
  double contact = 0;      // of a contact's place along the outline, in its unit, each row on its own
  double angle = 0;        // of a turn, radians, each row on its own
  double slip = 0;         // of the length travelled, per length
  double radius = 0;       // of the finger's radius, in the outline's unit
  double position = 0;     // of each coordinate of a finger's centre, each row on its own; 0: centres are not looked at
  double correlation = 0;  // over this length of a roll rows are off alike; at rest all are
  double drift = 0;        // of a gyroscope's rate all along a roll, its bias, radians per second
  double walk = 0;  // of what a gyroscope's turn gathers, its angle random walk, radians per square root of a second
  double gyro = 0;  // of a gyroscope's scale: of all turns that it measures, per turn
  Accuracy part{};  // of the outline that is rolled on: `noise_on` puts it here
};

/// One of them: what it is called, wherever users read or type it, and in what it is measured.
struct NoiseKind {
  enum class Unit { length, angle, share, rate, walk };
  const char* name;
  double Noise::*sd;
  Unit unit;
};
inline constexpr std::array<NoiseKind, 9> kNoiseKinds = {{{"contact", &Noise::contact, NoiseKind::Unit::length},
                                                          {"angle", &Noise::angle, NoiseKind::Unit::angle},
                                                          {"slip", &Noise::slip, NoiseKind::Unit::share},
                                                          {"radius", &Noise::radius, NoiseKind::Unit::length},
                                                          {"position", &Noise::position, NoiseKind::Unit::length},
                                                          {"correlation", &Noise::correlation, NoiseKind::Unit::length},
                                                          {"drift", &Noise::drift, NoiseKind::Unit::rate},
                                                          {"walk", &Noise::walk, NoiseKind::Unit::walk},
                                                          {"gyro", &Noise::gyro, NoiseKind::Unit::share}}};

class Part;
enum class LogKind;

/// What a gyroscope's integrated turn gathers over so many laps, from one time of the roll to another in seconds from
/// its start: the variance, radians^2. With neither `drift` nor `walk`, a log of length and turn is taken to drift over
/// a perimeter as much as one row is off, `angle`; all others do not.
double drift_variance(const Noise& noise, LogKind kind, double laps, const Interval& seconds);

// Beyond these a row says nothing, and a number was meant otherwise.
inline constexpr double kMostLengthNoise = 1;   // of a contact or a radius, in perimeters
inline constexpr double kMostPlaceNoise = 1e6;  // of a centre or a correlation, in perimeters
inline constexpr double kMostSlip = 1;          // per length, half of it may be slip; likewise of a gyroscope's scale
inline constexpr double kMostRate = 10;         // of drift and walk, radians per second, or per square root of one

/// The noise of a roll on this part: that of the sensors, and what the part's own outline is off by. Throws InputError:
/// noise beyond those bounds.
Noise noise_on(const Part& part, const Noise& sensors);

/// Throws InputError: a log without times with a noise of `drift` or `walk`, which gather with time. `what`: the log's
/// name, or what else was measured.
void require_times(const Noise& noise, bool has_times, const std::string& what);

/// Throws InputError: a standard deviation that is not a finite number of at least 0.
void require_valid(const Noise& noise);

}  // namespace rollfix
