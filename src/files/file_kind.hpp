#pragma once

#include <string>
#include <string_view>

namespace rollfix {

/// What a user can name as a part.
enum class FileKind { gallery, points, dxf, svg, json, saved_part };

/// By "gallery:" or the ending of the file's name; standard input ("-") counts as points until it is read.
/// Throws InputError for any other ending.
FileKind kind_by_name(const std::string& argument);

/// The same once the content is known: of standard input by how it begins, and whether a .json is a saved part.
FileKind kind_by_content(FileKind by_name, bool is_standard_input, std::string_view text);

}  // namespace rollfix
