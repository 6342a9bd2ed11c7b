#pragma once

// All that a user of the library needs; drawings are apart, in rollfix/files/, and figures, in rollfix/draw/.

#include "rollfix/answer/answer.hpp"      // IWYU pragma: export
#include "rollfix/answer/next_roll.hpp"   // IWYU pragma: export
#include "rollfix/answer/solve.hpp"       // IWYU pragma: export
#include "rollfix/belief/advise.hpp"      // IWYU pragma: export
#include "rollfix/belief/belief.hpp"      // IWYU pragma: export
#include "rollfix/certify/certify.hpp"    // IWYU pragma: export
#include "rollfix/contact/finger.hpp"     // IWYU pragma: export
#include "rollfix/contact/log.hpp"        // IWYU pragma: export
#include "rollfix/contact/pose.hpp"       // IWYU pragma: export
#include "rollfix/contact/rig.hpp"        // IWYU pragma: export
#include "rollfix/contact/rolling.hpp"    // IWYU pragma: export
#include "rollfix/contact/teach.hpp"      // IWYU pragma: export
#include "rollfix/error.hpp"              // IWYU pragma: export
#include "rollfix/hold/hold.hpp"          // IWYU pragma: export
#include "rollfix/hold/next_pin.hpp"      // IWYU pragma: export
#include "rollfix/locate/locate.hpp"      // IWYU pragma: export
#include "rollfix/outline/curve.hpp"      // IWYU pragma: export
#include "rollfix/outline/outline.hpp"    // IWYU pragma: export
#include "rollfix/part/part.hpp"          // IWYU pragma: export
#include "rollfix/part/reach.hpp"         // IWYU pragma: export
#include "rollfix/plan/plan.hpp"          // IWYU pragma: export
#include "rollfix/question/question.hpp"  // IWYU pragma: export
#include "rollfix/touch/next_touch.hpp"   // IWYU pragma: export
#include "rollfix/touch/touch.hpp"        // IWYU pragma: export
#include "rollfix/watch/tracker.hpp"      // IWYU pragma: export
