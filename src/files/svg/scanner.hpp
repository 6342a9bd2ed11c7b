#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "files/svg/context.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::svg {

inline bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Reads the numbers of an attribute in SVG's grammar, in which nothing need stand between two of them where it is
/// clear without: "1.5.5-3" is three.
class Scanner {
 public:
  explicit Scanner(const Value& value)
      : value_(value), cursor_(value.text.data()), end_(value.text.data() + value.text.size()) {}

  bool at_end() const { return cursor_ == end_; }
  char peek() const { return *cursor_; }
  const char* cursor() const { return cursor_; }
  void advance() { ++cursor_; }

  void skip_spaces() {
    while (cursor_ != end_ && is_space(*cursor_)) ++cursor_;
  }

  /// Spaces with at most one comma among them; says whether there was one.
  bool skip_separator() {
    skip_spaces();
    if (cursor_ == end_ || *cursor_ != ',') return false;
    ++cursor_;
    skip_spaces();
    return true;
  }

  bool at_number() const {
    const char* look = cursor_;
    if (look != end_ && (*look == '+' || *look == '-')) ++look;
    if (look != end_ && *look == '.') ++look;
    return look != end_ && is_digit(*look);
  }

  double number(const char* what) {
    double number = 0;
    const char* const start = cursor_;
    if (!at_number() || !scan_number(cursor_, end_, number)) refuse(fmt::format("expected {}", what));
    if (!std::isfinite(number)) {
      value_.refuse(start, fmt::format("the number '{}' is too large", shown({start, length(start, cursor_)})));
    }
    return number;
  }

  /// An arc's flag: one digit, which the next number may touch.
  bool flag() {
    if (cursor_ == end_ || (*cursor_ != '0' && *cursor_ != '1')) refuse("expected an arc's flag, 0 or 1");
    return *cursor_++ == '1';
  }

  /// A word of letters, which may be empty.
  std::string_view word() {
    const char* const start = cursor_;
    while (cursor_ != end_ && is_letter(*cursor_)) ++cursor_;
    return {start, length(start, cursor_)};
  }

  /// Says what was found here instead of what was expected.
  [[noreturn]] void refuse(const std::string& expected) const {
    const std::string found =
        cursor_ == end_ ? "the end" : fmt::format("'{}'", shown({cursor_, length(cursor_, end_)}));
    value_.refuse(cursor_, fmt::format("{}, found {}", expected, found));
  }

 private:
  static std::size_t length(const char* from, const char* to) { return static_cast<std::size_t>(to - from); }

  const Value& value_;
  const char* cursor_;
  const char* end_;
};

}  // namespace rollfix::svg
