#include "rollfix/certify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "places.hpp"
#include "residuals.hpp"
#include "rollfix/error.hpp"

// Notation, as in docs/certificates.md, "What is in it":
//   f_k(s)          Theta(s + L_k) - Theta(s) - theta_k of reading k: `f_[k]`, Residual; `off` is f_k / `tolerance_`
//   row             a start s and where each roll from it ends: Mark, then CertificateRow
//   cell            all starts from one row to the next, with a claim about them: `then` and `by`
//   found           what the search says of a stretch of starts, with rows on both sides of it: `from`, `to`
//   step            the least distance between places: `step_`; rows keep away from corners and joints
// Follows docs/certificates.md, "What is in it" (the table of cells) and "How it is checked".
// Idea: nothing is proved here. Rows are put beside every placement, where f is off by some tolerances (`kBeside`), and
// between placements where f comes nearest to the tolerance. rollfix-verify proves the claims by formulas of its own.
namespace rollfix::certifying {
namespace {

// A row beside a placement stands where f is off by so many tolerances: far enough to be told from one.
constexpr double kBeside = 1.5;
// It is looked for in steps that grow by this factor.
constexpr double kGrowth = 1.5;
// What no reading excludes as a whole is halved: so often at the most, and into so many cells.
constexpr int kMostStartHalvings = 40;
constexpr std::size_t kMostStartCells = 4000;

/// What the search says of a stretch of starts: a placement (or several, or none, where nothing is decided).
struct Found {
  Interval extent;  // of starts s, unwrapped: its upper end may exceed P
  std::vector<const Placement*> placements;
  bool decided = true;    // false: `unresolved` by the search, or joined with a neighbour
  bool is_whole = false;  // all of the outline
  double from = 0;        // its rows
  double to = 0;
};

/// A row to be, unwrapped, and what is claimed from there on.
struct Mark {
  double s = 0;
  CellKind then = CellKind::apart;
  std::vector<std::size_t> by;  // the readings of which
};

/// Draws up the rows of one certificate: what was found, rows beside it, cells in between. Used once.
class Maker {
 public:
  Maker(const Part& part, const std::vector<Reading>& readings, const Search& search, double tolerance)
      : part_(part),
        search_(search),
        tolerance_(tolerance),
        step_(least_step(part)),
        f_(part, readings, tolerance),
        range_(clear_starts(part, f_.lengths())) {}

  /// All rows by rising s. On a closed outline the last cell ends at the first row.
  std::vector<CertificateRow> rows() {
    list_found();
    if (found_.size() == 1 && found_.front().is_whole) {
      mark_whole();
    } else {
      find_edges();
      mark_all();
    }
    return rows_of_marks();
  }

 private:
  // ---- what was found ----

  /// Fills `found_` from the search: placements and what it left undecided, by rising s.
  void list_found() {
    for (const Placement& placement : search_.placements) {
      found_.push_back({placement.extent[0], {&placement}, true, placement.whole_loop[0], 0, 0});
    }
    for (const PerFinger<Interval>& interval : search_.unresolved) {
      const bool is_whole = part_.closed() && interval[0].width() >= part_.perimeter() - 8 * step_;
      found_.push_back({interval[0], {}, false, is_whole, 0, 0});
    }
    if (std::any_of(found_.begin(), found_.end(), [](const Found& one) { return one.is_whole; })) join_all();
    std::sort(found_.begin(), found_.end(),
              [](const Found& one, const Found& two) { return one.extent.lo < two.extent.lo; });
  }

  /// The whole loop is one piece; of several things on it nothing is claimed.
  void join_all() {
    Found whole{{0, part_.perimeter()}, {}, found_.size() == 1 && found_[0].decided, true, 0, 0};
    for (const Found& one : found_) {
      whole.placements.insert(whole.placements.end(), one.placements.begin(), one.placements.end());
    }
    found_ = {whole};
  }

  // ---- edges ----

