#pragma once

#include <string>
#include <string_view>

namespace rollfix {

/// Whether a text begins with UTF-16's byte order mark, or with '<' in UTF-16.
bool is_utf16(std::string_view text);

/// The same text in UTF-8. Throws InputError: half a character.
std::string utf8_from_utf16(std::string_view text, const std::string& name);

}  // namespace rollfix
