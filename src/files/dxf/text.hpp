#pragma once

#include <string>
#include <string_view>

namespace rollfix::dxf {

/// A name or a text of the file in UTF-8: old files hold Windows-1252 and write other letters as \U+00E4.
std::string decoded(std::string_view text);

/// A piece of the file as a message can show it: on one line and not too long.
std::string shown(std::string_view text);

/// Names of layers and blocks are the same whatever the case of their letters.
std::string folded(std::string_view name);

}  // namespace rollfix::dxf
