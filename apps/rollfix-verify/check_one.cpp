#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "cells.hpp"
#include "check.hpp"
#include "document.hpp"

// Notation, as in docs/certificates.md:
//   s               a start; a row is a start with the rolls of all readings from it: `rows_[k]`
//   f(s)            Theta(s + L) - Theta(s) - theta of a reading: Row::f; its bounds are those of cells.cpp
//   X               the starts at which every |f| is within the tolerance
//   cell            all starts from one row to the next, with its claim: `kind`, `by`; a group is a run of cells that
//                   are not apart
// Follows docs/certificates.md, "What 'proved' means" and "How it is checked". Each start is in a cell, for rows rise
// and go once round, or from end to end (check_cover). T1, nothing else: check_cell for what is apart, find_remains for
// the rest of each group. T2, each is there: fits, or check_root. T3, kind and count: check_cell and is_of_kind. T4,
// the question: read_row, and Document.
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

/// Neighbouring cells that are not apart, from row to row.
struct Group {
  std::vector<std::size_t> cells;
  std::optional<Remains> remains = std::nullopt;  // nothing where one of them is unproved
  bool is_used = false;                           // by a placement
};

/// Checks one certificate of one finger; used once. Every refusal is a std::domain_error with its reason.
class OneFinger {
 public:
  explicit OneFinger(const Document& document)
      : document_(document), boundary_(document.boundary()), period_(document.period()) {
    for (const Json& stated : document.json().at("readings")) readings_.emplace_back(document, stated);
    if (readings_.empty()) refuse("it has no readings");
    for (const OneReading& reading : readings_) all_.push_back(&reading);
    contacts_ = contacts(all_);
    starts_ = document.starts(contacts_);
    // An open outline shorter than a roll has no start at all.
    if (!(starts_.hi > starts_.lo)) refuse("no start leaves room for its rolls");
  }

