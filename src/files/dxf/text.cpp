#include "files/dxf/text.hpp"

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>

#include "text/text.hpp"

namespace rollfix::dxf {

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
