#include "check_one.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "document.hpp"
#include "ranges.hpp"

namespace rollfix_verify {
namespace {

// |f| on a stretch, radians.
constexpr double kFlat = 4e-12;
// On what is excluded f misses the tolerance by at least this share of what it does at the nearer end.
constexpr double kShare = 0.9;
// Within a cell |f| may be larger than at its ends by this factor.
constexpr double kBeyond = 1.01;
constexpr int kMostDepth = 80;
constexpr std::size_t kMostParts = 400000;  // of a cell, before it is given up
// Where a cell is halved; the next ones where that is at a joint.
constexpr double kSplits[] = {0.4990234375, 0.5166015625, 0.4697265625};

/// What a cell is claimed to be.
struct Claim {
  enum Kind { apart, crossing, within, corner } kind = apart;
  double bound = 0;  // apart, corner: |f| is above it (but at the corner); within: below it
  int slope = 0;     // of a crossing
};

class OneFinger {
 public:
  explicit OneFinger(const Document& document)
      : document_(document),
        boundary_(document.boundary()),
        length_(document.json().at("reading").at("length").get<double>()),
        turn_(document.json().at("reading").at("turn").get<double>()),
        tolerance_(document.tolerance()),
        period_(document.period()) {}

  Verdict check() {
    document_.check();
    read_rows();
    check_cover();
    for (std::size_t k = 0; k < kinds_.size(); ++k) check_cell(k);
    check_placements();
    Verdict verdict{document_.json().at("placements").size(), kinds_.size(), 0, 0, {}};
    verdict.unproved = static_cast<std::size_t>(std::count(kinds_.begin(), kinds_.end(), "unproved"));
    return verdict;
  }

 private:
  std::optional<Row> row_at(const Place& start) const {
    const std::optional<Place> end = boundary_.after(start.s + length_);
    if (!end) return std::nullopt;
    return Row{start, *end, end->angle - start.angle - turn_, boundary_.taylor(start.curve, start.u),
               boundary_.taylor(end->curve, end->u)};
  }

  void read_rows() {
    for (const Json& stated : document_.json().at("rows")) {
      const std::string name = "row " + std::to_string(rows_.size());
      const std::optional<Row> row = row_at(document_.place_at(stated.at("start")));
      if (!row) refuse(name + " ends at a joint");
      const Place end = document_.place_at(stated.at("end"));
      if (!document_.is_as_far(row->end.s, end.s)) refuse(name + " ends elsewhere");
      const Ball slack = kTurnSlack + kRounding * period_ * (abs(row->start_ahead[0]) + abs(row->end_ahead[0]));
      if (!abs(row->f - Ball(stated.at("off").get<double>()) * tolerance_).is_below(slack)) {
        refuse(name + " turns by another angle");
      }
      rows_.push_back(*row);
      if (stated.contains("then")) kinds_.push_back(stated.at("then").get<std::string>());
    }
    if (rows_.empty()) refuse("it has no rows");
    if (!boundary_.closed()) return;
    Row again = rows_.front();  // one lap on
    for (Place* place : {&again.start, &again.end}) {
      place->curve += boundary_.curves();
      place->s = place->s + boundary_.perimeter();
      place->angle = place->angle + boundary_.total_turn();
    }
    rows_.push_back(again);
  }

  /// From row to row, all starts that there are.
  void check_cover() const {
    if (kinds_.size() + 1 != rows_.size()) refuse("its rows and cells do not go together");
    for (std::size_t k = 0; k + 1 < rows_.size(); ++k) {
      if (!rows_[k + 1].start.s.is_above(rows_[k].start.s)) refuse("row " + std::to_string(k + 1) + " lies behind");
    }
    if (boundary_.closed()) return;
    const double slack = kLengthSlack * period_;
    const double first = std::max(0.0, -length_.middle());
    const double last = period_ - std::max(0.0, length_.middle());
    if (!rows_.front().start.s.is_below(first + slack)) refuse("it leaves out starts at the beginning");
    if (!rows_.back().start.s.is_above(last - slack)) refuse("it leaves out starts at the end");
  }

  // ---- cells ----

  double size_of(const Row& row) const { return abs(row.f).lower(); }
  static int sign_of(const Row& row) { return row.f.is_above(0.0) ? 1 : row.f.is_below(0.0) ? -1 : 0; }

  /// f is outside the tolerance at both ends of a cell, on opposite sides of it.
  bool changes_sign(const Row& from, const Row& to) const {
    return size_of(from) > tolerance_ && size_of(to) > tolerance_ && sign_of(from) != sign_of(to);
  }

