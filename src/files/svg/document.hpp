#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "files/svg/value.hpp"

namespace rollfix::svg {

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
