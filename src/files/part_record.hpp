#pragma once

#include <string>
#include <string_view>

#include "rollfix/part.hpp"

namespace rollfix {

/// A part as its outline, in two byte strings that other programs can read too.
struct PartRecord {
  std::string outline;  // JSON: its name and kind, and its curves by kind; or the gallery's specification
  std::string numbers;  // of the curves in the order of that list, and the gap; little-endian doubles
};

/// What may stand behind the numbers: files of version 1 kept there what was computed of the outline.
enum class TrailingNumbers { refused, ignored };

/// Throws InputError when the outline has curves of a type that can't be recorded (one of the user's own, without
/// `record()`).
PartRecord record_of(const Part& part);

/// The part again, which answers with the same bits. `name` becomes the part's. Throws std::exception where the strings
/// are not such a record.
Part part_of(std::string_view outline, std::string_view numbers, const std::string& name,
             TrailingNumbers rest = TrailingNumbers::refused);

}  // namespace rollfix