  Claim claim_of(const std::string& kind, const Row& from, const Row& to) const {
    const double nearer = std::min(size_of(from), size_of(to));
    if (kind == "apart") {
      if (!(nearer > tolerance_)) refuse("f is within the tolerance at an end of it");
      return {Claim::apart, tolerance_ + kShare * (nearer - tolerance_), 0};
    }
    if (kind == "crossing" || kind == "corner") {
      if (!changes_sign(from, to)) refuse("f does not change its sign from end to end of it");
      return {kind == "corner" ? Claim::corner : Claim::crossing, tolerance_, sign_of(to)};
    }
    if (kind == "stretch") return {Claim::within, kFlat, 0};
    if (kind == "within") {
      const double farther = std::max({abs(from.f).upper(), abs(to.f).upper(), tolerance_});
      return {Claim::within, kBeyond * farther, 0};
    }
    refuse("its kind '" + kind + "' is not known");
  }

  void check_cell(std::size_t k) const {
    if (kinds_[k] == "unproved") return;
    try {
      const Claim claim = claim_of(kinds_[k], rows_[k], rows_[k + 1]);
      std::size_t parts = 0;
      prove(rows_[k], rows_[k + 1], claim, 0, parts);
    } catch (const std::domain_error& error) {
      refuse("cell " + std::to_string(k) + " (" + kinds_[k] + "): " + error.what());
    }
  }

  bool is_narrow(const Row& from, const Row& to) const {
    return (to.start.s - from.start.s).is_below(kSamePlace * period_);
  }

  static bool misses(const Range& range, double bound) {
    return std::all_of(range.parts.begin(), range.parts.end(),
                       [&](const Ball& part) { return part.is_above(bound) || part.is_below(-bound); });
  }

  static bool meets(const Range& range, double bound) {
    return std::any_of(range.parts.begin(), range.parts.end(),
                       [&](const Ball& part) { return part.lower() <= bound && part.upper() >= -bound; });
  }

  /// What the claim says of a part of its cell, as far as this range tells.
  bool holds(const Claim& claim, const Range& range, const Row& from, const Row& to) const {
    if (!range.known) return false;
    const bool at_corner = range.corner && is_narrow(from, to);
    switch (claim.kind) {
      case Claim::crossing:
        return range.slope == claim.slope;
      case Claim::within:
        if (at_corner && meets(range, claim.bound)) return true;
        if (range.slope != 0) return abs(from.f).upper() <= claim.bound && abs(to.f).upper() <= claim.bound;
        return std::all_of(range.parts.begin(), range.parts.end(), [&](const Ball& part) {
          return part.upper() <= claim.bound && part.lower() >= -claim.bound;
        });
      case Claim::corner:
        if (at_corner && meets(range, 0)) return true;
        return misses(range, claim.bound);
      case Claim::apart:
        return misses(range, range.corner ? tolerance_ : claim.bound);
    }
    return false;
  }

  void prove(const Row& from, const Row& to, const Claim& claim, int depth, std::size_t& parts) const {
    if (holds(claim, range_between(boundary_, turn_, from, to), from, to)) return;
    if (depth == kMostDepth || ++parts > kMostParts) {
      refuse("it could not be proved near s = " + std::to_string(from.start.s.middle()));
    }
    const Row middle = between(from, to);
    prove(from, middle, claim, depth + 1, parts);
    prove(middle, to, claim, depth + 1, parts);
  }

  Row between(const Row& from, const Row& to) const {
    const double lo = from.start.s.middle();
    const double hi = to.start.s.middle();
    for (const double share : kSplits) {
      const double s = lo + share * (hi - lo);
      if (!(Ball(s).is_above(from.start.s) && to.start.s.is_above(s))) continue;
      const std::optional<Place> start = boundary_.after(s);
      const std::optional<Row> row = start ? row_at(*start) : std::nullopt;
      if (row) return *row;
    }
    refuse("it can't be halved near s = " + std::to_string(lo));
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
    const std::size_t n = kinds_.size();
    std::vector<Group> result;
    for (std::size_t k = 0; k < n; ++k) {
      if (kinds_[k] == "apart") continue;
      if (k > 0 && kinds_[k - 1] != "apart") {
        ++result.back().count;
      } else {
        result.push_back({k, 1});
      }
    }
    if (result.size() == 1 && result[0].count == n) result[0].whole = true;
    if (boundary_.closed() && result.size() > 1 && kinds_.front() != "apart" && kinds_.back() != "apart") {
      result.back().count += result.front().count;  // across the first row
      result.erase(result.begin());
    }
    return result;
  }

  const std::string& kind_in(const Group& group, std::size_t k) const {
    return kinds_[(group.first + k) % kinds_.size()];
  }

  bool has(const Group& group, const std::string& kind) const {
    for (std::size_t k = 0; k < group.count; ++k) {
      if (kind_in(group, k) == kind) return true;
    }
    return false;
  }