  /// The arc length between this entry and the next one, where rows for both must stand. Unlimited after the last one
  /// of an open outline.
  double room_after(std::size_t k) const {
    if (k + 1 < found_.size()) return found_[k + 1].extent.lo - found_[k].extent.hi;
    if (!part_.closed()) return std::numeric_limits<double>::infinity();
    return found_.front().extent.lo + part_.perimeter() - found_.back().extent.hi;
  }

  /// Steps away from one end of an extent (`way` 1 or -1) until |f| is well outside the tolerance, and sets `row`.
  /// Stops before a corner if |f| is outside there, because beyond a jump f is another value. False: there is no room,
  /// or |f| stays too near to the tolerance in it.
  bool find_edge(double edge, int way, double room, double& row) const {
    const double most = room / 3;
    // A third of the room for this row, a third for the neighbour's, a third between them.
    if (!(most > 4 * step_)) return false;
    row = edge;
    double away = step_;
    for (bool is_last = false; !is_last; away *= kGrowth) {
      is_last = away >= most;
      double next = edge + way * std::min(away, most);
      // The end of an open outline needs no |f|: no start lies beyond it.
      if (!part_.closed() && (next <= range_.lo || next >= range_.hi)) {
        row = way < 0 ? range_.lo : range_.hi;
        return true;
      }
      next = f_.clear(next, way);
      if (row != edge && f_.size(row) > f_.edge() && f_.jumps(std::min(row, next), std::max(row, next))) return true;
      row = next;
      if (f_.size(row) >= kBeside * tolerance_) return true;
    }
    return f_.size(row) > f_.edge();
  }

  /// Gives each entry of `found_` its rows; entries without room are joined. Ends, for each join makes the list
  /// shorter.
  void find_edges() {
    for (std::size_t k = 0; k < found_.size();) {
      Found& one = found_[k];
      // Of a closed outline the first entry has the last one as its neighbour.
      const double before = k > 0 ? room_after(k - 1) : room_after(found_.size() - 1);
      if (find_edge(one.extent.lo, -1, before, one.from) && find_edge(one.extent.hi, 1, room_after(k), one.to)) {
        ++k;
        continue;
      }
      // The only entry has no row on one of its sides: nothing is claimed of the whole outline.
      if (found_.size() == 1) {
        join_all();
        found_[0].decided = false;
        return;
      }
      // A joined entry has another extent, which changes the room of its neighbours: all edges are looked for again.
      join_with_next(k);
      k = 0;
    }
  }

  /// Where two are too near each other to have rows in between, nothing is claimed of both.
  void join_with_next(std::size_t k) {
    // The last entry is joined with the one before it, all others with the next.
    const bool wraps = k + 1 == found_.size();
    Found& one = found_[wraps ? k - 1 : k];
    const Found& next = found_[wraps ? k : k + 1];
    one.extent.hi = next.extent.hi;
    one.placements.insert(one.placements.end(), next.placements.begin(), next.placements.end());
    one.decided = false;
    found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(wraps ? k : k + 1));
  }

  // ---- rows and cells ----

  /// A row at s, and the claim from there on. Marks come by rising s; at the place of the last mark the claim is
  /// replaced.
  void mark(double s, CellKind then, std::vector<std::size_t> by = {}) {
    if (marks_.empty() || s > marks_.back().s) {
      marks_.push_back({s, then, std::move(by)});
    } else {
      marks_.back().then = then;
      marks_.back().by = std::move(by);
    }
  }

  /// Where one entry is all of the outline: one row, and from it one cell around, in which flat parts are `stretch`.
  void mark_whole() {
    const double from = f_.clear(step_, 1);
    const double to = from + part_.perimeter();
    if (!found_[0].decided) {
      mark(from, CellKind::unproved);
    } else {
      mark(from, CellKind::within);
      if (is_stretch(found_[0])) mark_flat(from, to);
    }
    if (!part_.closed()) mark(range_.hi, CellKind::apart);
  }

  static bool is_stretch(const Found& one) { return one.placements[0]->kind == Kind::stretch; }

