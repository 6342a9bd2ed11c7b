#pragma once

#include <string>
#include <vector>

#include "rollfix/finger_argument.hpp"
#include "rollfix/json_output.hpp"
#include "rollfix/locate/reachable.hpp"

namespace rollfix::app {

/// The placements that a finger makes impossible.
template <class Item>
struct Dropped {
  bool has_finger = false;  // without one nothing is dropped
  bool explain = false;     // --explain: list them
  std::vector<Item> items;
};

/// How far a disk or a jaw can reach. Throws InputError.
Reach reach_of(const Part& part, const Finger& finger);

/// {"reach": n}, of two fingers {"reach": n, "overlap": m}; {} without a finger.
Json dropped_json(const Dropped<Impossible>& dropped);
Json dropped_json(const Dropped<PairImpossible>& dropped);

/// For --explain: what became of each, a list.
Json impossible_json(const Dropped<Impossible>& dropped);
Json impossible_json(const Dropped<PairImpossible>& dropped);

/// "dropped    2 that the finger can't reach (--explain lists them)" and, where asked for, a line for each; empty when
/// nothing was dropped.
std::string dropped_text(const Dropped<Impossible>& dropped, const Part& part);
std::string dropped_text(const Dropped<PairImpossible>& dropped, const Part& part);

/// What to do when all were dropped.
std::string all_dropped_advice(std::size_t count);

/// "the disk would hit the part at s = 1.0, (2.0, 3.0), by 0.1": where a roll can't go on.
std::string about(const Obstruction& obstruction, const Part& part);

}  // namespace rollfix::app