  bool contains(const Group& group, const Place& place) const {
    if (group.whole) return true;
    const Ball lo = rows_[group.first].start.s;
    const std::size_t end = group.first + group.count;
    const std::size_t n = kinds_.size();
    const Ball hi = end <= n ? rows_[end].start.s : rows_[end - n].start.s + boundary_.perimeter();
    const auto holds = [&](const Ball& s) { return s.is_above(lo) && s.is_below(hi); };
    return holds(place.s) || (boundary_.closed() && holds(place.s + boundary_.perimeter()));
  }

  /// Where f jumps its sign says nothing of what kind a placement is.
  bool has_corner(const Group& group) const {
    for (std::size_t k = 0; k < group.count; ++k) {
      const std::size_t cell = (group.first + k) % kinds_.size();
      if (spans_corner(boundary_, rows_[cell], rows_[cell + 1])) return true;
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
      document_.check_contact(name, start, length_, stated);
      const auto group = std::find_if(all.begin(), all.end(), [&](const Group& one) { return contains(one, start); });
      if (group == all.end() || (group->used && !has(*group, "unproved"))) {
        refuse(name + " has no cell of its own that proves it");
      }
      group->used = true;
      check_kind(name, placement.at("kind").get<std::string>(), *group);
      if (group->count == 1 && (has(*group, "crossing") || has(*group, "corner"))) check_root(name, start);
      if (has(*group, "within") || has(*group, "stretch")) check_fit(name, start);
    }
    for (const Group& group : all) {
      if (!group.used && !has(group, "unproved"))
        refuse("cell " + std::to_string(group.first) + " proves a placement that is not listed");
    }
  }

  void check_kind(const std::string& name, const std::string& kind, const Group& group) const {
    const std::size_t end = (group.first + group.count) % kinds_.size();
    const bool has_ends = boundary_.closed() || (group.first > 0 && group.first + group.count < kinds_.size());
    const bool is_smooth = has_ends && !group.whole && !has_corner(group);
    const bool is_proved = !has(group, "unproved");
    bool fits = false;
    if (kind == "stretch") fits = has(group, "stretch") || !is_proved;
    if (kind == "corner") fits = has(group, "corner") || !is_proved || has(group, "within");
    if (kind == "crossing" || kind == "touching") {
      const Row& last = rows_[boundary_.closed() ? end : group.first + group.count];
      const bool changes = changes_sign(rows_[group.first], last);
      fits = !has(group, "stretch") && !has(group, "corner") &&
             (!is_smooth || !is_proved || changes == (kind == "crossing"));
    }
    if (!fits) refuse(name + " is of another kind than its cells");
  }

  /// A root within the accuracy that is promised on either side of the start.
  void check_root(const std::string& name, const Place& start) const {
    const auto row_beside = [&](double distance) {
      const std::optional<Place> place = boundary_.after(start.s + distance);
      const std::optional<Row> row = place ? row_at(*place) : std::nullopt;
      if (!row) refuse(name + " is too near to a joint");
      return *row;
    };
    double reach = 1.1 * kRootLength * period_;
    const Row lo = row_beside(-reach);
    const Row hi = row_beside(reach);
    const double slope = std::abs((hi.f - lo.f).middle()) / (2 * reach);
    if (slope * reach >= kRootTurn) {
      if (sign_of(lo) * sign_of(hi) >= 0) refuse(name + " is not where f changes its sign");
    } else if (!abs(lo.f).is_below(2.2 * kRootTurn)) {
      refuse(name + " is not where f vanishes");
    }
  }

  /// The start itself fits, as far as it can be told from what is beside it.
  void check_fit(const std::string& name, const Place& start) const {
    const auto row_beside = [&](double distance) {
      const std::optional<Place> place = boundary_.after(start.s + distance);
      return place ? row_at(*place) : std::nullopt;
    };
    const double reach = 0.25 * kSamePlace * period_;
    const std::optional<Row> lo = row_beside(-reach);
    const std::optional<Row> hi = row_beside(reach);
    if (!lo || !hi) return;  // at an end of an open outline
    if (!meets(range_between(boundary_, turn_, *lo, *hi), tolerance_ * (1 + kPlaceSlack) + kTurnSlack)) {
      refuse(name + " does not fit");
    }
  }

  const Document& document_;
  const Boundary& boundary_;
  Ball length_;
  Ball turn_;
  double tolerance_;
  double period_;
  std::vector<Row> rows_;
  std::vector<std::string> kinds_;
};

}  // namespace

Verdict check_one_finger(const Document& document) { return OneFinger(document).check(); }

}  // namespace rollfix_verify
