#pragma once

#include "rollfix/locate/locate_touches.hpp"

namespace rollfix::app {

/// Whether three or more fingers are meant, as many logs, or a wheel without skin is among them.
bool are_many_fingers(const RollArguments& arguments);

/// `locate` of three and more fingers, or of fingers beside wheels, on a part that is free to move. Throws InputError.
Report locate_hold(const RollArguments& arguments, const TouchOutput& output);

}  // namespace rollfix::app
