#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/output/answer_sections.hpp"
#include "rollfix/output/answer_words.hpp"

namespace rollfix::app {
namespace {

using Rows = std::vector<std::string>;

class PlacementTable : AnswerWords {
 public:
  PlacementTable(const Answer& answer, bool verbose) : AnswerWords(answer), verbose_(verbose) {}

  std::string text() const { return answer_.weighing ? weighed_table() : placement_table(); }

 private:
  /// Columns of one title, or one for each finger.
  void add_columns(Table& table, const std::string& title) const {
    for (std::size_t finger = 0; finger < fingers_; ++finger) table.add_column(over_lengths(of(title, finger)));
  }
  template <class ToText>
  void add_cells(Rows& cells, const ToText& to_text) const {
    for (std::size_t finger = 0; finger < fingers_; ++finger) cells.push_back(to_text(finger));
  }
  /// Of one finger also where it is; two have no room for it.
  void add_position(const Placement& placement, Rows& cells) const {
    if (fingers_ == 2) return;
    cells.push_back(degrees(placement.tangent[0]));
    cells.push_back(place(placement.point[0].x()));
    cells.push_back(place(placement.point[0].y()));
  }
  void add_position_columns(Table& table) const {
    if (fingers_ == 2) return;
    table.add_column("tangent [deg]");
    for (const char* title : {"x", "y"}) table.add_column(over_lengths(title));
  }

  /// The largest by size; of one reading simply its own.
  template <class Values>
  static double steepest(const Values& values) {
    double most = std::numeric_limits<double>::quiet_NaN();
    for (const double value : values) {
      if (std::isfinite(value) && !(std::abs(value) <= std::abs(most))) most = value;
    }
    return most;
  }
  static double steepest_by_length(const Sensitivity& sensitivity) {
    std::vector<double> own;
    for (const PerFinger<double>& lengths : sensitivity.per_length[0]) own.push_back(lengths[0]);
    return steepest(own);
  }

  /// How wide they are, and how they move with what was measured.
  void add_detail_columns(Table& table) const {
    const std::string most = fingers_ == 2 || answer_.readings.size() > 1 ? "max " : "";
    add_columns(table, "width");
    for (std::size_t finger = 0; finger < fingers_; ++finger) {
      const char* change = fingers_ == 1 ? "ds" : finger == 0 ? "da" : "db";
      table.add_column(fmt::format("{}{}/dturn [{}/deg]", most, change, answer_.part.unit()));
    }
    if (fingers_ == 1) table.add_column(most + "ds/dlength");
    table.add_column(over_lengths("error"));
  }
  void add_details(const Placement& placement, Rows& cells) const {
    const Sensitivity& sensitivity = placement.sensitivity;
    add_cells(cells, [&](std::size_t finger) { return rough(placement.extent[finger].width()); });
    add_cells(cells, [&](std::size_t finger) {
      return rough(finger < sensitivity.per_turn.size() ? steepest(sensitivity.per_turn[finger]) * kDegree
                                                        : std::numeric_limits<double>::quiet_NaN());
    });
    if (fingers_ == 1) cells.push_back(rough(steepest_by_length(sensitivity)));
    cells.push_back(rough(placement.error));
  }

  std::string placement_table() const {
    Table table;
    table.add_column("", fingers_ == 1 ? Table::Align::left : Table::Align::right);
    table.add_column("kind", Table::Align::left);
    if (answer_.either_way) table.add_column("way", Table::Align::left);
    for (const char* title : {"start", "end"}) add_columns(table, title);
    add_position_columns(table);
    if (verbose_) add_detail_columns(table);
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostRows); ++i) {
      const Placement& placement = answer_.placements[i];
      Rows cells{label(i), name_of(placement.kind)};
      if (answer_.either_way) cells.emplace_back(placement.clockwise ? "cw" : "ccw");
      add_cells(cells, [&](std::size_t finger) { return place(placement.start[finger]); });
      add_cells(cells, [&](std::size_t finger) { return place(placement.end[finger]); });
      add_position(placement, cells);
      if (verbose_) add_details(placement, cells);
      table.add_row(std::move(cells));
    }
    return table.str() + more_line(answer_.placements.size());
  }

  /// Nothing that is listed is impossible.
  static std::string probability_text(double probability) {
    constexpr double kLeast = 0.00005;
    return probability < kLeast ? "<0.0001" : fmt::format("{:.4f}", probability);
  }

  /// With noise: how probable each is, and how well it is known.
  std::string weighed_table() const {
    Table table;
    table.add_column("", fingers_ == 1 ? Table::Align::left : Table::Align::right);
    table.add_column("probability");
    if (answer_.either_way) table.add_column("way", Table::Align::left);
    for (std::size_t finger = 0; finger < fingers_; ++finger) {
      for (const char* title : {"start", "sd", "95 % from", "to", "end"})
        table.add_column(over_lengths(of(title, finger)));
    }
    add_position_columns(table);
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostRows); ++i) {
      const Placement& placement = answer_.placements[i];
      Rows cells{label(i), probability_text(placement.probability)};
      if (answer_.either_way) cells.emplace_back(placement.clockwise ? "cw" : "ccw");
      for (std::size_t finger = 0; finger < fingers_; ++finger) {
        cells.push_back(place(placement.start[finger]));
        cells.push_back(rough(placement.sd[finger]));
        cells.push_back(place(placement.interval[finger].lo));
        cells.push_back(place(placement.interval[finger].hi));
        cells.push_back(place(placement.end[finger]));
      }
      add_position(placement, cells);
      table.add_row(std::move(cells));
    }
    return table.str() + more_line(answer_.placements.size());
  }

  bool verbose_;
};

}  // namespace

std::string placements_table(const Answer& answer, bool verbose) { return PlacementTable(answer, verbose).text(); }

}  // namespace rollfix::app
