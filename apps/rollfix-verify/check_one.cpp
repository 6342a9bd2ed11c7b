#include "check_one.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "cells.hpp"
#include "document.hpp"

namespace rollfix_verify {
namespace {

/// What is claimed on the starts from one row to the next.
struct Cell {
  std::string kind;
  std::vector<std::size_t> by;  // the readings of which

  bool is_of_two() const { return kind == "apart" && by.size() == 2; }
  bool is_of(std::size_t reading) const {
    return kind == "within" || kind == "stretch" || std::find(by.begin(), by.end(), reading) != by.end();
  }
};

class OneFinger {
 public:
  explicit OneFinger(const Document& document)
      : document_(document), boundary_(document.boundary()), period_(document.period()) {
    for (const Json& stated : document.json().at("readings")) readings_.emplace_back(document, stated);
    if (readings_.empty()) refuse("it has no readings");
    rows_.resize(readings_.size());
  }

  Verdict check() {
    document_.check();
    for (const Json& stated : document_.json().at("rows")) read_row(stated);
    close_rows();
    check_cover();
    for (std::size_t k = 0; k < cells_.size(); ++k) check_cell(k);
    check_placements();
    Verdict verdict{document_.json().at("placements").size(), cells_.size(), 0, 0, {}};
    verdict.unproved = static_cast<std::size_t>(
        std::count_if(cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.kind == "unproved"; }));
    return verdict;
  }

 private:
  // ---- rows ----

  const Place& start_of(std::size_t row) const { return rows_[0][row].start; }

  void read_row(const Json& stated) {
    const std::string name = "row " + std::to_string(rows_[0].size());
    const Place start = document_.place_at(stated.at("start"));
    if (stated.at("end").size() != readings_.size() || stated.at("off").size() != readings_.size()) {
      refuse(name + " is not of each reading");
    }
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      const std::optional<Row> row = readings_[k].row_at(start);
      if (!row) refuse(name + " ends at a joint");
      const Place end = document_.place_at(stated.at("end").at(k));
      if (!document_.is_as_far(row->end.s, end.s)) refuse(name + " ends elsewhere");
      const Ball slack = kTurnSlack + kRounding * period_ * (abs(row->start_ahead[0]) + abs(row->end_ahead[0]));
      if (!abs(row->f - Ball(stated.at("off").at(k).get<double>()) * document_.tolerance()).is_below(slack)) {
        refuse(name + " turns by another angle");
      }
      rows_[k].push_back(*row);
    }
    if (!stated.contains("then")) return;
    cells_.push_back({stated.at("then").get<std::string>(), stated.value("by", std::vector<std::size_t>{0})});
    for (const std::size_t by : cells_.back().by) {
      if (by >= readings_.size()) refuse(name + " names a reading that is not there");
    }
    if (cells_.back().by.empty()) refuse(name + " names no reading");
  }

  /// A closed outline's first row again, one lap on.
  void close_rows() {
    if (rows_[0].empty()) refuse("it has no rows");
    if (!boundary_.closed()) return;
    for (std::vector<Row>& rows : rows_) {
      Row again = rows.front();
      for (Place* place : {&again.start, &again.end}) {
        place->curve += boundary_.curves();
        place->s = place->s + boundary_.perimeter();
        place->angle = place->angle + boundary_.total_turn();
      }
      rows.push_back(again);
    }
  }

  /// From row to row, all starts that there are.
  void check_cover() const {
    const std::size_t count = rows_[0].size();
    if (cells_.size() + 1 != count) refuse("its rows and cells do not go together");
    for (std::size_t k = 0; k + 1 < count; ++k) {
      if (!start_of(k + 1).s.is_above(start_of(k).s)) refuse("row " + std::to_string(k + 1) + " lies behind");
    }
    if (boundary_.closed()) return;
    const double slack = kLengthSlack * period_;
    double first = 0;
    double last = period_;
    for (const OneReading& reading : readings_) {
      first = std::max(first, -reading.length().middle());
      last = std::min(last, period_ - reading.length().middle());
    }
    if (!start_of(0).s.is_below(first + slack)) refuse("it leaves out starts at the beginning");
    if (!start_of(count - 1).s.is_above(last - slack)) refuse("it leaves out starts at the end");
  }

  void check_cell(std::size_t k) const {
    const Cell& cell = cells_[k];
    if (cell.kind == "unproved") return;
    try {
      if (cell.is_of_two()) return prove_apart(cell, start_of(k), start_of(k + 1));
      for (std::size_t by = 0; by < readings_.size(); ++by) {
        if (cell.is_of(by)) readings_[by].prove(cell.kind, rows_[by][k], rows_[by][k + 1]);
      }
    } catch (const std::domain_error& error) {
      refuse("cell " + std::to_string(k) + " (" + cell.kind + "): " + error.what());
    }
  }

  /// Nowhere do both readings fit.
  void prove_apart(const Cell& cell, const Place& from, const Place& to) const {
    const OneReading& other = readings_[cell.by[1]];
    const OneReading beyond = readings_[cell.by[0]].beyond(other);
    const auto row_at = [&](const Place& start) {
      const std::optional<Place> place = boundary_.after(start.s + other.length());
      const std::optional<Row> row = place ? beyond.row_at(*place) : std::nullopt;
      if (!row) refuse("it ends at a joint");
      return *row;
    };
    beyond.prove(cell.kind, row_at(from), row_at(to));
  }

  // ---- placements ----

  /// Neighbouring cells that are not apart, from row to row; a whole lap of them has `whole`.
  struct Group {
    std::size_t first = 0;  // its first cell
    std::size_t count = 0;
    bool whole = false;
    bool used = false;
  };

