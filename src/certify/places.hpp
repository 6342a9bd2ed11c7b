#pragma once

#include <vector>

#include "rollfix/certify.hpp"

namespace rollfix::certifying {

/// The least step between places: what a roll's end is known to, many times over.
double least_step(const Part& part);

/// Where s is by the outline's formulas.
CurvePlace place_of(const Part& part, double s);

/// Where curves start or end at rest.
std::vector<double> places_at_rest(const Part& part);

/// s moved ahead (or back, `way` -1) until the contacts that far along from it are clear of where curves meet.
double clear_of_joints(const Part& part, const std::vector<double>& lengths, double s, int way);

/// The first contacts whose rolls stay on an open outline, by less than can be told from its ends; on a closed one
/// [0, P]. Throws InputError where that leaves one at the most.
Interval clear_starts(const Part& part, const std::vector<double>& lengths);

/// What every certificate says of the outline. Throws InputError: a curve whose formula certificates don't have.
CertifiedOutline certified_outline(const Part& part);

}  // namespace rollfix::certifying
