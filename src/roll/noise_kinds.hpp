#pragma once

#include <initializer_list>
#include <string_view>

#include "rollfix/reading.hpp"

namespace rollfix {

/// What a problem knows of noise: every kind that it does not is 0. So a new kind is refused until a problem names it.
/// Throws InputError: "noise of touches is position and angle, found slip=0.01; leave it out".
void require_kinds(const Noise& noise, std::initializer_list<double Noise::*> known, std::string_view of_what);

/// The same sensors, `times` as noisy as stated: what each row has on its own, its contact, its orientation and its
/// centre.
Noise with_rows_as_noisy(const Noise& noise, double times);

}  // namespace rollfix
