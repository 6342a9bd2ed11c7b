#include "files/byte_stream.hpp"

#include <array>

namespace rollfix {

namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 0xFF;

constexpr std::array<std::uint8_t, 256> digit_values() {
  std::array<std::uint8_t, 256> values{};
  for (std::uint8_t& value : values) value = kNoDigit;
  for (std::size_t k = 0; k < kDigits.size(); ++k) {
    values[static_cast<unsigned char>(kDigits[k])] = static_cast<std::uint8_t>(k);
  }
  return values;
}

constexpr std::array<std::uint8_t, 256> kValues = digit_values();

std::uint32_t byte_at(std::string_view bytes, std::size_t k) {
  return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U;
}

}  // namespace

std::string to_base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::uint32_t three = byte_at(bytes, k) << 16U | byte_at(bytes, k + 1) << 8U | byte_at(bytes, k + 2);
    for (std::uint32_t digit = 0; digit < 4; ++digit) {
      const bool is_padding = k + digit > bytes.size();
      text.push_back(is_padding ? '=' : kDigits[three >> (18 - 6 * digit) & 0x3FU]);
    }
  }
  return text;
}

std::string from_base64(std::string_view text, bool& ok) {
  ok = text.size() % 4 == 0;
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::string bytes;
  bytes.resize(text.size() / 4 * 3);
  std::size_t at = 0;
  std::uint32_t wrong = 0;
  for (std::size_t k = 0; k + 4 <= text.size(); k += 4) {
    std::uint32_t three = 0;
    for (std::size_t digit = 0; digit < 4; ++digit) {
      const bool is_padding = k + digit >= text.size() - padding;
      const std::uint32_t value = is_padding ? 0U : kValues[static_cast<unsigned char>(text[k + digit])];
      wrong |= value;
      three = three << 6U | (value & 0x3FU);
    }
    bytes[at++] = static_cast<char>(three >> 16U & 0xFFU);
    bytes[at++] = static_cast<char>(three >> 8U & 0xFFU);
    bytes[at++] = static_cast<char>(three & 0xFFU);
  }
  if (wrong > 0x3FU) ok = false;
  bytes.resize(at >= padding ? at - padding : 0);
  return bytes;
}

std::uint64_t checksum(std::string_view bytes) {
  constexpr std::uint64_t kPrime = 0x00000100000001B3U;
  std::uint64_t sum = 0xCBF29CE484222325U;
  ByteReader reader(bytes);
  for (std::size_t k = 0; k + 8 <= bytes.size(); k += 8) sum = (sum ^ reader.whole()) * kPrime;
  for (std::size_t k = bytes.size() / 8 * 8; k < bytes.size(); ++k) {
    sum = (sum ^ static_cast<unsigned char>(bytes[k])) * kPrime;
  }
  return sum;
}

}  // namespace rollfix