  /// The verdict without the question. What is wrong refuses; cells that claim nothing are counted.
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
      // From row to row, as a share of all starts.
      verdict.share += (start_of(k + 1).s - start_of(k).s).upper() / starts_.width();
    }
    return verdict;
  }

 private:
  // ---- rows ----

  const Place& start_of(std::size_t row) const { return rows_[row].front().start; }

  /// T4: the end of each roll and what it is off by must be what follows from the formulas; a row may not be at a
  /// corner, where f has several values.
  void read_row(const Json& stated) {
    const std::string name = "row " + std::to_string(rows_.size());
    const Place start = document_.place_at(stated.at("start"));
    if (stated.at("end").size() != readings_.size() || stated.at("off").size() != readings_.size()) {
      refuse(name + " is not of each reading");
    }
    Rows rows;
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      const std::optional<Row> row = readings_[k].row_at(start);
      if (!row) refuse(name + " ends at a joint");
      const Place end = document_.place_at(stated.at("end").at(k));
      document_.require_as_far(row->end.s, end.s, name + ", end, as a place");
      // What rounded places change f by, through the curvature at both ends of the roll.
      const Ball slack = kTurnSlack + kRounding * period_ * (abs(row->from_start[0]) + abs(row->from_end[0]));
      const auto off = stated.at("off").at(k).get<double>();
      if (!abs(row->f - Ball(off) * document_.tolerance()).is_below(slack)) {
        refuse_number(name + ", off, in tolerances", off, row->f * (1 / document_.tolerance()));
      }
      rows.push_back(*row);
    }
    if (is_at_corner(boundary_, start.s, contacts_, kClear * period_)) refuse(name + " is at a corner");
    rows_.push_back(rows);
    // The last row of an open outline ends the last cell and begins none.
    if (stated.contains("then")) read_cell(stated, name);
  }

  /// `by` may be left out: of the first reading.
  void read_cell(const Json& stated, const std::string& name) {
    cells_.push_back({stated.at("then").get<std::string>(), stated.value("by", std::vector<std::size_t>{0})});
    for (const std::size_t by : cells_.back().by) {
      if (by >= readings_.size()) refuse(name + " names a reading that is not there");
    }
    if (cells_.back().by.empty()) refuse(name + " names no reading");
  }

  /// A closed outline's first row again, one lap on.
  void close_rows() {
    if (rows_.empty()) refuse("it has no rows");
    if (!boundary_.closed()) return;
    rows_.push_back(rows_.front());
    for (Row& row : rows_.back()) {
      row.start = boundary_.moved(row.start, 1);
      row.end = boundary_.moved(row.end, 1);
    }
  }

  /// From row to row, all starts that there are.
  void check_cover() const {
    const std::size_t count = rows_.size();
    if (cells_.size() + 1 != count) refuse("its rows and cells do not go together");
    for (std::size_t k = 0; k + 1 < count; ++k) {
      if (!start_of(k + 1).s.is_above(start_of(k).s)) refuse("row " + std::to_string(k + 1) + " lies behind");
    }
    if (boundary_.closed()) return;
    // First and last row at the ends of all starts: an open outline is covered from end to end.
    const double slack = kLengthSlack * period_;
    if (!start_of(0).s.is_below(starts_.lo + slack)) refuse("it leaves out starts at the beginning");
    if (!start_of(count - 1).s.is_above(starts_.hi - slack)) refuse("it leaves out starts at the end");
  }

  // ---- cells ----

  [[noreturn]] void refuse_cell(std::size_t k, const std::string& why) const {
    refuse("cell " + std::to_string(k) + " (" + cells_[k].kind + "): " + why);
  }

  /// T1 of cells that are apart, T3 of those that count: `crossing`, `corner`, `stretch`.
  void check_cell(std::size_t k) const {
    const Cell& cell = cells_[k];
    if (cell.kind == "unproved" || cell.kind == "within") return;  // of that its group says the rest
    try {
      // Two readings together; `crossing` and `corner` are of the readings named, `stretch` of all of them.
      if (cell.is_of_two()) return prove_apart(cell, start_of(k), start_of(k + 1));
      for (std::size_t by = 0; by < readings_.size(); ++by) {
        if (!cell.is_of(by)) continue;
        const Row& from = rows_[k][by];
        const Row& to = rows_[k + 1][by];
        if (cell.kind == "corner") {
          prove_corner(by, from, to);
        } else {
          readings_[by].prove(cell.kind, from, to);
        }
      }
    } catch (const std::domain_error& error) {
      refuse_cell(k, error.what());
    }
  }

  /// T3: f changes its sign, all that is not excluded is one piece, and that is narrow parts at corners. With `near` =
  /// 0 nothing passes as merely near: at a corner that turns by a few tolerances all of the jump would.
  void prove_corner(std::size_t by, const Row& from, const Row& to) const {
    if (!readings_[by].changes_sign(from, to)) refuse("f does not change its sign from end to end of it");
    Remains remains(document_, {&readings_[by]}, 0);
    remains.add({from}, {to});
    if (remains.pieces(false) != 1) refuse("f does not pass 0 at one corner");
    if (!remains.are_corners()) refuse("f fits beside the corner as well");
  }

  /// Nowhere do both readings fit.
  void prove_apart(const Cell& cell, const Place& from, const Place& to) const {
    const OneReading& other = readings_[cell.by[1]];
    const OneReading beyond = readings_[cell.by[0]].beyond(other);
    // The start of the difference is where the other reading's roll ends.
    const auto row_at = [&](const Place& start) {
      const std::optional<Row> row = beyond.row_at(start.s + other.length());
      if (!row) refuse("it ends at a joint");
      return *row;
    };
    beyond.prove(cell.kind, row_at(from), row_at(to));
  }

  // ---- groups ----

  /// Runs of neighbouring cells that are not apart. Each is to be one placement. From the first cell on that is apart,
  /// so that none is cut at the first row; of an open outline from the beginning.
  std::vector<Group> groups() const {
    const std::size_t count = cells_.size();
    std::size_t first = 0;
    while (boundary_.closed() && first < count && cells_[first].kind != "apart") ++first;
    std::vector<Group> result;
    bool goes_on = false;
    // In order round the outline, from a cell that is apart if there is one.
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t k = (first + i) % count;
      const bool is_apart = cells_[k].kind == "apart";
      if (!is_apart && !goes_on) result.emplace_back();
      if (!is_apart) result.back().cells.push_back(k);
      goes_on = !is_apart;
    }
    for (Group& group : result) {
      if (!has(group, "unproved")) find_remains(group);
    }
    return result;
  }

  /// What no reading excludes of a group is one place: one piece of starts near to fitting.
  void find_remains(Group& group) const {
    const std::size_t first = group.cells.front();
    group.remains.emplace(document_, all_, kNear);
    try {
      for (const std::size_t k : group.cells) group.remains->add(rows_[k], rows_[k + 1]);
    } catch (const std::domain_error& error) {
      refuse_cell(first, error.what());
    }
    const std::size_t pieces = group.remains->pieces(is_whole(group) && boundary_.closed());
    // A group without anything left would prove a placement where there is none.
    if (pieces == 0) refuse_cell(first, "nothing fits there");
    if (pieces > 1) refuse_cell(first, std::to_string(pieces) + " places fit there");
  }

  bool is_whole(const Group& group) const { return group.cells.size() == cells_.size(); }

  bool has(const Group& group, const std::string& kind) const {
    return std::any_of(group.cells.begin(), group.cells.end(), [&](std::size_t k) { return cells_[k].kind == kind; });
  }

  /// The only case in which the number of roots is proved.
  bool is_crossing(const Group& group) const { return group.cells.size() == 1 && has(group, "crossing"); }

  /// In what remains of it; of one that claims nothing anywhere in it. An open outline's last start may lie beyond the
  /// last row.
  bool contains(const Group& group, const Place& place) const {
    if (is_whole(group) && !group.remains) return true;
    const double slack = (is_crossing(group) ? kRootLength : kLengthSlack) * period_;
    const std::size_t first = group.cells.front();
    const std::size_t last = group.cells.back();
    // The group passes s = 0: its end is one lap on.
    const double lap = last < first ? period_ : 0;
    const Interval all{start_of(first).s.middle(), start_of(last + 1).s.middle() + lap};
    const std::vector<double>& laps = boundary_.laps();
    return std::any_of(laps.begin(), laps.end(), [&](double shift) {
      const double s = place.s.middle() + shift;
      return group.remains ? group.remains->hold(s, slack) : all.holds({s, s}, slack);
    });
  }

  /// Whether some roll of the group's starts has a contact that passes a corner.
  bool has_corner(const Group& group) const {
    return std::any_of(group.cells.begin(), group.cells.end(), [&](std::size_t k) {
      for (std::size_t by = 0; by < readings_.size(); ++by) {
        if (spans_corner(boundary_, rows_[k][by], rows_[k + 1][by])) return true;
      }
      return false;
    });
  }

  // ---- placements ----

  /// Each group with something left has exactly one placement, each placement its group.
  void check_placements() const {
    std::vector<Group> all = groups();
    std::size_t number = 0;
    for (const Json& placement : document_.json().at("placements")) {
      check_placement("placement " + std::to_string(number++), placement, all);
    }
    for (const Group& group : all) {
      if (group.is_used || !group.remains) continue;
      refuse("cell " + std::to_string(group.cells.front()) + " proves a placement that is not listed");
    }
  }

  /// T2 and T3 of one placement. Throws std::domain_error.
  void check_placement(const std::string& name, const Json& placement, std::vector<Group>& all) const {
    const std::string kind = Document::kind_of(name, placement);
    const Place start = document_.contact(name, placement, readings_.back().length());
    const auto group = std::find_if(all.begin(), all.end(), [&](const Group& one) { return contains(one, start); });
    if (group == all.end()) refuse(name + " has no cell that proves it");
    // A group that claims nothing may hold several.
    if (group->is_used && group->remains) refuse(name + " is in the cells of another one");
    group->is_used = true;
    if (kind == "corner" && !is_at_corner(boundary_, start.s, contacts_, kLengthSlack * period_)) {
      refuse(name + " is at no corner");
    }
    if (group->remains && !is_of_kind(*group, kind)) refuse(name + " is of another kind than its cells");
    // One reading, one root: the start is compared with it. Else the start itself must fit.
    if (readings_.size() == 1 && is_crossing(*group)) {
      check_root(name, start, group->cells.front());
    } else if (!fits(start)) {
      refuse(name + " does not fit");
    }
  }

  /// T3: whether the stated kind agrees with the claims of the cells; true where they do not decide it.
  bool is_of_kind(const Group& group, const std::string& kind) const {
    if (kind == "stretch") return has(group, "stretch");
    if (kind == "corner") return has(group, "corner") || has(group, "within");
    if (readings_.size() == 1 && is_crossing(group)) return kind == "crossing";
    if (has(group, "stretch") || has(group, "corner")) return false;
    // Where f jumps its sign says nothing of what kind a placement is, nor does that of one reading of several.
    const bool has_ends = boundary_.closed() || (group.cells.front() > 0 && group.cells.back() + 1 < cells_.size());
    if (readings_.size() > 1 || !has_ends || is_whole(group) || has_corner(group)) return true;
    const Row& from = rows_[group.cells.front()][0];
    const Row& to = rows_[group.cells.back() + 1][0];
    // Opposite signs on both sides: it crosses; the same sign: it touches.
    return readings_[0].changes_sign(from, to) == (kind == "crossing");
  }

  /// The one root of a cell is within the accuracy that is promised on either side of the start, in the cell: f has
  /// opposite signs there. Where f is too flat for that, it must vanish at the start, to rounding.
  void check_root(const std::string& name, const Place& start, std::size_t cell) const {
    const auto beside = [&](const Row& end, double way) {  // the cell's end, where that is nearer
      const double ahead = (end.start.s - start.s).middle();
      const bool is_near = std::abs(boundary_.closed() ? std::remainder(ahead, period_) : ahead) <= std::abs(way);
      return is_near ? end : readings_[0].row_at(start.s + way);
    };
    // A little further than the root is stated to; another share where that is at a joint.
    for (const double share : kRootShares) {
      const double reach = share * kRootLength * period_;
      const std::optional<Row> lo = beside(rows_[cell][0], -reach);
      const std::optional<Row> hi = beside(rows_[cell + 1][0], reach);
      if (!lo || !hi) continue;
      const double slope = std::abs((hi->f - lo->f).middle()) / (2 * reach);
      // Steep enough that f is clearly not 0 at that distance; else f itself must be 0 to rounding at the start.
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
      // Each contact anywhere within a place's width: places are told no better.
      std::vector<Segment> around;  // of each contact
      for (const Ball& contact : contacts_) {
        const std::optional<Place> lo = boundary_.after_or_end(start.s + contact - share * period_);
        const std::optional<Place> hi = boundary_.after_or_end(start.s + contact + share * period_);
        if (lo && hi) around.push_back({*lo, *hi});
      }
      if (around.size() == contacts_.size()) return fit_together(boundary_, all_, around, most);
    }
    return false;
  }

  const Document& document_;
  const Boundary& boundary_;
  double period_;
  std::vector<OneReading> readings_;
  Readings all_;
  std::vector<Ball> contacts_;  // how far from a start
  Interval starts_;             // all that leave room
  std::vector<Rows> rows_;      // in order
  std::vector<Cell> cells_;
};

}  // namespace

Verdict check_one_finger(const Document& document) { return OneFinger(document).check(); }

}  // namespace rollfix_verify
