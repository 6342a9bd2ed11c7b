#pragma once

#include <string>

#include "rollfix/solve.hpp"

namespace rollfix::answer {

/// Both answers to one roll as one: every placement says which way round it is an answer. With noise each way is
/// weighed by its evidence, both being as likely beforehand.
Answer either_of(Answer counter_clockwise, Answer clockwise);
/// The one answer there is, where the rows can't have gone the other way at all, and why they can't.
Answer only_way(Answer answer, const std::string& why_not_the_other);

}  // namespace rollfix::answer
