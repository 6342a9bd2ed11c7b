#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <system_error>

#include "files/dxf/tags.hpp"
#include "files/dxf/text.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix::dxf {

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
      refuse(*this, line_, "the file ends here, expected more up to 0 EOF: it has been cut short");
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

}  // namespace

std::unique_ptr<TagReader> open_ascii_tags(std::string_view bytes, const std::string& name) {
  return std::make_unique<AsciiTags>(bytes, name);
}

}  // namespace rollfix::dxf