  std::vector<Group> groups() const {
    const std::size_t n = cells_.size();
    std::vector<Group> result;
    for (std::size_t k = 0; k < n; ++k) {
      if (cells_[k].kind == "apart") continue;
      if (k > 0 && cells_[k - 1].kind != "apart") {
        ++result.back().count;
      } else {
        result.push_back({k, 1});
      }
    }
    if (result.size() == 1 && result[0].count == n) result[0].whole = true;
    if (boundary_.closed() && result.size() > 1 && cells_.front().kind != "apart" && cells_.back().kind != "apart") {
      result.back().count += result.front().count;  // across the first row
      result.erase(result.begin());
    }
    return result;
  }

  const std::string& kind_in(const Group& group, std::size_t k) const {
    return cells_[(group.first + k) % cells_.size()].kind;
  }

  bool has(const Group& group, const std::string& kind) const {
    for (std::size_t k = 0; k < group.count; ++k) {
      if (kind_in(group, k) == kind) return true;
    }
    return false;
  }

  bool contains(const Group& group, const Place& place) const {
    if (group.whole) return true;
    const Ball lo = start_of(group.first).s;
    const std::size_t end = group.first + group.count;
    const std::size_t n = cells_.size();
    const Ball hi = end <= n ? start_of(end).s : start_of(end - n).s + boundary_.perimeter();
    const auto holds = [&](const Ball& s) { return s.is_above(lo) && s.is_below(hi); };
    return holds(place.s) || (boundary_.closed() && holds(place.s + boundary_.perimeter()));
  }

  /// Where f jumps its sign says nothing of what kind a placement is.
  bool has_corner(const Group& group) const {
    for (std::size_t k = 0; k < group.count; ++k) {
      const std::size_t cell = (group.first + k) % cells_.size();
      for (const std::vector<Row>& rows : rows_) {
        if (spans_corner(boundary_, rows[cell], rows[cell + 1])) return true;
      }
    }
    return false;
  }

  void check_placements() const {
    std::vector<Group> all = groups();
    std::size_t number = 0;
    for (const Json& placement : document_.json().at("placements")) {
      const std::string name = "placement " + std::to_string(number++);
      const Place start = document_.place_at(placement.at("at"));
      Document::Stated stated{placement.at("start"), placement.at("end"), placement.at("point"), {}};
      if (placement.at("kind") != "corner") stated.tangent = placement.at("tangent");  // there the finger pivots
      document_.check_contact(name, start, readings_.back().length(), stated);
      const auto group = std::find_if(all.begin(), all.end(), [&](const Group& one) { return contains(one, start); });
      if (group == all.end() || (group->used && !has(*group, "unproved"))) {
        refuse(name + " has no cell of its own that proves it");
      }
      group->used = true;
      check_kind(name, placement.at("kind").get<std::string>(), *group);
      const bool has_root = group->count == 1 && (has(*group, "crossing") || has(*group, "corner"));
      if (has_root && readings_.size() == 1) {
        check_root(name, start);
      } else if (!has(*group, "unproved")) {
        check_fit(name, start);
      }
    }
    for (const Group& group : all) {
      if (!group.used && !has(group, "unproved"))
        refuse("cell " + std::to_string(group.first) + " proves a placement that is not listed");
    }
  }

  void check_kind(const std::string& name, const std::string& kind, const Group& group) const {
    const std::size_t end = (group.first + group.count) % cells_.size();
    const bool has_ends = boundary_.closed() || (group.first > 0 && group.first + group.count < cells_.size());
    const bool is_smooth = has_ends && !group.whole && !has_corner(group);
    const bool is_proved = !has(group, "unproved");
    bool fits = false;
    if (kind == "stretch") fits = has(group, "stretch") || !is_proved;
    if (kind == "corner") fits = has(group, "corner") || !is_proved || has(group, "within");
    if (kind == "crossing" || kind == "touching") {
      const Row& last = rows_[0][boundary_.closed() ? end : group.first + group.count];
      const bool changes = readings_[0].changes_sign(rows_[0][group.first], last);
      const bool is_open = !is_smooth || !is_proved || readings_.size() > 1;
      fits = !has(group, "stretch") && !has(group, "corner") && (is_open || changes == (kind == "crossing"));
    }
    if (!fits) refuse(name + " is of another kind than its cells");
  }

  /// A root within the accuracy that is promised on either side of the start.
  void check_root(const std::string& name, const Place& start) const {
    const auto row_beside = [&](double distance) {
      const std::optional<Row> row = readings_[0].row_beside(start, distance);
      if (!row) refuse(name + " is too near to a joint");
      return *row;
    };
    const double reach = 1.1 * kRootLength * period_;
    const Row lo = row_beside(-reach);
    const Row hi = row_beside(reach);
    const double slope = std::abs((hi.f - lo.f).middle()) / (2 * reach);
    if (slope * reach >= kRootTurn) {
      if (sign_of(lo.f) * sign_of(hi.f) >= 0) refuse(name + " is not where f changes its sign");
    } else if (!abs(lo.f).is_below(2.2 * kRootTurn)) {
      refuse(name + " is not where f vanishes");
    }
  }

  /// The start itself fits every reading.
  void check_fit(const std::string& name, const Place& start) const {
    for (const OneReading& reading : readings_) {
      if (!reading.fits(start)) refuse(name + " does not fit");
    }
  }

  const Document& document_;
  const Boundary& boundary_;
  double period_;
  std::vector<OneReading> readings_;
  std::vector<std::vector<Row>> rows_;  // of each reading, those that are stated in order
  std::vector<Cell> cells_;
};

}  // namespace

Verdict check_one_finger(const Document& document) { return OneFinger(document).check(); }

}  // namespace rollfix_verify
