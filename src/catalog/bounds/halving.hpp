#pragma once

#include "cells.hpp"
#include "clue.hpp"
#include "rollfix/part.hpp"

namespace rollfix {

/// Whether one finger's roll can have started anywhere in these cells: they are halved, with bounds from the part
/// itself, until nothing is left or halves are not worth looking at any more.
bool may_start(const Part& part, const Clues& clues, const Cells<kFineCells>& cells);

}  // namespace rollfix
