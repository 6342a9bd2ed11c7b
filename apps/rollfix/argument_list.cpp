#include "rollfix/argument_list.hpp"

#include <cctype>
#include <string_view>

namespace rollfix::app {
namespace {

bool is_long_option_without_value(std::string_view argument) {
  return argument.size() > 2 && argument.substr(0, 2) == "--" && argument.find('=') == std::string_view::npos;
}

/// A minus and a digit or a point; also -inf and -nan, so that the error is about the number.
bool starts_like_a_negative_number(std::string_view argument) {
  if (argument.size() < 2 || argument.front() != '-') return false;
  const std::string_view rest = argument.substr(1);
  const auto second = static_cast<unsigned char>(rest.front());
  return std::isdigit(second) != 0 || second == '.' || rest.substr(0, 3) == "inf" || rest.substr(0, 3) == "nan";
}

}  // namespace

std::vector<std::string> with_negative_values_attached(const std::vector<std::string>& arguments) {
  std::vector<std::string> result;
  for (const std::string& argument : arguments) {
    const bool belongs_to_last = !result.empty() && is_long_option_without_value(result.back());
    if (belongs_to_last && starts_like_a_negative_number(argument)) {
      result.back() += "=" + argument;
    } else {
      result.push_back(argument);
    }
  }
  return result;
}

}  // namespace rollfix::app
