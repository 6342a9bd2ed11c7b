#pragma once

#include "rollfix/answer/answer.hpp"
#include "rollfix/catalog/identify.hpp"

// How parts are weighed against each other.
namespace rollfix {

// A part that has less than exp(-this) of the likeliest one's weight is nothing: far less than is listed.
inline constexpr double kNothing = 20;

/// Of a part that something fits on.
PartWeight weight_of(std::size_t part, const Answer& answer);

/// The logarithm of a part's probability, up to what is the same for all.
double log_weight(const Catalog& catalog, const PartWeight& weight, double widened);

}  // namespace rollfix
