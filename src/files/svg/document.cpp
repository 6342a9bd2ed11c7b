#include "files/svg/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix::svg {

Text::Text(std::string_view text, std::string name) : name_(std::move(name)), size_(text.size()) {
  for (std::size_t k = text.find('\n'); k != std::string_view::npos; k = text.find('\n', k + 1)) newlines_.push_back(k);
}

std::size_t Text::line_at(std::size_t offset) const {
  const auto before = std::lower_bound(newlines_.begin(), newlines_.end(), std::min(offset, size_));
  return static_cast<std::size_t>(before - newlines_.begin()) + 1;
}

void Text::refuse(std::size_t offset, const std::string& message) const {
  throw InputError(fmt::format("{}:{}: {}", name_, line_at(offset), message));
}

namespace {

/// User units, of 1/96 inch each, in the units of the world.
constexpr std::array<std::pair<std::string_view, double>, 6> kPhysical = {
    {{"mm", 96 / 25.4}, {"cm", 960 / 25.4}, {"in", 96}, {"pt", 96.0 / 72}, {"pc", 16}, {"Q", 24 / 25.4}}};

}  // namespace

bool Length::is_physical() const {
  for (const auto& [name, size] : kPhysical) {
    if (unit == name) return true;
  }
  return false;
}

std::optional<double> Length::in_user_units(double whole) const {
  if (unit.empty() || unit == "px") return number;
  if (unit == "%") return number / 100 * whole;
  for (const auto& [name, size] : kPhysical) {
    if (unit == name) return number * size;
  }
  return std::nullopt;
}

std::optional<Length> parse_length(const Value& value) {
  if (value.text == "auto") return std::nullopt;
  Scanner scan(value);
  scan.skip_spaces();
  Length length;
  length.number = scan.number("a length such as 12 or 12mm");
  const char* const unit = scan.cursor();
  if (!scan.at_end() && scan.peek() == '%') {
    scan.advance();
  } else {
    scan.word();
  }
  length.unit = {unit, static_cast<std::size_t>(scan.cursor() - unit)};
  scan.skip_spaces();
  if (!scan.at_end()) scan.refuse("expected a length such as 12 or 12mm");
  return length;
}

namespace {

constexpr std::uint32_t kHigh = 0xD800;  // the first half of a pair from here ...
constexpr std::uint32_t kLow = 0xDC00;   // ... to here, from which the second half goes ...
constexpr std::uint32_t kBeyond = 0xE000;
constexpr std::uint32_t kByteOrderMark = 0xFEFF;

/// Whether a text begins with UTF-16's byte order mark, or with '<' in UTF-16.
bool is_utf16(std::string_view text) {
  const std::string_view head = text.substr(0, 2);
  return has_utf16_mark(text) || head == std::string_view("<\0", 2) || head == std::string_view("\0<", 2);
}

/// The same text in UTF-8. Throws InputError: half a character.
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

constexpr std::string_view kNamespace = "http://www.w3.org/2000/svg";

std::string readable(std::string_view text, const std::string& name) {
  if (text.substr(0, 2) == "\x1F\x8B") {
    throw InputError(fmt::format("{}: is compressed (.svgz), expected plain SVG: unpack it with gunzip", name));
  }
  if (is_utf16(text)) return utf8_from_utf16(text, name);
  const std::size_t zero = text.find('\0');
  if (zero != std::string_view::npos) {
    Text(text, name).refuse(zero, "holds a byte of 0, expected the text of an SVG file");
  }
  return std::string(text);
}

/// Where the element's name has a prefix, with its colon.
std::string prefix_of(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? "" : std::string(name.substr(0, colon + 1));
}

}  // namespace

Document::Document(std::string_view text, const std::string& name) : buffer_(readable(text, name)) {
  text_.emplace(buffer_, name);
  // Whatever the file calls its encoding, names and numbers are ASCII.
  const pugi::xml_parse_result parsed = document_.load_buffer_inplace(
      buffer_.data(), buffer_.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  if (parsed.status == pugi::status_no_document_element) {
    throw InputError(fmt::format("{}: holds no XML element, expected an SVG file", name));
  }
  if (!parsed) {
    text_->refuse(static_cast<std::size_t>(parsed.offset),
                  fmt::format("is not XML from here on ({}), expected a whole SVG file", parsed.description()));
  }
  root_ = document_.document_element();
  prefix_ = prefix_of(root_.name());
  const std::string own = prefix_.empty() ? "xmlns" : "xmlns:" + prefix_.substr(0, prefix_.size() - 1);
  const std::string_view space = root_.attribute(own.c_str()).value();
  // Old programs write the name space as an entity of their own.
  const bool other_space = !space.empty() && space != kNamespace && space.front() != '&';
  if (std::string_view(root_.name()).substr(prefix_.size()) != "svg" || other_space) {
    refuse(root_, fmt::format("is not an SVG: its outermost element is <{}>, expected <svg>", shown(root_.name())));
  }
  for (pugi::xml_node node = root_.next_sibling(); node; node = node.next_sibling()) {
    if (node.type() == pugi::node_element) refuse(node, "is not XML: has a second outermost element");
  }
}

std::size_t Document::offset_of(pugi::xml_node node) const {
  const char* const place = node.type() == pugi::node_pcdata ? node.value() : node.name();
  return static_cast<std::size_t>(place - buffer_.data());
}

void Document::refuse(pugi::xml_node node, const std::string& message) const {
  text_->refuse(offset_of(node), message);
}

std::string_view Document::kind(pugi::xml_node node) const {
  if (node.type() != pugi::node_element) return {};
  const std::string_view name = node.name();
  if (name.size() <= prefix_.size() || name.substr(0, prefix_.size()) != prefix_) return {};
  const std::string_view own = name.substr(prefix_.size());
  if (own.find(':') != std::string_view::npos) return {};
  const std::string_view space = prefix_.empty() && node != root_ ? node.attribute("xmlns").value() : "";
  return space.empty() || space == kNamespace ? own : std::string_view();
}

Value Document::value_of(const pugi::xml_attribute& attribute) const {
  const std::string_view text = trimmed(attribute.value());
  // An empty value points to nothing of the file.
  const std::size_t offset = text.empty() ? static_cast<std::size_t>(attribute.name() - buffer_.data())
                                          : static_cast<std::size_t>(text.data() - buffer_.data());
  return {*text_, text, offset};
}

std::optional<Value> Document::attribute(pugi::xml_node node, const char* name) const {
  const pugi::xml_attribute found = node.attribute(name);
  if (!found) return std::nullopt;
  return value_of(found);
}

std::string_view Document::property(pugi::xml_node node, const char* name) const {
  const auto styled = style_property(node.attribute("style").value(), name);
  return styled ? *styled : trimmed(node.attribute(name).value());
}

std::optional<std::string_view> style_property(std::string_view style, std::string_view name) {
  std::optional<std::string_view> found;
  while (!style.empty()) {
    const std::size_t stop = style.find(';');
    const std::string_view declaration = style.substr(0, stop);
    style.remove_prefix(stop == std::string_view::npos ? style.size() : stop + 1);
    const std::size_t colon = declaration.find(':');
    if (colon == std::string_view::npos || trimmed(declaration.substr(0, colon)) != name) continue;
    const std::string_view value = declaration.substr(colon + 1);
    found = trimmed(value.substr(0, value.find('!')));  // "!important"
  }
  return found;
}

}  // namespace rollfix::svg
