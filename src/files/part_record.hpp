#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "rollfix/part.hpp"

namespace rollfix {

/// Numbers one after the other, eight bytes each, the lowest first, on every machine.
class ByteWriter {
 public:
  void whole(std::uint64_t value) {
    std::array<char, 8> bytes;
    for (std::size_t k = 0; k < 8; ++k) bytes[k] = static_cast<char>((value >> (8 * k)) & 0xFFU);
    bytes_.append(bytes.data(), bytes.size());
  }
  void number(double value) { whole(std::bit_cast<std::uint64_t>(value)); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads them again. Behind the end it gives zeros and `ok` is false.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t whole() {
    if (bytes_.size() - next_ < 8) {
      ok_ = false;
      return 0;
    }
    const char* const at = bytes_.data() + next_;
    next_ += 8;
    std::uint64_t value = 0;
    if constexpr (std::endian::native == std::endian::little) {
      std::memcpy(&value, at, 8);
    } else {
      for (unsigned k = 0; k < 8; ++k) {
        value |= static_cast<std::uint64_t>(static_cast<unsigned char>(at[k])) << (8 * k);
      }
    }
    return value;
  }
  double number() { return std::bit_cast<double>(whole()); }
  bool ok() const { return ok_; }
  bool at_end() const { return next_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t next_ = 0;
  bool ok_ = true;
};

/// Base64, RFC 4648.
std::string to_base64(std::string_view bytes);

/// The bytes; `ok` becomes false where the text is not base64.
std::string from_base64(std::string_view text, bool& ok);

/// FNV-1a, eight bytes at a time. Whatever changes in one place changes the sum: each step is one to one.
std::uint64_t checksum(std::string_view bytes);

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
