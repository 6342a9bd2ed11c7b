#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/curve.hpp"

namespace rollfix {

using Json = nlohmann::ordered_json;

/// Values are not nested deeper than this in any file, and whatever goes through deeper ones runs out of stack.
inline constexpr int kMostNesting = 100;

/// A JSON text. Throws InputError "name:line:column: ...": not JSON (`expected` says what would be), a field that
/// stands in its object twice, or too many brackets in one another.
Json parse_json(std::string_view text, const std::string& name, const std::string& expected);

/// A text from a file for a message: 'ellipse', cut short, on one line.
std::string quoted(const std::string& text);

/// An object whose fields are asked for by name and type. What a field is called in messages begins with `place`:
/// "part.json:3: curves[2]". Throws InputError: a field is missing, of another type, not finite, or out of range.
class JsonFields {
 public:
  JsonFields(const Json& object, std::string place);

  /// Throws InputError where there is a field that is none of these, with the nearest.
  void allow_only(const std::vector<std::string>& names) const;

  bool has(const char* name) const { return object_.contains(name); }
  const Json& get(const char* name, const char* expected) const;
  std::string text(const char* name) const;
  bool flag(const char* name, bool otherwise) const;
  double number(const char* name) const;
  int whole(const char* name) const;
  double angle(const char* name, double otherwise) const;  // radians, or a text such as "73deg"
  Vec2 point(const char* name) const;
  std::vector<Vec2> points(const char* name) const;
  std::vector<double> numbers(const char* name) const;

  [[noreturn]] void refuse(const std::string& message) const;

 private:
  const Json& array(const char* name, const char* expected) const;
  double number_of(const Json& value, const std::string& name) const;
  Vec2 point_of(const Json& value, const std::string& name) const;

  const Json& object_;
  std::string place_;
};

}  // namespace rollfix
