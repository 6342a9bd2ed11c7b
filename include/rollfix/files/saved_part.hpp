#pragma once

#include <string>
#include <string_view>

#include "rollfix/part/part.hpp"

namespace rollfix {

/// A part's outline as the text of a file: JSON whose numbers are kept bit by bit, with a version and a checksum.
/// Throws InputError when the outline has curves of a type that can't be saved (one of the user's own, without
/// `record()`).
std::string format_part(const Part& part);

/// The part of such a text: it answers every question with the same bits as the one that was saved. `name` is what
/// messages call the text and becomes the part's name. Throws InputError: not such a text, of another version, or
/// changed since it was written.
Part parse_part(std::string_view text, const std::string& name);

/// Whether a JSON text says of itself, in its first field, that it is a saved part of whatever version.
bool is_saved_part(std::string_view text);

/// What the part of such a text, of one that parse_part takes, was called when it was saved.
std::string saved_name(std::string_view text);

/// Writes format_part to a file. Throws InputError also when it can't be written.
void save_part(const Part& part, const std::string& path);

}  // namespace rollfix
