#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace rollfix {

/// Without the blanks and ends of lines around it.
std::string_view trimmed(std::string_view text);

/// Without the UTF-8 byte order mark that some programs write first.
std::string_view without_mark(std::string_view text);

/// Whether it begins with UTF-16's byte order mark.
bool has_utf16_mark(std::string_view text);

/// The texts between separators, trimmed; one empty text when there is nothing.
std::vector<std::string_view> split(std::string_view text, char separator);

/// With a to z for A to Z; all else stays.
std::string lower_case(std::string_view text);

/// What follows the last dot of a file's name, in lower case: ".csv"; empty when there is none.
std::string ending_of(const std::string& path);

/// Text from outside, on one line: a tabulator becomes a blank; other control characters, those that turn the direction
/// of writing, and bytes that are no character become `instead`, so that it can neither break a table nor do anything
/// to a terminal.
std::string plain(std::string_view text, char instead = '?');

/// A word as a shell takes it for one, whatever is in it.
std::string quoted_for_shell(std::string_view word);

/// A piece of a user's text as a message can show it: on one line and not too long.
std::string shown(std::string_view text);

/// A point for a message: "(1.5, 0)", where rounding left (1.5, -1.8e-16).
std::string shown_point(double x, double y);

/// "1 curve", "2 curves".
std::string counted(std::size_t count, std::string_view one, std::string_view many);

/// With that many decimals; never "-0.000".
std::string fixed(double value, int decimals);

/// The name that takes the fewest edits (letters inserted, dropped, changed, or two neighbours swapped) to get
/// from what was typed, or else one that begins with it; empty when none is near enough to be what was meant.
std::string nearest_name(const std::string& typed, const std::vector<std::string>& names);

/// For an error message: "did you mean 'ellipse'? Known are: circle, ellipse", the question only where a name is near.
std::string known_names(const std::string& typed, const std::vector<std::string>& names);

/// How many bytes the UTF-8 character takes that a text, not empty, begins with; 0 where it begins with none.
std::size_t utf8_length(std::string_view text);

void append_utf8(std::string& text, char32_t character);

using OpenFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// A file that can be read, "-" for standard input. Throws InputError: missing, a directory, or not readable.
OpenFile open_text(const std::string& path);

/// The first bytes of a text, at most so many. Those of standard input can be read once only: they are kept for
/// read_text, or for whoever asks for them.
std::string beginning_of_text(const std::string& path, std::size_t most);
/// What was looked at of standard input and was not read since.
std::string take_looked_at();

/// The whole of a file, "-" for standard input. Throws InputError: missing, a directory, not readable, or a pipe or a
/// device without an end.
std::string read_text(const std::string& path);

/// Whether a file begins like one that gzip wrote.
inline bool is_gzip(std::string_view text) { return text.substr(0, 2) == "\x1F\x8B"; }

/// Whether the lines of a text end in carriage returns alone, as far as its beginning shows.
bool has_only_returns(std::string_view text);
/// What is wrong with such a file, and what makes another of it.
std::string about_only_returns(const std::string& name);

/// Whether a character of UTF-8 does something to a terminal: C0, DEL, C1, line ends, and marks of direction.
bool is_control(std::string_view character);

}  // namespace rollfix
