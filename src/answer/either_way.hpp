#pragma once

#include <string>

#include "rollfix/solve.hpp"

namespace rollfix {

/// What a mirror shows of a part that lies face down: the part as it was drawn, and what was felt with the other signs.
/// (L, theta) and (u, psi) become (-L, -theta) and (-u, pi - psi), of a jaw (-u, -psi), a centre (x, y) becomes (-x,
/// y). So every place that is found is one of the outline as it is stored. A finger with an outline is its own mirror's
/// image there.
Problem in_mirror(const Problem& problem);

/// The answer to that, as the world has it: readings, sensitivities and facing with their own signs, and poses of the
/// part face down: turn its mirror image (-x, y) by the heading, then move it to x and y.
void out_of_mirror(const Problem& problem, Answer& answer);

/// The problem with lengths that count clockwise: all of them change their signs. Throws InputError: a log of u and
/// psi, which say themselves which way round it went.
Problem counted_clockwise(const Problem& problem);

/// Both answers to one roll as one: every placement says which way round it is an answer. With noise each way is
/// weighed by its evidence, both being as likely beforehand.
Answer either_of(Answer counter_clockwise, Answer clockwise);
/// The one answer there is, where the rows can't have gone the other way at all, and why they can't.
Answer only_way(Answer answer, bool is_clockwise, const std::string& why_not_the_other);

}  // namespace rollfix
