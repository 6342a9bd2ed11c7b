#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rollfix::app {

/// How many characters a line of the terminal has, as COLUMNS or the terminal itself says; 80 where neither does.
std::size_t terminal_width();

/// A paragraph in lines of at most so many characters, all but the first after as many blanks; a longer word has a line
/// of its own.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent);

/// A page's examples, in which what a shell reads begins with two blanks: such a line goes on after a backslash, and
/// what is said of it stands above it; all others are paragraphs.
std::string wrapped_examples(std::string_view text, std::size_t width);

}  // namespace rollfix::app
