#include "rollfix/certify/certify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "places.hpp"
#include "residual.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
namespace {

// A row beside a placement stands where f is off by so many tolerances: far enough to be told from one.
constexpr double kBeside = 1.5;
// It is looked for in steps that grow by this factor.
constexpr double kGrowth = 1.5;
// A row on the edge of what is excluded is off by more than the tolerance by at least this share of it.
constexpr double kLeastMiss = 1e-3;

/// What the search says of a stretch of starts: a placement (or several, or none, where nothing is decided).
struct Found {
  Interval extent;  // unwrapped
  std::vector<const Placement*> placements;
  bool decided = true;
  bool is_whole = false;
  double from = 0;  // its rows
  double to = 0;
};

/// A row to be, unwrapped, and what is claimed from there on.
struct Mark {
  double s = 0;
  CellKind then = CellKind::apart;
};

class Maker {
 public:
  Maker(const Part& part, const Reading& reading, const Search& search, double tolerance)
      : part_(part), search_(search), f_(part, reading), tolerance_(tolerance), range_{0, part.perimeter()} {
    if (!part.closed()) range_ = clear_starts(part, {reading.length[0]});
  }

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

  void list_found() {
    for (const Placement& placement : search_.placements) {
      found_.push_back({placement.extent[0], {&placement}, true, placement.whole_loop[0], 0, 0});
    }
    for (const PerFinger<Interval>& interval : search_.unresolved) {
      const bool is_whole = part_.closed() && interval[0].width() >= part_.perimeter() - 8 * f_.step();
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

  // ---- their edges ----

  /// How far it is from here to the neighbours, for rows on both sides.
  double room_after(std::size_t k) const {
    if (k + 1 < found_.size()) return found_[k + 1].extent.lo - found_[k].extent.hi;
    if (!part_.closed()) return std::numeric_limits<double>::infinity();
    return found_.front().extent.lo + part_.perimeter() - found_.back().extent.hi;
  }

  /// A row outside of an edge: nothing where f does not get away from the tolerance in the room that there is.
  bool find_edge(double edge, int way, double room, double& row) const {
    double away = f_.step();
    const double most = room / 3;
    if (!(most > 4 * f_.step())) return false;
    for (bool is_last = false; !is_last; away *= kGrowth) {
      is_last = away >= most;
      row = edge + way * std::min(away, most);
      if (!part_.closed() && (row <= range_.lo || row >= range_.hi)) {
        row = way < 0 ? range_.lo : range_.hi;
        return true;
      }
      row = f_.clear(row, way);
      if (f_.size(row) >= kBeside * tolerance_) return true;
    }
    return f_.size(row) > (1 + kLeastMiss) * tolerance_;
  }

  void find_edges() {
    for (std::size_t k = 0; k < found_.size();) {
      Found& one = found_[k];
      const double before = k > 0 ? room_after(k - 1) : room_after(found_.size() - 1);
      if (find_edge(one.extent.lo, -1, before, one.from) && find_edge(one.extent.hi, 1, room_after(k), one.to)) {
        ++k;
        continue;
      }
      if (found_.size() == 1) {
        join_all();
        found_[0].decided = false;
        return;
      }
      join_with_next(k);
      k = 0;
    }
  }

  /// Where two are too near each other to have rows in between, nothing is claimed of both.
  void join_with_next(std::size_t k) {
    const bool wraps = k + 1 == found_.size();
    Found& one = found_[wraps ? k - 1 : k];
    const Found& next = found_[wraps ? k : k + 1];
    one.extent.hi = next.extent.hi;
    one.placements.insert(one.placements.end(), next.placements.begin(), next.placements.end());
    one.decided = false;
    found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(wraps ? k : k + 1));
  }

  // ---- rows and cells ----

  void mark(double s, CellKind then) {
    if (!marks_.empty() && s <= marks_.back().s) {
      marks_.back().then = then;
      return;
    }
    marks_.push_back({s, then});
  }

  void mark_whole() {
    const double from = f_.clear(f_.step(), 1);
    const double to = from + part_.perimeter();
    if (!found_[0].decided) {
      mark(from, CellKind::unproved);
    } else {
      mark_inside(from, to, Kind::touching);
      if (is_stretch(found_[0])) mark_flat(from, to);
    }
    if (!part_.closed()) mark(range_.hi, CellKind::apart);
  }

  static bool is_stretch(const Found& one) { return one.placements[0]->kind == Kind::stretch; }

  void mark_all() {
    const double first = found_.empty() ? 0 : found_.front().from;
    const double start = part_.closed() ? (found_.empty() ? f_.nearest(0, part_.perimeter()) : first) : range_.lo;
    const double end = part_.closed() ? start + part_.perimeter() : range_.hi;
    if (part_.closed() && found_.empty()) {
      mark(f_.clear(start, 1), CellKind::apart);
      return;
    }
    double here = start;
    for (const Found& one : found_) {
      mark_apart(here, one.from);
      if (!one.decided) {
        mark(one.from, CellKind::unproved);
      } else {
        // Nowhere but at the corner itself, or on a stretch around it?
        const bool is_wide = one.extent.width() > f_.step();
        const Kind kind = one.placements[0]->kind;
        mark_inside(one.from, one.to, kind == Kind::corner && is_wide ? Kind::touching : kind);
        if (is_stretch(one)) mark_flat(one.from, one.to);
      }
      here = one.to;
    }
    mark_apart(here, end);
    if (!part_.closed()) mark(end, CellKind::apart);
  }

  /// Excluded, with a row where f comes nearest to the tolerance.
  void mark_apart(double lo, double hi) {
    if (!(hi > lo)) return;
    mark(lo, CellKind::apart);
    const double ends = std::min(f_.size(lo), f_.size(hi));
    const double nearest = f_.clear(f_.nearest(lo, hi), 1);
    if (nearest > lo + f_.step() && nearest < hi - f_.step() && f_.size(nearest) < ends) mark(nearest, CellKind::apart);
  }

  bool changes_sign(double lo, double hi) const {
    return std::min(f_.size(lo), f_.size(hi)) > tolerance_ && (f_.at(lo) < 0) != (f_.at(hi) < 0);
  }

  void mark_inside(double lo, double hi, Kind kind) {
    CellKind cell = CellKind::within;
    if (kind == Kind::corner && changes_sign(lo, hi)) cell = CellKind::corner;
    if (kind == Kind::crossing && changes_sign(lo, hi) && f_.is_monotone(lo, hi)) cell = CellKind::crossing;
    mark(lo, cell);
  }

  /// Of what was marked from lo on, where f is 0 to rounding.
  void mark_flat(double lo, double hi) {
    for (const Interval& flat : f_.flat(lo, hi)) {
      const double from = f_.clear(flat.lo, 1);
      const double to = f_.clear(flat.hi, -1);
      const bool is_all = found_[0].is_whole && flat.width() > part_.perimeter() - 16 * f_.step();
      if (is_all) {
        marks_.back().then = CellKind::stretch;
        return;
      }
      if (!(to > from)) continue;
      mark(from, CellKind::stretch);
      mark(to, CellKind::within);
    }
  }

  // ---- from marks to rows ----

  CertificateRow row_at(const Mark& mark) const {
    const double f = f_.at(mark.s);
    const bool is_rounding = std::abs(f) <= kTurnAccuracy;
    return {f_.place(mark.s), f_.place(mark.s + f_.length()), is_rounding ? 0 : f / tolerance_, mark.then};
  }

  /// By rising s from 0 on.
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
  Residual f_;
  double tolerance_;
  Interval range_;  // of starts
  std::vector<Found> found_;
  std::vector<Mark> marks_;
};

}  // namespace

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

bool Certificate::is_complete() const {
  return std::none_of(rows.begin(), rows.end(),
                      [](const CertificateRow& row) { return row.then == CellKind::unproved; });
}

Certificate certify(const Part& part, const Reading& reading, const LocateOptions& options) {
  if (reading.fingers() != 1) throw InputError("certificates are of one finger's reading, found one of two fingers");
  Certificate certificate;
  static_cast<CertifiedOutline&>(certificate) = certified_outline(part);
  certificate.reading = reading;
  certificate.tolerance = std::max(options.tolerance, kLeastTolerance);
  const Search search = locate(part, reading, options);
  Maker maker(part, reading, search, certificate.tolerance);
  certificate.rows = maker.rows();
  const Residual residual(part, reading);
  for (const Placement& placement : search.placements) {
    certificate.placements.push_back({placement, residual.place(placement.start[0])});
  }
  return certificate;
}

}  // namespace rollfix
