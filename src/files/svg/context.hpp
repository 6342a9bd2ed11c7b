#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rollfix::svg {

/// The file as it was given: where something stands in it, and how to say so.
class Text {
 public:
  Text(std::string_view text, std::string name);

  /// The line of the byte at this offset, counted from 1.
  std::size_t line_at(std::size_t offset) const;

  /// Throws InputError "name:line: message".
  [[noreturn]] void refuse(std::size_t offset, const std::string& message) const;

 private:
  std::string name_;
  std::vector<std::size_t> newlines_;
  std::size_t size_;
};

/// An attribute's value with the place it stands at.
struct Value {
  const Text& file;
  std::string_view text;
  std::size_t offset = 0;  // of its first character in the file

  [[noreturn]] void refuse(const char* cursor, const std::string& message) const {
    file.refuse(offset + static_cast<std::size_t>(cursor - text.data()), message);
  }
};

}  // namespace rollfix::svg
