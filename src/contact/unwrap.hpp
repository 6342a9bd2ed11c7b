#pragma once

#include "rollfix/contact/log.hpp"

namespace rollfix {

/// Throws InputError when a reader of these rows would take angles as wrapped that are not.
void require_readable(const Log& log);

}  // namespace rollfix
