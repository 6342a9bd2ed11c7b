#pragma once

#include <string>

#include "rollfix/files/documents.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// "rollfix/locate/1" of touches: docs/json.md lists its fields.
std::string format_touches(const TouchAnswer& answer, Layout layout = Layout::lines);

}  // namespace rollfix
