#pragma once

#include <string>
#include <string_view>

// A gyroscope's figures as its datasheet has them. `what` is what messages call the argument. Both throw InputError
// with the forms that are known.
namespace rollfix::app {

/// A rate or a bias: 10deg/h, 0.01deg/s, 5deg/min, or radians per second as a bare number. In radians per second.
double read_rate(std::string_view text, const std::string& what);

/// An angle random walk: 0.3deg/sqrt(h), 0.005deg/sqrt(s), also written as a rate's noise density, 0.005deg/s/sqrt(Hz);
/// or radians per square root of a second as a bare number. In radians per square root of a second.
double read_walk(std::string_view text, const std::string& what);

}  // namespace rollfix::app
