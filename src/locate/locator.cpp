#include "rollfix/locate/locator.hpp"

#include "searches.hpp"
#include "workspace.hpp"

namespace rollfix {

struct Locator::Memory {
  Workspace work;
  Search search;
};

Locator::Locator() : memory_(std::make_unique<Memory>()) {}
Locator::~Locator() = default;
Locator::Locator(Locator&& other) noexcept = default;
Locator& Locator::operator=(Locator&& other) noexcept = default;

const Search& Locator::locate(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options) {
  search(part, readings, options, memory_->work, memory_->search);
  return memory_->search;
}

const Search& Locator::locate(const Part& part, const Reading& reading, const LocateOptions& options) {
  search(part, {&reading, 1}, options, memory_->work, memory_->search);
  return memory_->search;
}

}  // namespace rollfix
