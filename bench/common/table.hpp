#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "program.hpp"

namespace bench {

/// A number as text; "?" where it was not measured.
std::string cell(double value, int digits);
/// With its spread: "0.47 ±3%".
std::string cell(const Timing& timing, int digits);
/// Of questions' answers, the share that was found.
std::string share(double part);
/// How `times` grow with `sizes`: the exponent of the power that fits them best.
double exponent(const std::vector<double>& sizes, const std::vector<Timing>& times);

/// Aligned columns, two blanks or more between them: names to the left, numbers to the right. Cells are
/// not empty and hold no two blanks in a row. A row of one cell is a line of text.
class Table {
 public:
  explicit Table(std::vector<std::string> header) { rows_.push_back(std::move(header)); }
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  void print() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace bench
