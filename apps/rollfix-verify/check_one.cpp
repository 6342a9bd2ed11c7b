#include "check_one.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "cells.hpp"
#include "document.hpp"
#include "remains.hpp"

namespace rollfix_verify {
namespace {

// Rows on both sides of a place are looked for at these shares of the perimeter; the next ones where they are at a
// joint.
constexpr double kBeside[] = {0.25 * kSamePlace, 0.5 * kSamePlace, 0.75 * kSamePlace, kSamePlace};
// The same of a root's start, in units of what it is stated to; no further than its cell.
constexpr double kRootShares[] = {1.1, 1.13, 1.17};

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
    for (const OneReading& reading : readings_) all_.push_back(&reading);
    starts_ = {0, period_};
    if (boundary_.closed()) return;
    for (const OneReading& reading : readings_) {
      starts_.lo = std::max(starts_.lo, -reading.length().middle());
      starts_.hi = std::min(starts_.hi, period_ - reading.length().middle());
    }
    if (!(starts_.hi > starts_.lo)) refuse("no start leaves room for its rolls");
  }

  Verdict check() {
    for (const Json& stated : document_.json().at("rows")) read_row(stated);
    close_rows();
    check_cover();
    for (std::size_t k = 0; k < cells_.size(); ++k) check_cell(k);
    check_placements();
    Verdict verdict;
    verdict.placements = document_.json().at("placements").size();
    verdict.cells = cells_.size();
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      if (cells_[k].kind != "unproved") continue;
      ++verdict.open;
      verdict.share += (start_of(k + 1).s - start_of(k).s).upper() / starts_.width();
    }
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
      const double clear = kClear * period_;
      if (is_at_corner(boundary_, start.s, clear) || is_at_corner(boundary_, row->end.s, clear)) {
        refuse(name + " is at a corner");
      }
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
    if (!start_of(0).s.is_below(starts_.lo + slack)) refuse("it leaves out starts at the beginning");
    if (!start_of(count - 1).s.is_above(starts_.hi - slack)) refuse("it leaves out starts at the end");
  }

  void check_cell(std::size_t k) const {
    const Cell& cell = cells_[k];
    if (cell.kind == "unproved" || cell.kind == "within") return;  // of that its group says the rest
    try {
      if (cell.is_of_two()) return prove_apart(cell, start_of(k), start_of(k + 1));
      for (std::size_t by = 0; by < readings_.size(); ++by) {
        if (!cell.is_of(by)) continue;
        if (cell.kind == "corner") {
          prove_corner(by, rows_[by][k], rows_[by][k + 1]);
        } else {
          readings_[by].prove(cell.kind, rows_[by][k], rows_[by][k + 1]);
        }
      }
    } catch (const std::domain_error& error) {
      refuse("cell " + std::to_string(k) + " (" + cell.kind + "): " + error.what());
    }
  }

  /// A reading passes 0 at one corner, and fits nowhere else.
  void prove_corner(std::size_t by, const Row& from, const Row& to) const {
    if (!readings_[by].changes_sign(from, to)) refuse("f does not change its sign from end to end of it");
    Leftover leftover(document_, {&readings_[by]});
    leftover.add({from}, {to});
    if (leftover.remains().runs != 1) refuse("f does not pass 0 at one corner");
    if (!leftover.remains().are_corners()) refuse("f fits beside the corner as well");
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
    bool proved = true;    // none of them is unproved
    Remains remains = {};  // of a proved one
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
    for (Group& group : result) {
      group.proved = !has(group, "unproved");
      if (group.proved) find_remains(group);
    }
    return result;
  }

  /// What no reading excludes of a group is one place: one run of starts near to fitting.
  void find_remains(Group& group) const {
    const std::string name = "cell " + std::to_string(group.first);
    Leftover leftover(document_, all_);
    try {
      for (std::size_t k = 0; k < group.count; ++k) {
        const std::size_t cell = (group.first + k) % cells_.size();
        leftover.add(rows_at(cell), rows_at(cell + 1));
      }
    } catch (const std::domain_error& error) {
      refuse(name + " (" + cells_[group.first].kind + "): " + error.what());
    }
    group.remains = leftover.remains();
    std::size_t runs = group.remains.runs;
    const bool is_round = group.whole && boundary_.closed();
    if (is_round && runs > 1 && group.remains.starts_open && group.remains.ends_open) --runs;
    if (runs == 0) refuse(name + " (" + cells_[group.first].kind + "): nothing fits there");
    if (runs > 1) refuse(name + " (" + cells_[group.first].kind + "): " + std::to_string(runs) + " places fit there");
  }

  Rows rows_at(std::size_t number) const {
    Rows result;
    for (const std::vector<Row>& rows : rows_) result.push_back(rows[number]);
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

  bool is_one(const Group& group, const std::string& kind) const { return group.count == 1 && has(group, kind); }

  /// In what remains of it; of one that claims nothing anywhere in it. An open outline's last start may lie beyond the
  /// last row.
  bool contains(const Group& group, const Place& place) const {
    if (group.whole && !group.proved) return true;
    const bool is_root = is_one(group, "crossing");
    const double slack = is_root ? kRootLength * period_ : kLengthSlack * period_;
    const std::vector<double> laps = boundary_.closed() ? std::vector<double>{-1, 0, 1} : std::vector<double>{0};
    return std::any_of(laps.begin(), laps.end(), [&](double lap) {
      const double s = place.s.middle() + lap * period_;
      if (group.proved) return group.remains.hold(s, slack);
      const std::size_t end = group.first + group.count;
      const std::size_t n = cells_.size();
      const double hi = end <= n ? start_of(end).s.middle() : start_of(end - n).s.middle() + period_;
      return s >= start_of(group.first).s.middle() - slack && s <= hi + slack;
    });
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
      const std::string kind = placement.at("kind").get<std::string>();
      Document::check_kind(name, kind);
      Document::Stated stated{placement.at("start"), placement.at("end"), placement.at("point"), {}};
      if (kind != "corner") stated.tangent = placement.at("tangent");  // there the finger pivots
      if (kind == "corner" && placement.contains("tangent")) refuse(name + " has a tangent, but pivots");
      document_.check_contact(name, start, readings_.back().length(), stated);
      const auto group = std::find_if(all.begin(), all.end(), [&](const Group& one) { return contains(one, start); });
      if (group == all.end()) refuse(name + " has no cell that proves it");
      if (group->used && group->proved) refuse(name + " is in the cells of another one");
      group->used = true;
      check_kind(name, kind, start, *group);
      if (readings_.size() == 1 && is_one(*group, "crossing")) {
        check_root(name, start, *group);
      } else if (!fits(start)) {
        refuse(name + " does not fit");
      }
    }
    for (const Group& group : all) {
      if (!group.used && group.proved) {
        refuse("cell " + std::to_string(group.first) + " proves a placement that is not listed");
      }
    }
  }

  bool pivots(const Place& start) const {
    const double reach = kLengthSlack * period_;
    return is_at_corner(boundary_, start.s, reach) ||
           std::any_of(readings_.begin(), readings_.end(), [&](const OneReading& reading) {
             return is_at_corner(boundary_, start.s + reading.length(), reach);
           });
  }

  void check_kind(const std::string& name, const std::string& kind, const Place& start, const Group& group) const {
    if (kind == "corner" && !pivots(start)) refuse(name + " is at no corner");
    if (!group.proved) return;
    const std::size_t end = (group.first + group.count) % cells_.size();
    const bool has_ends = boundary_.closed() || (group.first > 0 && group.first + group.count < cells_.size());
    const bool is_smooth = has_ends && !group.whole && !has_corner(group);
    bool fits = false;
    if (kind == "stretch") fits = has(group, "stretch");
    if (kind == "corner") fits = has(group, "corner") || has(group, "within");
    if (kind == "crossing" || kind == "touching") {
      const Row& last = rows_[0][boundary_.closed() ? end : group.first + group.count];
      const bool changes = readings_[0].changes_sign(rows_[0][group.first], last);
      const bool is_open = !is_smooth || readings_.size() > 1;
      fits = !has(group, "stretch") && !has(group, "corner") && (is_open || changes == (kind == "crossing"));
      if (readings_.size() == 1 && is_one(group, "crossing")) fits = kind == "crossing";
    }
    if (!fits) refuse(name + " is of another kind than its cells");
  }

  /// The one root of a cell is within the accuracy that is promised on either side of the start, in the cell.
  void check_root(const std::string& name, const Place& start, const Group& group) const {
    const Row& from = rows_[0][group.first];
    const Row& to = rows_[0][group.first + 1];
    const auto ahead = [&](const Place& place) {  // of the start, by the nearest lap
      const double way = (place.s - start.s).middle();
      return boundary_.closed() ? std::remainder(way, period_) : way;
    };
    for (const double share : kRootShares) {
      const double reach = share * kRootLength * period_;
      const bool from_cell = std::abs(ahead(from.start)) <= reach;
      const bool to_cell = std::abs(ahead(to.start)) <= reach;
      const std::optional<Row> lo = from_cell ? from : readings_[0].row_beside(start, -reach);
      const std::optional<Row> hi = to_cell ? to : readings_[0].row_beside(start, reach);
      if (!lo || !hi) continue;
      const double slope = std::abs((hi->f - lo->f).middle()) / (2 * reach);
      if (slope * reach >= kRootTurn) {
        if (sign_of(lo->f) * sign_of(hi->f) >= 0) refuse(name + " is not where f changes its sign");
      } else if (!abs(lo->f).is_below(2.2 * kRootTurn)) {
        refuse(name + " is not where f vanishes");
      }
      return;
    }
    refuse(name + " is too near to a joint");
  }

  /// The start itself fits every reading by one angle at once, as far as it can be told from what is beside it.
  bool fits(const Place& start) const {
    const double most = document_.tolerance() * (1 + kPlaceSlack) + kTurnSlack;
    for (const double share : kBeside) {
      const auto around = [&](const Ball& s) {
        const std::optional<Place> lo = boundary_.after_or_end(s - share * period_);
        const std::optional<Place> hi = boundary_.after_or_end(s + share * period_);
        return lo && hi ? std::optional<Segment>(Segment{*lo, *hi}) : std::nullopt;
      };
      const std::optional<Segment> starts = around(start.s);
      std::vector<Segment> ends;
      for (const OneReading& reading : readings_) {
        const std::optional<Segment> end = around(start.s + reading.length());
        if (end) ends.push_back(*end);
      }
      if (starts && ends.size() == readings_.size()) {
        return fit_together(boundary_, all_, *starts, ends, most);
      }
    }
    return false;
  }

  struct Interval {
    double lo = 0;
    double hi = 0;
    double width() const { return hi - lo; }
  };

  const Document& document_;
  const Boundary& boundary_;
  double period_;
  Interval starts_;  // all that leave room
  std::vector<OneReading> readings_;
  std::vector<const OneReading*> all_;
  std::vector<std::vector<Row>> rows_;  // of each reading, those that are stated in order
  std::vector<Cell> cells_;
};

}  // namespace

Verdict check_one_finger(const Document& document) { return OneFinger(document).check(); }

}  // namespace rollfix_verify
