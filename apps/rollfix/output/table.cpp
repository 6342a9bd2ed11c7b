#include "rollfix/output/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "outline/turn.hpp"

namespace rollfix::app {

void Table::add_column(std::string_view title, Align align) {
  rows_.front().push_back(plain(title));
  aligns_.push_back(align);
}

void Table::add_row(std::vector<std::string> cells) {
  for (std::string& cell : cells) cell = plain(cell);
  rows_.push_back(std::move(cells));
}

std::string Table::str() const {
  std::vector<std::size_t> widths(aligns_.size(), 0);
  for (const std::vector<std::string>& row : rows_) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const std::vector<std::string>& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      if (i > 0) line += "  ";
      line += aligns_[i] == Align::left ? fmt::format("{:<{}}", row[i], widths[i])
                                        : fmt::format("{:>{}}", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string title_in(const std::string& title, const std::string& unit) {
  return unit.empty() ? title : fmt::format("{} [{}]", title, plain(unit));
}

std::string behind(const std::string& unit) { return unit.empty() ? "" : " " + plain(unit); }

int decimals_for(double size) {
  constexpr int kDigits = 7;
  constexpr int kMostDecimals = 15;
  if (!(size > 0) || !std::isfinite(size)) return kDigits;
  return std::clamp(kDigits - 1 - static_cast<int>(std::floor(std::log10(size))), 0, kMostDecimals);
}

std::string rough(double value) { return std::isfinite(value) ? fmt::format("{:.3g}", value) : "-"; }

std::string degrees(double radians) { return fixed(radians / kDegree, 3); }

}  // namespace rollfix::app
