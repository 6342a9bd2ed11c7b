#include "files/svg/context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rollfix/error.hpp"

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

}  // namespace rollfix::svg
