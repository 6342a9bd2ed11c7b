#pragma once

#include <optional>
#include <vector>

#include "rollfix/finger.hpp"
#include "rollfix/log.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// The noise that a log's rows seem to have, as they jitter beside a smooth course: none where they don't, or where
/// there are too few to tell.
std::optional<Noise> noise_that_shows(const Log& log, const std::vector<Finger>& fingers);

/// How far the fingers' centres in the world, as a log has them, jitter beside a smooth course: the largest standard
/// deviation of a coordinate; 0 where they don't, or where there are too few rows to tell.
double jitter_of_centres(const Log& log);

/// Half a unit of the last decimal that any of the numbers shows; 0: they show more than can be told.
double rounding_of_column(const std::vector<double>& values);

}  // namespace rollfix
