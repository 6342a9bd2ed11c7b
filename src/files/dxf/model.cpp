#include "files/dxf/model.hpp"

#include "files/dxf/text.hpp"

namespace rollfix::dxf {

std::size_t NameTable::number_of(std::string_view raw) {
  if (!names_.empty() && raw == last_raw_) return last_;
  std::string name = decoded(raw);
  const auto [entry, is_new] = numbers_.emplace(folded(name), names_.size());
  if (is_new) names_.push_back(std::move(name));
  last_raw_ = raw;
  last_ = entry->second;
  return last_;
}

}  // namespace rollfix::dxf
