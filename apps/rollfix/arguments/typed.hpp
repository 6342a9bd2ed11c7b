#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/curve.hpp"
#include "rollfix/part.hpp"
#include "rollfix/question.hpp"
#include "rollfix/units.hpp"
#include "text/number.hpp"  // IWYU pragma: export  written_length, written_angle

namespace rollfix::app {

// Numbers on the command line. `what` begins an error: "--start 5x". All throw InputError.

/// A finite number.
double read_number(std::string_view text, const std::string& what);

/// A finite length, in the part's unit: bare, or with a unit as in 8mm, where the part's (empty: not known) is known.
double read_length(std::string_view text, const std::string& what, const std::string& part_unit);

/// A whole number of at least `least`.
std::size_t read_count(std::string_view text, const std::string& what, std::size_t least);

// A gyroscope's figures as its datasheet has them. `what` is what messages call the argument. Both throw InputError
// with the forms that are known.

/// A rate or a bias: 10deg/h, 0.01deg/s, 5deg/min, or radians per second as a bare number. In radians per second.
double read_rate(std::string_view text, const std::string& what);

/// An angle random walk: 0.3deg/sqrt(h), 0.005deg/sqrt(s), also written as a rate's noise density, 0.005deg/s/sqrt(Hz);
/// or radians per square root of a second as a bare number. In radians per square root of a second.
double read_walk(std::string_view text, const std::string& what);

/// --travel as typed: a length either way, or BACK,FORWARD. `unit`: the part's. Throws InputError.
Interval read_travel(const std::string& text, const std::string& unit);

/// Half a unit of the last digit of an angle as typed, radians.
double half_unit_of_angle(const std::string& angle);

/// --reading as typed, each LENGTH,TURN or LENGTH_A,LENGTH_B,TURN, with how far their digits may be off. A turn that
/// was likely meant in degrees is told in the notes. Throws InputError.
Measurements read_readings(const std::vector<std::string>& readings, const Part& part, std::vector<std::string>& notes);

}  // namespace rollfix::app
