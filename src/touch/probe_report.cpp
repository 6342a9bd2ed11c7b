#include "probe_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "log/log_table.hpp"
#include "rollfix/error.hpp"
#include "rollfix/units.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::touch {
namespace {

constexpr std::string_view kGrblStart = "[PRB:";
// x y z a b c u v w.
constexpr std::size_t kLinuxCncNumbers = 9;

/// Where a report of GRBL begins, in capitals or not, as senders that log in small letters write it.
std::size_t grbl_start(std::string_view text) {
  const auto alike = [](char one, char other) { return std::toupper(static_cast<unsigned char>(one)) == other; };
  const auto at = std::search(text.begin(), text.end(), kGrblStart.begin(), kGrblStart.end(), alike);
  return at == text.end() ? std::string_view::npos : static_cast<std::size_t>(at - text.begin());
}

/// Whether it is a row of that many plain numbers, with blanks between.
bool is_linux_cnc_row(std::string_view line) {
  std::size_t count = 0;
  for (std::string_view rest = trimmed(line); !rest.empty(); ++count) {
    const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
    if (!parse_number(rest.substr(0, end))) return false;
    rest = trimmed(rest.substr(end));
  }
  return count == kLinuxCncNumbers;
}

double finite_number(std::string_view text, const char* column, const std::string& place) {
  const std::optional<double> value = parse_number(trimmed(text));
  if (value && std::isfinite(*value)) return *value;
  throw InputError(fmt::format("{}: {}: expected a number, found '{}'", place, column, shown(text)));
}

/// The place in "[PRB:x,y,z:1]"; none where the probe did not touch.
std::optional<Vec2> grbl_place(std::string_view line, const std::string& place) {
  const std::string_view report = line.substr(grbl_start(line));
  const std::size_t end = report.find(']');
  const std::size_t colon = report.find(':', kGrblStart.size());
  const std::string_view flag = colon < end ? trimmed(report.substr(colon + 1, end - colon - 1)) : std::string_view();
  std::vector<std::string_view> numbers;
  if (flag == "0" || flag == "1") {
    numbers = split(report.substr(kGrblStart.size(), colon - kGrblStart.size()), ',');
  }
  if (end == std::string_view::npos || numbers.size() < 2) {
    throw InputError(fmt::format("{}: expected a probe's report, as in [PRB:12.300,4.500,-1.000:1], found '{}'", place,
                                 shown(report)));
  }
  const Vec2 at(finite_number(numbers[0], "x", place), finite_number(numbers[1], "y", place));
  return flag == "1" ? std::optional<Vec2>(at) : std::nullopt;
}

TouchTable parse_grbl(std::string_view text, const std::string& name, const TouchTableOptions& options) {
  const bool knows_unit = !options.unit.empty();
  const Conversion own = knows_unit ? length_conversion("mm", options.unit, name) : Conversion{};
  TouchTable table;
  std::size_t missed = 0;
  LogLines lines(text, name);
  std::string_view line;
  for (std::size_t number = 1; lines.next(line); ++number) {
    if (grbl_start(line) == std::string_view::npos) continue;
    const std::optional<Vec2> at = grbl_place(line, where(name, number));
    if (!at) {
      ++missed;
      continue;
    }
    table.touches.push_back({{own(at->x()), own(at->y())}});
    table.lines.push_back(number);
  }
  table.notes.push_back(fmt::format("{}: GRBL's probe reports, {}: machine coordinates, taken as {}; z is not used",
                                    name, counted(table.touches.size(), "touch", "touches"),
                                    knows_unit ? "mm, which they are unless $13=1" : "in the part's unit"));
  if (missed > 0) {
    table.notes.push_back(
        fmt::format("{}: {} left out: the probe did not touch (:0)", name, counted(missed, "report", "reports")));
  }
  return table;
}

TouchTable parse_linux_cnc(std::string_view text, const std::string& name) {
  TouchTable table;
  LogLines lines(text, name);
  TableCutter cutter(false);
  std::string_view line;
  TableRow row;
  for (std::size_t number = 1; lines.next(line); ++number) {
    if (!cutter.cut(line, number, row)) continue;
    if (row.cells.size() != kLinuxCncNumbers) {
      throw InputError(fmt::format("{}: expected {} numbers as in the rows above, found {}", where(name, number),
                                   kLinuxCncNumbers, row.cells.size()));
    }
    const std::string place = where(name, number);
    table.touches.push_back({{finite_number(row.cells[0], "x", place), finite_number(row.cells[1], "y", place)}});
    table.lines.push_back(number);
  }
  table.notes.push_back(
      fmt::format("{}: nine numbers in a row, as LinuxCNC's PROBEOPEN writes them: x and y are the first two", name));
  return table;
}

}  // namespace

std::optional<ProbeReport> probe_report(std::string_view text) {
  if (grbl_start(text) != std::string_view::npos) return ProbeReport::grbl;
  LogLines lines(text, "");
  std::string_view line;
  while (lines.next(line)) {
    const std::string_view data = trimmed(line.substr(0, line.find('#')));
    if (!data.empty()) return is_linux_cnc_row(data) ? std::optional(ProbeReport::linux_cnc) : std::nullopt;
  }
  return std::nullopt;
}

TouchTable parse_probe_report(ProbeReport report, std::string_view text, const std::string& name,
                              const TouchTableOptions& options) {
  if (!options.columns.empty()) {
    throw InputError(fmt::format("{}: is a probe's report, which has no header; leave `columns` out", name));
  }
  TouchTable table = report == ProbeReport::grbl ? parse_grbl(text, name, options) : parse_linux_cnc(text, name);
  if (!table.touches.empty() || options.may_be_empty) return table;
  throw InputError(fmt::format("{}: expected a touch, found only reports of a probe that did not touch (:0)", name));
}

}  // namespace rollfix::touch
