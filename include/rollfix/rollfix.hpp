#pragma once

// All that a user of the core needs, from the part to the answer. Apart are rollfix/files.hpp, parts from drawings and
// answers as JSON; rollfix/identify.hpp, which of many parts; rollfix/draw.hpp, the figures; rollfix/march.hpp, the
// published algorithms; and rollfix/rollfix.h for other languages.

// clang-format off
#include "rollfix/error.hpp"             // IWYU pragma: export  what is thrown
#include "rollfix/units.hpp"             // IWYU pragma: export  lengths as people write them
#include "rollfix/curve.hpp"             // IWYU pragma: export  points and curves
#include "rollfix/outline.hpp"           // IWYU pragma: export  what bounds a part
#include "rollfix/turning_function.hpp"  // IWYU pragma: export  its tangent's angle along it
#include "rollfix/part.hpp"              // IWYU pragma: export  a part, and where a finger can touch it
#include "rollfix/reading.hpp"           // IWYU pragma: export  length and turn, and how far off they may be
#include "rollfix/finger.hpp"            // IWYU pragma: export  disks, jaws, outlines
#include "rollfix/log.hpp"               // IWYU pragma: export  what sensors wrote
#include "rollfix/inspect.hpp"           // IWYU pragma: export  facts of a part
#include "rollfix/solve.hpp"             // IWYU pragma: export  one finger or two that roll
#include "rollfix/touch.hpp"             // IWYU pragma: export  touches and several rolls of a part at rest
#include "rollfix/hold.hpp"              // IWYU pragma: export  three fingers and more, or a wheel beside a jaw
#include "rollfix/question.hpp"          // IWYU pragma: export  whichever of these it is
#include "rollfix/advise.hpp"            // IWYU pragma: export  which contact to make next
#include "rollfix/tracker.hpp"           // IWYU pragma: export  row by row
#include "rollfix/certify.hpp"           // IWYU pragma: export  the proof
#include "rollfix/locate.hpp"            // IWYU pragma: export  the search alone
#include "rollfix/belief.hpp"            // IWYU pragma: export  the estimate alone
#include "rollfix/rolling.hpp"           // IWYU pragma: export  what a roll would write
#include "rollfix/plan.hpp"              // IWYU pragma: export  how to make it
#include "rollfix/teach.hpp"             // IWYU pragma: export  a part from a roll around it
#include "rollfix/pulse.hpp"             // IWYU pragma: export  to stop what takes long
// clang-format on
