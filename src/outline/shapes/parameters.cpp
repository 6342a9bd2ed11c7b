#include "outline/shapes/shapes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>

#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix {

namespace {

std::size_t index_of(const GalleryShape& shape, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < shape.parameters.size(); ++i) {
    if (shape.parameters[i].name == name) return i;
    names.push_back(shape.parameters[i].name);
  }
  throw InputError(
      fmt::format("gallery shape '{}' has no parameter '{}'; {}", shape.name, name, known_names(name, names)));
}

bool is_allowed(const GalleryParameter& parameter, const std::string& text) {
  if (parameter.kind == ParameterKind::text) return !text.empty();
  const std::optional<double> value = parse_number(text);
  if (!value || !std::isfinite(*value)) return false;
  if (parameter.kind == ParameterKind::length) return *value >= kLeastLength && *value <= kMostLength;
  if (parameter.kind == ParameterKind::whole && *value != std::floor(*value)) return false;
  return *value >= parameter.least && *value <= parameter.most;
}

/// In words; kMostLength is as good as no limit.
std::string allowed_numbers(const GalleryParameter& parameter) {
  if (parameter.most < kMostLength) return fmt::format("a number from {} to {}", parameter.least, parameter.most);
  return parameter.least > -kMostLength ? fmt::format("a number of at least {}", parameter.least) : "a number";
}

/// For an error message: what is allowed, and the limits of all lengths where those are what the value is beyond.
std::string expected_values(const GalleryParameter& parameter, const std::string& text) {
  const double size = std::abs(parse_number(text).value_or(0));
  const bool is_length = parameter.kind == ParameterKind::length;
  const bool is_beyond = size > kMostLength || (is_length && size > 0 && size < kLeastLength);
  return allowed_values(parameter) + (is_beyond ? fmt::format(" ({} to {})", kLeastLength, kMostLength) : "");
}

}  // namespace

std::string allowed_values(const GalleryParameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::length:
      return "a number above 0";
    case ParameterKind::number:
      return allowed_numbers(parameter);
    case ParameterKind::whole:
      return fmt::format("a whole number from {} to {}", parameter.least, parameter.most);
    case ParameterKind::text:
      break;
  }
  return parameter.meaning;
}

Parameters::Parameters(const GalleryShape& shape, const ParameterList& given) : shape_(shape) {
  for (const GalleryParameter& parameter : shape.parameters) values_.push_back(parameter.default_value);
  std::vector<bool> is_given(values_.size(), false);
  for (const auto& [name, value] : given) {
    const std::size_t i = index_of(shape, name);
    const GalleryParameter& parameter = shape.parameters[i];
    if (is_given[i]) {
      throw InputError(fmt::format("gallery shape '{}': parameter {} is given twice, as '{}' and '{}'", shape.name,
                                   name, values_[i], value));
    }
    if (!is_allowed(parameter, value)) {
      throw InputError(fmt::format("gallery shape '{}': parameter {} = '{}', expected {}", shape.name, name, value,
                                   expected_values(parameter, value)));
    }
    values_[i] = value;
    is_given[i] = true;
  }
}

double Parameters::number(const std::string& name) const { return *parse_number(text(name)); }

const std::string& Parameters::text(const std::string& name) const { return values_[index_of(shape_, name)]; }

void Parameters::refuse(const std::string& reason) const {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    settings.push_back(fmt::format("{} = {}", shape_.parameters[i].name, values_[i]));
  }
  throw InputError(fmt::format("gallery shape '{}' with {}: {}", shape_.name, fmt::join(settings, ", "), reason));
}

}  // namespace rollfix
