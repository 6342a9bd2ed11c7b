#include "files/dxf/read.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <system_error>

#include "outline/box.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::dxf {
namespace {

constexpr const char* kCutShort =
    "the file ends here, expected a last line EOF: it has been cut short, export it again";

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
    if (!read)
      refuse(reader, tag.place,
             fmt::format("expected a number behind group code {}, found '{}'", tag.code, shown(*text)));
    number = *read;
  } else if (const auto* real = std::get_if<double>(&tag.value)) {
    number = *real;
  } else {
    number = static_cast<double>(std::get<std::int64_t>(tag.value));
  }
  if (!(std::abs(number) <= kMostCoordinate)) {
    refuse(reader, tag.place,
           fmt::format("expected a finite number of at most {} behind group code {}, found '{}'", kMostCoordinate,
                       tag.code, value_shown(tag)));
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
  refuse(reader, tag.place,
         fmt::format("expected a whole number behind group code {}, found '{}'", tag.code, value_shown(tag)));
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

namespace {

/// The lowest group code there is; -5 to -1 are a program's own.
constexpr int kLeastCode = -5;

/// Two lines a group: the code, then the value.
class AsciiTags : public TagReader {
 public:
  AsciiTags(std::string_view bytes, std::string name) : name_(std::move(name)) {
    bytes = without_mark(bytes);
    cursor_ = bytes.data();
    end_ = bytes.data() + bytes.size();
    // Lines end with \n or \r\n, also mixed; only very old files have \r alone.
    if (bytes.find('\n') == std::string_view::npos && bytes.find('\r') != std::string_view::npos) newline_ = '\r';
  }

  void next(Tag& tag) override {
    do {
      const std::string_view code = take_line();
      tag.code = code_of(code);
      tag.value = take_line();
      tag.place = line_;
    } while (tag.code == kComment);
  }

  std::string where(std::size_t place) const override { return fmt::format("{}:{}", name_, place); }

 private:
  std::string_view take_line() {
    if (cursor_ == end_) {
      refuse(*this, line_, kCutShort);
    }
    const auto rest = static_cast<std::size_t>(end_ - cursor_);
    const auto* const newline = static_cast<const char*>(std::memchr(cursor_, newline_, rest));
    const char* const line_end = newline != nullptr ? newline : end_;
    const std::string_view line(cursor_, static_cast<std::size_t>(line_end - cursor_));
    cursor_ = newline != nullptr ? newline + 1 : end_;
    ++line_;
    return trimmed(line);
  }

  int code_of(std::string_view text) const {
    int code = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, code);
    const bool is_code = result.ec == std::errc() && result.ptr == end && kLeastCode <= code && code <= kMostCode;
    if (is_code) return code;
    if (line_ == 1) {
      throw InputError(
          fmt::format("{}: starts with '{}', expected a DXF file, which starts with 0 SECTION", name_, shown(text)));
    }
    refuse(*this, line_,
           fmt::format("'{}' is not a group code, expected a whole number from {} to {}", shown(text), kLeastCode,
                       kMostCode));
  }

  std::string name_;
  const char* cursor_ = nullptr;
  const char* end_ = nullptr;
  std::size_t line_ = 0;
  char newline_ = '\n';
};

/// What a binary DXF file starts with.
constexpr std::string_view kBinaryMark("AutoCAD Binary DXF\r\n\x1a\0", 22);

/// How a binary file holds the value of a group.
enum class ValueType { text, real, byte, int16, int32, int64, chunk };

struct CodeRange {
  int first;
  int last;
  ValueType type;
};

/// By group code; what is not listed is text that ends with a zero byte.
constexpr CodeRange kValueTypes[] = {
    {10, 59, ValueType::real},      {60, 79, ValueType::int16},    {90, 99, ValueType::int32},
    {110, 149, ValueType::real},    {160, 169, ValueType::int64},  {170, 179, ValueType::int16},
    {210, 239, ValueType::real},    {270, 289, ValueType::int16},  {290, 299, ValueType::byte},
    {310, 319, ValueType::chunk},   {370, 389, ValueType::int16},  {400, 409, ValueType::int16},
    {420, 429, ValueType::int32},   {440, 459, ValueType::int32},  {460, 469, ValueType::real},
    {1004, 1004, ValueType::chunk}, {1010, 1059, ValueType::real}, {1060, 1070, ValueType::int16},
    {1071, 1071, ValueType::int32},
};

ValueType type_of(int code) {
  for (const CodeRange& range : kValueTypes) {
    if (range.first <= code && code <= range.last) return range.type;
  }
  return ValueType::text;
}

/// Codes of one byte (up to R12; 255 announces one of two bytes) or two, all least byte first.
class BinaryTags : public TagReader {
 public:
  BinaryTags(std::string_view bytes, std::string name)
      : name_(std::move(name)), bytes_(bytes), at_(kBinaryMark.size()) {
    // The first code is 0, before SECTION, or a comment's: of two bytes it has its high byte where the other kind has
    // the S, or follows a 255.
    const std::string_view head = bytes_.substr(at_, 2);
    short_codes_ = head.size() == 2 && (head[0] == '\xff' || (head[0] == 0 && head[1] != 0));
  }

  void next(Tag& tag) override {
    do {
      tag.place = at_;
      tag.code = take_code();
      take_value(tag);
    } while (tag.code == kComment);
  }

  std::string where(std::size_t place) const override { return fmt::format("{}: byte {}", name_, place); }

 private:
  std::string_view take(std::size_t count) {
    if (bytes_.size() - at_ < count) {
      refuse(*this, bytes_.size(), kCutShort);
    }
    const std::string_view taken = bytes_.substr(at_, count);
    at_ += count;
    return taken;
  }

  template <class Whole>
  Whole take_whole() {
    const std::string_view taken = take(sizeof(Whole));
    std::uint64_t bits = 0;
    for (std::size_t k = sizeof(Whole); k-- > 0;) bits = bits << 8U | static_cast<unsigned char>(taken[k]);
    return static_cast<Whole>(bits);
  }

  double take_real() {
    const auto bits = take_whole<std::uint64_t>();
    double real = 0;
    std::memcpy(&real, &bits, sizeof real);
    return real;
  }

  std::string_view take_text() {
    const std::size_t zero = bytes_.find('\0', at_);
    if (zero == std::string_view::npos) take(bytes_.size() - at_ + 1);  // says that the file ends
    const std::string_view text = take(zero - at_);
    ++at_;
    return trimmed(text);
  }

  int take_code() {
    const std::size_t start = at_;
    int code = short_codes_ ? take_whole<std::uint8_t>() : take_whole<std::uint16_t>();
    if (short_codes_ && code == 255) code = take_whole<std::uint16_t>();
    if (code > kMostCode) {
      refuse(*this, start, fmt::format("{} is not a group code, expected one of at most {}", code, kMostCode));
    }
    return code;
  }

  void take_value(Tag& tag) {
    switch (type_of(tag.code)) {
      case ValueType::text:
        tag.value = take_text();
        break;
      case ValueType::real:
        tag.value = take_real();
        break;
      case ValueType::byte:
        tag.value = std::int64_t{take_whole<std::uint8_t>()};
        break;
      case ValueType::int16:
        tag.value = std::int64_t{take_whole<std::int16_t>()};
        break;
      case ValueType::int32:
        tag.value = std::int64_t{take_whole<std::int32_t>()};
        break;
      case ValueType::int64:
        tag.value = take_whole<std::int64_t>();
        break;
      case ValueType::chunk:
        tag.value = take(take_whole<std::uint8_t>());
        break;
    }
  }

  std::string name_;
  std::string_view bytes_;
  std::size_t at_;
  bool short_codes_ = false;
};

/// A DWG starts with its version: AC1.2, AC1009, AC1032, ...
bool is_dwg(std::string_view bytes) {
  constexpr std::size_t kLength = 6;
  const std::string_view version = bytes.substr(0, kLength);
  return version.size() == kLength && version.substr(0, 3) == "AC1" &&
         version.find_first_not_of("0123456789.", 2) == std::string_view::npos;
}

}  // namespace

std::unique_ptr<TagReader> open_tags(std::string_view bytes, const std::string& name) {
  const std::string expected = "expected a DXF file";
  if (bytes.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw InputError(fmt::format("{}: is empty, {}", name, expected));
  if (bytes.substr(0, kBinaryMark.size()) == kBinaryMark) return std::make_unique<BinaryTags>(bytes, name);
  if (bytes.substr(0, 18) == kBinaryMark.substr(0, 18)) {
    throw InputError(
        fmt::format("{}: is a binary DXF file that was damaged, as by a transfer as text; copy it again", name));
  }
  if (is_dwg(bytes)) throw InputError(fmt::format("{}: is a DWG file, {}; save it as DXF", name, expected));
  const std::string_view head = bytes.substr(0, 1024);
  if (has_utf16_mark(bytes)) {
    throw InputError(fmt::format("{}: is UTF-16 text, {}; save it as UTF-8", name, expected));
  }
  if (head.find('\0') != std::string_view::npos) {
    throw InputError(fmt::format("{}: is neither text nor a binary DXF file, {}", name, expected));
  }
  return std::make_unique<AsciiTags>(bytes, name);
}

}  // namespace rollfix::dxf
