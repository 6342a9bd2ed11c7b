#pragma once

#include "rollfix/answer/answer.hpp"

namespace rollfix {

/// From a part and a roll on it to every place where the roll can have started: the readings that are meant and the
/// tolerance that their digits or their noise ask for, the search, with noise the weighing of all rows, what the
/// fingers can't do, and where the part is in the world. One finger on a part at rest, or two on a part that is free to
/// move. Throws InputError: what `locate`, `readings`, `facing` and Belief throw, and a fact that does not go with the
/// others, by the name of the Problem's field.
Answer solve(const Problem& problem);

/// Whether it is known where such a finger can touch a part without entering it elsewhere: of disks and jaws.
bool has_reach(const Finger& finger);

/// How far it can reach. REQUIRES has_reach(finger). Throws InputError as reach_of_disk does.
Reach reach_of(const Part& part, const Finger& finger);

}  // namespace rollfix
