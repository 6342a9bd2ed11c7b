#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "text/text.hpp"

namespace rollfix::app {

inline constexpr std::size_t kMostRows = 40;   // placements in a table
inline constexpr std::size_t kMostNotes = 12;  // lines about single placements below it

/// Text in columns, as wide as they need to be and two blanks apart.
class Table {
 public:
  enum class Align { left, right };

  void add_column(std::string_view title, Align align = Align::right);
  /// One cell per column.
  void add_row(std::vector<std::string> cells);

  /// A line of titles, then a line per row, without blanks at the ends of lines.
  std::string str() const;

 private:
  std::vector<Align> aligns_;
  std::vector<std::vector<std::string>> rows_{1};  // the first are the titles
};

/// How many decimals show a part of this size to about seven digits.
int decimals_for(double size);

/// "start [mm]": a title over lengths in a part's unit, "start" where that is not known.
std::string title_in(const std::string& title, const std::string& unit);
/// "12.5 mm" behind a length.
std::string behind(const std::string& unit);

/// Three significant digits, "-" for what is infinite or not defined.
std::string rough(double value);

/// Radians shown in degrees, with three decimals.
std::string degrees(double radians);

}  // namespace rollfix::app
