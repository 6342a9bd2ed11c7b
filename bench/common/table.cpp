#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bench {
namespace {

/// Letters, of which some are more than one byte.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padding(const std::string& text, std::size_t wide) {
  return std::string(wide - std::min(wide, width(text)), ' ');
}

}  // namespace

std::string cell(double value, int digits) { return std::isnan(value) ? "?" : fmt::format("{:.{}f}", value, digits); }

std::string cell(const Timing& timing, int digits) {
  if (std::isnan(timing.median) || std::isnan(timing.spread)) return cell(timing.median, digits);
  return fmt::format("{:.{}f} ±{:.0f}%", timing.median, digits, 100 * timing.spread);
}

std::string share(double part) { return std::isnan(part) ? "?" : fmt::format("{:.0f}%", 100 * part); }

double exponent(const std::vector<double>& sizes, const std::vector<Timing>& times) {
  const auto count = static_cast<double>(sizes.size());
  double x = 0;
  double y = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    x += std::log(sizes[k]) / count;
    y += std::log(times[k].median) / count;
  }
  double rise = 0;
  double run = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    rise += (std::log(sizes[k]) - x) * (std::log(times[k].median) - y);
    run += (std::log(sizes[k]) - x) * (std::log(sizes[k]) - x);
  }
  return rise / run;
}

void Table::print() const {
  std::vector<std::size_t> wide;
  for (const auto& row : rows_) {
    wide.resize(std::max(wide.size(), row.size()));
    for (std::size_t k = 0; row.size() > 1 && k < row.size(); ++k) wide[k] = std::max(wide[k], width(row[k]));
  }
  for (const auto& row : rows_) {
    std::string line = row.front();
    if (row.size() > 1) line += padding(line, wide.front());
    for (std::size_t k = 1; k < row.size(); ++k) line += "  " + padding(row[k], wide[k]) + row[k];
    fmt::print("{}\n", line);
  }
}

}  // namespace bench
