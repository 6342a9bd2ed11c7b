#pragma once

#include "held_rows.hpp"

namespace rollfix::hold {

/// The same with neighbouring rows averaged, but for the first and the last one: of one finger beside wheels that move
/// smoothly, but for noise, to as few means as say what the rows say, and to no more than 512 anyway.
HeldRows averaged(const HeldRows& rows);

}  // namespace rollfix::hold
