#include "files/dxf/tags.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

#include "files/dxf/text.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"

namespace rollfix::dxf {

namespace {

std::string value_shown(const Tag& tag) {
  if (const auto* text = std::get_if<std::string_view>(&tag.value)) return shown(*text);
  if (const auto* number = std::get_if<double>(&tag.value)) return fmt::format("{}", *number);
  return fmt::format("{}", std::get<std::int64_t>(tag.value));
}

/// A DWG starts with its version: AC1.2, AC1009, AC1032, ...
bool is_dwg(std::string_view bytes) {
  constexpr std::size_t kLength = 6;
  const std::string_view version = bytes.substr(0, kLength);
  return version.size() == kLength && version.substr(0, 3) == "AC1" &&
         version.find_first_not_of("0123456789.", 2) == std::string_view::npos;
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
  if (!(std::abs(number) <= kMostNumber)) {
    refuse(reader, tag.place,
           fmt::format("'{}' (group code {}) is out of range, expected a finite number of at most {}", value_shown(tag),
                       tag.code, kMostNumber));
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

std::unique_ptr<TagReader> open_tags(std::string_view bytes, const std::string& name) {
  const std::string expected = "expected a DXF file";
  if (bytes.find_first_not_of(" \t\r\n") == std::string_view::npos)
    throw InputError(fmt::format("{}: is empty, {}", name, expected));
  if (bytes.substr(0, kBinaryMark.size()) == kBinaryMark) return open_binary_tags(bytes, name);
  if (bytes.substr(0, 18) == kBinaryMark.substr(0, 18)) {
    throw InputError(
        fmt::format("{}: is a binary DXF file that was damaged, as by a transfer as text; copy it again", name));
  }
  if (is_dwg(bytes)) throw InputError(fmt::format("{}: is a DWG file, {}; save it as DXF", name, expected));
  const std::string_view head = bytes.substr(0, 1024);
  if (head.substr(0, 2) == "\xFF\xFE" || head.substr(0, 2) == "\xFE\xFF") {
    throw InputError(fmt::format("{}: is UTF-16 text, {}; save it as UTF-8", name, expected));
  }
  if (head.find('\0') != std::string_view::npos) {
    throw InputError(fmt::format("{}: is neither text nor a binary DXF file, {}", name, expected));
  }
  return open_ascii_tags(bytes, name);
}

}  // namespace rollfix::dxf
