#include "rollfix/json_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline/gallery.hpp"

namespace rollfix::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kExpected = R"(expected a gallery shape such as {"gallery": "ellipse", "parameters": {"a": 2}})";

Json parse(const std::string& text, const std::string& path) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    // `byte` counts from 1 and may point behind the end.
    const std::size_t before = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
    const auto stop = text.begin() + static_cast<std::ptrdiff_t>(before);
    const auto line = 1 + std::count(text.begin(), stop, '\n');
    const std::size_t newline = before == 0 ? std::string::npos : text.rfind('\n', before - 1);
    const std::size_t column = newline == std::string::npos ? before + 1 : before - newline;
    throw InputError(fmt::format("{}:{}:{}: is not JSON from here on, {}", path, line, column, kExpected));
  } catch (const Json::exception&) {
    throw InputError(fmt::format("{}: holds a number that is out of range, {}", path, kExpected));
  }
}

std::string as_parameter(const std::string& name, const Json& value, const std::string& path) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  throw InputError(
      fmt::format("{}: parameter '{}' is {}, expected a number or a text in quotes", path, name, value.type_name()));
}

void require_known_keys(const Json& object, const std::string& path) {
  for (const auto& [key, value] : object.items()) {
    if (key == "gallery" || key == "parameters") continue;
    throw InputError(fmt::format("{}: has a field '{}', {}", path, key, kExpected));
  }
}

}  // namespace

bool is_json_part(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return ending == ".json" && path.rfind("gallery:", 0) != 0;
}

Outline load_json_part(const std::string& path) {
  const Json object = parse(read_file(path), path);
  if (!object.is_object() || !object.contains("gallery") || !object["gallery"].is_string()) {
    throw InputError(fmt::format("{}: holds something else, {}", path, kExpected));
  }
  require_known_keys(object, path);
  ParameterList parameters;
  if (object.contains("parameters")) {
    if (!object["parameters"].is_object()) {
      throw InputError(fmt::format("{}: 'parameters' is not an object, {}", path, kExpected));
    }
    for (const auto& [name, value] : object["parameters"].items()) {
      parameters.emplace_back(name, as_parameter(name, value, path));
    }
  }
  try {
    Outline outline = gallery(object["gallery"].get<std::string>(), parameters);
    outline.name = path;
    return outline;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace rollfix::app