  /// Alternates between what is apart and what was found, from the first row once round, or from end to end.
  void mark_all() {
    const double period = part_.perimeter();
    double here = range_.lo;
    // If nothing was found the row stands where the first reading's |f| is least: there `apart` is hardest to claim.
    if (part_.closed()) here = found_.empty() ? f_.clear(f_[0].nearest(0, period), 1) : found_.front().from;
    const double end = part_.closed() ? here + period : range_.hi;
    for (const Found& one : found_) {
      mark_apart(here, one.from);
      if (!one.decided) {
        mark(one.from, CellKind::unproved);
      } else {
        // Nowhere but at the corner itself, or on a stretch around it?
        const bool is_wide = one.extent.width() > step_;
        const Kind kind = one.placements[0]->kind;
        mark_inside(one, kind == Kind::corner && is_wide ? Kind::touching : kind);
        if (is_stretch(one)) mark_flat(one.from, one.to);
      }
      // What lies behind the entry's last row is apart again, or belongs to the next entry.
      here = one.to;
    }
    mark_apart(here, end);
    if (!part_.closed()) mark(end, CellKind::apart);
  }

  /// Excluded by one reading, with a row where its f comes nearest to the tolerance; else in parts.
  void mark_apart(double lo, double hi, int depth = 0) {
    if (!(hi > lo)) return;
    if (const auto found = f_.exclusion(lo, hi)) {
      mark(lo, CellKind::apart, found->by);
      if (found->row) mark(*found->row, CellKind::apart, found->by);
      return;
    }
    // Depth and number of cells are limited: readings that nearly fit on a long stretch would be halved without end.
    const double middle = f_.split(lo, hi);
    if (depth == kMostStartHalvings || marks_.size() > kMostStartCells ||
        !(middle > lo + step_ && middle < hi - step_)) {
      mark(lo, CellKind::unproved);
      return;
    }
    mark_apart(lo, middle, depth + 1);
    mark_apart(middle, hi, depth + 1);
  }

  /// f is outside the tolerance at both ends, on different sides.
  bool changes_sign(const Residual& f, double lo, double hi) const {
    return std::min(f.size(lo), f.size(hi)) > tolerance_ && (f.at(lo) < 0) != (f.at(hi) < 0);
  }

  /// f has opposite signs two steps before and after a corner, and is outside the tolerance there by twice its blur.
  /// Then `corner` can be claimed.
  bool passes_corner(const Residual& f, double s) const {
    const double lo = s - 2 * step_;
    const double hi = s + 2 * step_;
    return changes_sign(f, lo, hi) &&
           std::min(f.size(lo), f.size(hi)) > tolerance_ + 2 * std::max(f.blur(lo), f.blur(hi));
  }

  /// The claim for the starts around one placement: `corner` or `crossing` by the first reading that shows it, else
  /// `within`.
  void mark_inside(const Found& one, Kind kind) {
    const double lo = one.from;
    const double hi = one.to;
    for (std::size_t k = 0; k < f_.count(); ++k) {
      if (!changes_sign(f_[k], lo, hi)) continue;
      if (kind == Kind::corner && passes_corner(f_[k], one.extent.lo)) return mark(lo, CellKind::corner, {k});
      if (kind == Kind::crossing && f_[k].is_monotone(lo, hi)) return mark(lo, CellKind::crossing, {k});
    }
    mark(lo, stays_within(one) ? CellKind::within : CellKind::unproved);
  }

  /// Whether no |f| beside a joint exceeds both the tolerance and its values at the two rows. It may, where a curve is
  /// at rest: there f leaves the tolerance at once and comes back.
  bool stays_within(const Found& one) const {
    for (std::size_t k = 0; k < f_.count(); ++k) {
      const double most = std::max({tolerance_, f_[k].size(one.from), f_[k].size(one.to)});
      if (f_[k].largest_at_joints(one.from, one.to) > most) return false;
    }
    return true;
  }

