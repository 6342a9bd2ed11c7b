#pragma once

#include <string>

namespace rollfix::app {

/// The library's text for who typed options: it names the fields of its structs, `allow_crossing`, and this
/// --allow-crossing.
std::string with_options(std::string text);

}  // namespace rollfix::app
