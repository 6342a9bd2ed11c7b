#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

namespace rollfix::dxf {

/// A name or a text of the file in UTF-8: old files hold Windows-1252 and write other letters as \U+00E4.
std::string decoded(std::string_view text);

/// A piece of the file as a message can show it: on one line and not too long.
std::string shown(std::string_view text);

/// Names of layers and blocks are the same whatever the case of their letters.
std::string folded(std::string_view name);

/// The highest group code there is, and that of comments.
inline constexpr int kMostCode = 1071;
inline constexpr int kComment = 999;

/// One group of a DXF file: what it is about (the code) and the value. An ASCII file's values are all text until they
/// are asked for; a binary file's are what the code's type makes them.
struct Tag {
  int code = 0;
  std::size_t place = 0;  // the value's line from 1; of a binary file the group's first byte from 0
  std::variant<std::string_view, double, std::int64_t> value;
};

/// Goes through the groups of a file without copying it; comments (code 999) are passed over.
class TagReader {
 public:
  virtual ~TagReader() = default;

  /// The next group. It is an error to ask beyond 0 EOF: without one the file has been cut short.
  virtual void next(Tag& tag) = 0;

  /// "part.dxf:12" or "part.dxf: byte 340", for messages.
  virtual std::string where(std::size_t place) const = 0;
};

/// The group's value as text; empty for a number of a binary file.
std::string_view text_of(const Tag& tag);

/// Whether this is the group 0 that starts this kind of record.
bool starts(const Tag& tag, std::string_view record);

/// The group's value as a number. Throws InputError: not a number, not finite, above kMostCoordinate.
double real_of(const Tag& tag, const TagReader& reader);

/// The group's value as a whole number. Throws InputError otherwise.
std::int64_t whole_of(const Tag& tag, const TagReader& reader);

/// Throws InputError with the place in front of what is wrong there.
[[noreturn]] void refuse(const TagReader& reader, std::size_t place, const std::string& what);

/// The reader for these bytes, ASCII or binary, which must stay. Throws InputError when they are not a DXF file's.
std::unique_ptr<TagReader> open_tags(std::string_view bytes, const std::string& name);

}  // namespace rollfix::dxf
