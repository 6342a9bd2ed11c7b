#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "rollfix/answer/answer.hpp"
#include "rollfix/draw/svg.hpp"

namespace rollfix {

/// Which of many parts a roll can have been on: those that remain side by side, each with its outline and its
/// placements as in AnswerFigure, though smaller. Up to 12 are drawn, and it is said how many more there are.
///
/// All are drawn to one scale, so that their sizes compare, unless they differ by more than 5 times: then each has a
/// scale of its own. With noise each has its probability, its rolls are drawn as strong as they are probable beside the
/// likeliest on that part, and the likeliest part is framed. Of two fingers the rolls of a part's first pair are drawn,
/// dots for the others.
struct PartsFigure {
  struct Entry {
    std::string name;
    double probability = std::numeric_limits<double>::quiet_NaN();  // that it is this part; NaN: no noise
    const Answer* answer = nullptr;                                 // of this part alone, not owned; required
    std::vector<std::string> congruent{};                           // parts that can't be told from it
  };

  std::vector<Entry> parts;  // with noise the likeliest first; none: nothing fits
  std::string verdict;
  std::size_t of = 0;  // so many parts were asked; 0: not said
  double rest = 0;     // with noise: probability of all parts that are not here
  double width = 0;    // pixels, at least 640; 0: 640 of one part, 960 of several
};

/// Throws InputError: an entry without an answer, a page that is too narrow.
Svg draw_parts(const PartsFigure& figure);

}  // namespace rollfix
