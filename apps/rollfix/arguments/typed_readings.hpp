#pragma once

#include <string>
#include <vector>

#include "rollfix/part.hpp"
#include "rollfix/question.hpp"

namespace rollfix::app {

/// Half a unit of the last digit of an angle as typed, radians.
double half_unit_of_angle(const std::string& angle);

/// --reading as typed, each LENGTH,TURN or LENGTH_A,LENGTH_B,TURN, with how far their digits may be off. A turn that
/// was likely meant in degrees is told in the notes. Throws InputError.
Measurements read_readings(const std::vector<std::string>& readings, const Part& part, std::vector<std::string>& notes);

}  // namespace rollfix::app
