#pragma once

#include <array>
#include <string>

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep
#include "rollfix/outline/curve.hpp"
#include "rollfix/outline/outline.hpp"

namespace rollfix {

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
/// name, or what else was felt.
void require_times(const Noise& noise, bool has_times, const std::string& what);

/// Throws InputError: a standard deviation that is not a finite number of at least 0.
void require_valid(const Noise& noise);

}  // namespace rollfix
