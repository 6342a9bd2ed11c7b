#pragma once

#include <vector>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// Whether the pose of a set is in its extent. With noise it is the one that fits best, which may be another set's.
bool is_own(const TouchPose& pose);

/// Every set of poses within the tolerances, with noise those that its search starts from, that is in the extent of
/// none of these (whose own pose is in it): nothing is weighed, and nothing is left out as improbable or in the way.
/// A set of which it is not known whether a pose of its fits has no contacts, and no pose.
/// `rolls`: beside the problem's touches, by their readings alone; they stand first in `tolerance`, of all contacts.
/// Where no contact has a place x and y of an answer are NaN.
/// REQUIRES a valid problem of two contacts or more, without noise where there are rolls, and without logs, prior and
/// clear paths.
TouchAnswer poses_beyond(const TouchProblem& problem, const std::vector<RollSearched>& rolls,
                         const std::vector<TouchTolerance>& tolerance, const std::vector<TouchPose>& known);

}  // namespace rollfix::touch
