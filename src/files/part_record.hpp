#pragma once

#include <string>
#include <string_view>

#include "rollfix/part/part.hpp"

namespace rollfix {

/// A part as two byte strings that other programs can read too: what it is, and what was computed of it.
struct PartRecord {
  std::string outline;   // JSON: its name and kind, and its curves by kind; or the gallery's specification
  std::string numbers;   // of the curves in the order of that list, and the gap; little-endian doubles
  std::string computed;  // of the turning function, the parametrization, corners, inflections, vertices
};

/// Whatever changes in `computed` takes another number, and older ones are computed anew.
inline constexpr int kComputedFormat = 1;

/// Throws InputError when the outline has curves of a type that can't be recorded (one of the user's own, without
/// `record()`).
PartRecord record_of(const Part& part);

/// The part again, with the same bits. `name` becomes the part's. Throws std::exception where the strings are not
/// such a record.
Part part_of(std::string_view outline, std::string_view numbers_and_computed, const std::string& name);

/// The same from the outline alone: all is computed anew.
Part rebuilt_part(std::string_view outline, std::string_view numbers, const std::string& name);

}  // namespace rollfix