  /// Marks the parts of a stretch on which every f is 0 to rounding as `stretch`, and as `within` from their end on.
  void mark_flat(double lo, double hi) {
    // Flat parts come by rising s, so that marks do as well.
    for (const Interval& flat : f_.flat(lo, hi)) {
      const double from = f_.clear(flat.lo, 1);
      const double to = f_.clear(flat.hi, -1);
      const bool is_all = found_[0].is_whole && flat.width() > part_.perimeter() - 16 * step_;
      if (is_all) {
        marks_.back().then = CellKind::stretch;
        return;
      }
      // Less than the two steps that rows keep from joints.
      if (!(to > from)) continue;
      mark(from, CellKind::stretch);
      mark(to, CellKind::within);
    }
  }

  // ---- from marks to rows ----

  /// Places by the outline's formulas. `off` below `kTurnAccuracy` is rounding and is written as 0.
  CertificateRow row_at(const Mark& mark) const {
    CertificateRow row{place_of(part_, mark.s), {}, {}, mark.then, mark.by};
    for (std::size_t k = 0; k < f_.count(); ++k) {
      row.end.push_back(place_of(part_, mark.s + f_.lengths()[k]));
      row.off.push_back(f_[k].size(mark.s) <= kTurnAccuracy ? 0 : f_[k].at(mark.s) / tolerance_);
    }
    return row;
  }

  /// Marks to rows. On a closed outline s is reduced to [0, P), and the row with the least s comes first.
  std::vector<CertificateRow> rows_of_marks() {
    if (part_.closed()) {
      for (Mark& mark : marks_) mark.s = part_.boundary().base(mark.s);
      const auto first = std::min_element(marks_.begin(), marks_.end(),
                                          [](const Mark& one, const Mark& two) { return one.s < two.s; });
      std::rotate(marks_.begin(), first, marks_.end());
    }
    std::vector<CertificateRow> rows;
    for (const Mark& mark : marks_) rows.push_back(row_at(mark));
    return rows;
  }

  const Part& part_;
  const Search& search_;
  double tolerance_;
  double step_;  // the least between places
  Residuals f_;
  Interval range_;  // of starts
  std::vector<Found> found_;
  std::vector<Mark> marks_;
};

}  // namespace

}  // namespace rollfix::certifying

namespace rollfix {

const char* name_of(CellKind kind) {
  switch (kind) {
    case CellKind::apart:
      return "apart";
    case CellKind::crossing:
      return "crossing";
    case CellKind::corner:
      return "corner";
    case CellKind::within:
      return "within";
    case CellKind::stretch:
      return "stretch";
    case CellKind::unproved:
      break;
  }
  return "unproved";
}

/// Whether every cell claims something. The verifier may still leave cells open.
bool Certificate::is_complete() const {
  return std::none_of(rows.begin(), rows.end(),
                      [](const CertificateRow& row) { return row.then == CellKind::unproved; });
}

/// Searches by itself and draws up the certificate. Throws InputError: readings of two fingers, or with a turn that is
/// only bounded; a curve without a formula.
Certificate certify(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options) {
  for (const Reading& reading : readings) {
    if (reading.fingers() != 1) throw InputError("expected readings of one finger, found one of two fingers");
    if (!reading.is_exact()) {
      throw InputError(
          "certificates are of readings whose turn is known, found one on a corner of the finger; choose instants off "
          "the corners (`at`), of a log whose first row is off them too");
    }
  }
  const Search search = locate(part, readings, options);
  Certificate certificate;
  static_cast<CertifiedOutline&>(certificate) = certifying::certified_outline(part);
  certificate.readings = readings;
  // Below `kLeastTolerance` rounding of the search decides what is outside.
  certificate.tolerance = std::max(options.tolerance, kLeastTolerance);
  certificate.rows = certifying::Maker(part, readings, search, certificate.tolerance).rows();
  for (const Placement& placement : search.placements) {
    certificate.placements.push_back({placement, certifying::place_of(part, placement.start[0])});
  }
  return certificate;
}

}  // namespace rollfix
