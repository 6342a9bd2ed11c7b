#pragma once

#include <string>

#include "rollfix/files/documents.hpp"
#include "rollfix/touch/next_touch.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// "rollfix/locate/1" of touches: docs/json.md lists its fields.
std::string format_touches(const TouchAnswer& answer, Layout layout = Layout::lines);

/// "rollfix/advise/1" of touches.
std::string format_next_touch(const TouchAnswer& answer, const NextTouch& next, Layout layout = Layout::lines);

}  // namespace rollfix
