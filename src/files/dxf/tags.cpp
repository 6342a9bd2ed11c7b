#include "files/dxf/tags.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include "outline/box.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::dxf {

namespace {

std::string value_shown(const Tag& tag) {
  if (const auto* text = std::get_if<std::string_view>(&tag.value)) return shown(*text);
  if (const auto* number = std::get_if<double>(&tag.value)) return fmt::format("{}", *number);
  return fmt::format("{}", std::get<std::int64_t>(tag.value));
}

}  // namespace

std::string_view text_of(const Tag& tag) {
  const auto* text = std::get_if<std::string_view>(&tag.value);
  return text != nullptr ? *text : std::string_view();
}

bool starts(const Tag& tag, std::string_view record) { return tag.code == 0 && text_of(tag) == record; }

void refuse(const TagReader& reader, std::size_t place, const std::string& what) {
  throw InputError(reader.where(place) + ": " + what);
}

double real_of(const Tag& tag, const TagReader& reader) {
  double number = 0;
  if (const auto* text = std::get_if<std::string_view>(&tag.value)) {
    const std::optional<double> read = parse_number(*text);
    if (!read) refuse(reader, tag.place, fmt::format("'{}' is not a number (group code {})", shown(*text), tag.code));
    number = *read;
  } else if (const auto* real = std::get_if<double>(&tag.value)) {
    number = *real;
  } else {
    number = static_cast<double>(std::get<std::int64_t>(tag.value));
  }
  if (!(std::abs(number) <= kMostCoordinate)) {
    refuse(reader, tag.place,
           fmt::format("'{}' (group code {}) is out of range, expected a finite number of at most {}", value_shown(tag),
                       tag.code, kMostCoordinate));
  }
  return number;
}

std::int64_t whole_of(const Tag& tag, const TagReader& reader) {
  if (const auto* whole = std::get_if<std::int64_t>(&tag.value)) return *whole;
  if (const auto* text = std::get_if<std::string_view>(&tag.value)) {
    std::int64_t whole = 0;
    const char* const end = text->data() + text->size();
    const auto result = std::from_chars(text->data(), end, whole);
    if (result.ec == std::errc() && result.ptr == end) return whole;
  }
  refuse(reader, tag.place, fmt::format("'{}' is not a whole number (group code {})", value_shown(tag), tag.code));
}

namespace {

/// Windows-1252 differs from Latin-1 here, 0x80 to 0x9f; 0 where it has no letter.
constexpr std::array<std::uint16_t, 32> kWindowsLetters = {
    0x20ac, 0,      0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021, 0x02c6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017d, 0,      0,      0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
    0x2013, 0x2014, 0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0,      0x017e, 0x0178};

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text.substr(at));
    if (length == 0) return false;
    at += length;
  }
  return true;
}

unsigned windows_letter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  if (byte < 0x80 || byte >= 0xa0) return byte;
  const unsigned letter = kWindowsLetters.at(byte - 0x80U);
  return letter != 0 ? letter : '?';
}

/// The letter of \U+00E4 at the start of the text, 0 when it does not start so.
unsigned escaped_letter(std::string_view text) {
  constexpr std::size_t kLength = 7;
  if (text.size() < kLength || text[0] != '\\' || (text[1] != 'U' && text[1] != 'u') || text[2] != '+') return 0;
  unsigned letter = 0;
  const auto [end, error] = std::from_chars(text.data() + 3, text.data() + kLength, letter, 16);
  const bool is_surrogate = 0xd800 <= letter && letter < 0xe000;
  return error == std::errc() && end == text.data() + kLength && !is_surrogate ? letter : 0;
}

}  // namespace

std::string decoded(std::string_view text) {
  const bool as_it_is = is_utf8(text);
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    if (const unsigned letter = escaped_letter(text.substr(at)); letter != 0) {
      append_utf8(result, letter);
      at += 7;
    } else if (as_it_is) {
      result += text[at++];
    } else {
      append_utf8(result, windows_letter(text[at++]));
    }
  }
  return result;
}

std::string shown(std::string_view text) { return rollfix::shown(decoded(text)); }

std::string folded(std::string_view name) {
  std::string result(name);
  for (char& c : result) {
    if ('a' <= c && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return result;
}

}  // namespace rollfix::dxf
