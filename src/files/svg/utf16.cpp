#include "files/svg/utf16.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

constexpr std::uint32_t kHigh = 0xD800;  // the first half of a pair from here ...
constexpr std::uint32_t kLow = 0xDC00;   // ... to here, from which the second half goes ...
constexpr std::uint32_t kBeyond = 0xE000;
constexpr std::uint32_t kByteOrderMark = 0xFEFF;

}  // namespace

bool is_utf16(std::string_view text) {
  const std::string_view head = text.substr(0, 2);
  return head == "\xFF\xFE" || head == "\xFE\xFF" || head == std::string_view("<\0", 2) ||
         head == std::string_view("\0<", 2);
}

std::string utf8_from_utf16(std::string_view text, const std::string& name) {
  const bool little = text[0] == '\xFF' || text[0] == '<';
  const auto unit = [&](std::size_t k) {
    const auto first = static_cast<unsigned char>(text[k]);
    const auto second = static_cast<unsigned char>(text[k + 1]);
    return static_cast<std::uint32_t>(little ? first | second << 8 : first << 8 | second);
  };
  std::string result;
  for (std::size_t k = 0; k < text.size(); k += 2) {
    bool whole = k + 1 < text.size();
    std::uint32_t code = whole ? unit(k) : 0;
    if (code >= kHigh && code < kBeyond) {
      const std::uint32_t low = code < kLow && k + 3 < text.size() ? unit(k + 2) : 0;
      whole = low >= kLow && low < kBeyond;
      code = 0x10000 + ((code - kHigh) << 10) + (low - kLow);
      k += 2;
    }
    if (!whole || code == 0) throw InputError(fmt::format("{}: is broken UTF-16 text, at byte {}", name, k));
    if (code != kByteOrderMark) append_utf8(result, code);
  }
  return result;
}

}  // namespace rollfix
