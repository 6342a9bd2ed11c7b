#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "text/number.hpp"
#include "text/text.hpp"

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

/// A number with a unit.
struct Length {
  double number = 0;
  std::string_view unit;  // "", "px", "mm", "%", ...

  /// In a unit of the world: millimetres, not pixels.
  bool is_physical() const;
  /// In user units of 1/96 inch; `whole` is what 100% is. Nothing for a unit that depends on a font or a window.
  std::optional<double> in_user_units(double whole) const;
};

/// Nothing for "auto". Throws InputError with the place: not a number with or without a unit.
std::optional<Length> parse_length(const Value& value);

/// Millimetres in a user unit.
inline constexpr double kUserUnit = 25.4 / 96;

/// An XML file whose root is <svg>, with the places of its elements and attributes.
class Document {
 public:
  /// Throws InputError: compressed, not text, not XML (with the line), not an SVG.
  Document(std::string_view text, const std::string& name);

  pugi::xml_node root() const { return root_; }
  const Text& text() const { return *text_; }

  std::size_t offset_of(pugi::xml_node node) const;
  std::size_t line_of(pugi::xml_node node) const { return text_->line_at(offset_of(node)); }
  [[noreturn]] void refuse(pugi::xml_node node, const std::string& message) const;

  /// What SVG calls the element: "path" for <path> and for <svg:path>; empty for a foreign one or no element.
  std::string_view kind(pugi::xml_node node) const;

  /// An attribute's value without space around it; nothing where it is missing.
  std::optional<Value> attribute(pugi::xml_node node, const char* name) const;

  /// A property from the `style` attribute, or else from the attribute of that name; empty where there is neither.
  std::string_view property(pugi::xml_node node, const char* name) const;

 private:
  Value value_of(const pugi::xml_attribute& attribute) const;

  std::string buffer_;  // pugixml parses it in place: what it gives out points into it
  std::optional<Text> text_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::string prefix_;  // "svg:" where the file writes <svg:path>
};

/// A property of a `style` attribute's text; nothing where it is not there.
std::optional<std::string_view> style_property(std::string_view style, std::string_view name);

}  // namespace rollfix::svg
