#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/output/answer_output.hpp"

namespace rollfix::app {
namespace {

class DroppedText : AnswerWords {
 public:
  explicit DroppedText(const Answer& answer) : AnswerWords(answer) {}

  std::string text(bool explain) const {
    const std::string hint = explain ? "" : " (--explain lists them)";
    std::string text;
    if (answer_.dropped.reach > 0) {
      text += fmt::format("dropped    {} that {} finger can't reach{}\n", answer_.dropped.reach,
                          fingers_ == 1 ? "the" : "a", hint);
    }
    if (answer_.dropped.overlap > 0) {
      text += fmt::format(
          "dropped    {} whose fingers would overlap{}; of fingers at different heights say --may-overlap\n",
          answer_.dropped.overlap, hint);
    }
    if (!explain) return text;
    for (std::size_t k = 0; k < std::min(answer_.impossible.size(), kMostRows); ++k) {
      text += "  " + about_impossible(answer_.impossible[k]) + '\n';
    }
    return text + more_line(answer_.impossible.size());
  }

 private:
  std::string about_impossible(const Impossible& item) const {
    const PerFinger<double>& start = item.placement.start;
    const std::string starts =
        fingers_ == 1 ? "start " + place(start[0]) : fmt::format("starts {} and {}", place(start[0]), place(start[1]));
    const std::string head = fmt::format("{} ({}): ", starts, name_of(item.placement.kind));
    if (item.reason == Impossible::Reason::overlap) {
      const std::string when = item.instant == 0 ? "at the first contacts" : fmt::format("at instant {}", item.instant);
      return head + fmt::format("the fingers would overlap by {} {}", rough(item.depth), when);
    }
    const std::string who = fingers_ == 1 ? "" : item.finger == 0 ? "finger a: " : "finger b: ";
    return head + who + about(item.obstruction, answer_.part);
  }
};

std::string place_text(const Part& part, double s, const Vec2& point) {
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("s = {}, ({}, {})", fixed(s, decimals), fixed(point.x(), decimals), fixed(point.y(), decimals));
}

}  // namespace

std::string dropped_lines(const Answer& answer, bool explain) { return DroppedText(answer).text(explain); }

std::string about(const Obstruction& obstruction, const Part& part) {
  if (obstruction.concave_corner) {
    return "the finger would roll over the concave corner at " + place_text(part, obstruction.s, obstruction.hit.point);
  }
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("touching at s = {} the finger would hit the part at {}, {} deep", fixed(obstruction.s, decimals),
                     place_text(part, obstruction.hit.s, obstruction.hit.point), rough(obstruction.hit.depth));
}

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

namespace {

constexpr double kAgreement = 1e-9;  // contacts closer together than this share of the perimeter are the same

/// The sections one below the other, and what is special about some placements.
class AnswerText : AnswerWords {
 public:
  explicit AnswerText(const Answer& answer) : AnswerWords(answer) {}

  std::string text(const AnswerDetail& detail) const {
    std::string text = verdict_lines(answer_) + "\n";
    if (!answer_.placements.empty()) text += placements_table(answer_, detail.verbose) + "\n";
    const std::string below = remarks() + pose_lines() + unresolved_lines();
    if (!below.empty()) text += below + "\n";
    return text + asked_lines(answer_, detail.verbose) + dropped_lines(answer_, detail.explain);
  }

 private:
  /// "12.000 deg", or "from 12.000 to 34.000 deg"; turned by whole turns as the start's tangent is in the table.
  static std::string directions(const Interval& angles, double whole_turns) {
    const std::string lo = degrees(angles.lo - whole_turns);
    const std::string hi = degrees(angles.hi - whole_turns);
    return lo == hi ? lo + " deg" : fmt::format("from {} to {} deg", lo, hi);
  }

  static std::string about_corner(const Pivot& pivot) {
    const double middle = pivot.start.middle();
    const double whole_turns = middle - std::remainder(middle, kFullTurn);
    return fmt::format("at a corner: the tangent points {} at the start, {} at the end",
                       directions(pivot.start, whole_turns), directions(pivot.end, whole_turns));
  }

  std::string remark_on(const Placement& placement) const {
    const bool goes_round =
        std::any_of(placement.whole_loop.begin(), placement.whole_loop.end(), [](bool b) { return b; });
    if (placement.kind == Kind::stretch) {
      if (goes_round) return fingers_ == 1 ? "every place on the boundary fits" : "fits all the way round the boundary";
      if (fingers_ == 1) return "every start " + span(placement.extent[0]) + " fits";
      const PerFinger<double>& from = placement.family.front();
      const PerFinger<double>& to = placement.family.back();
      return fmt::format("a continuum of pairs, from ({}, {}) to ({}, {}); --json has its line", place(from[0]),
                         place(from[1]), place(to[0]), place(to[1]));
    }
    if (fingers_ == 1 && goes_round) return "within the tolerance every place on the boundary fits";
    if (fingers_ == 1 && placement.kind == Kind::corner && placement.pivot) return about_corner((*placement.pivot)[0]);
    if (placement.roots.size() > 1) {
      return fmt::format("holds {} exact {}, closer together than the tolerance can tell", placement.roots.size(),
                         fingers_ == 1 ? "starts" : "pairs");
    }
    if (placement.roots.empty()) return "fits within the tolerance, nowhere exactly";
    return "";
  }

  std::string remarks() const {
    if (answer_.weighing)
      return "";  // noise leaves hardly anything exact: the probabilities say what is worth a remark
    std::string text;
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostRows); ++i) {
      const std::string remark = remark_on(answer_.placements[i]);
      if (!remark.empty() && ++count <= kMostNotes) text += fmt::format("{}: {}\n", label(i), remark);
    }
    if (count > kMostNotes) text += fmt::format("... and {} more such remarks\n", count - kMostNotes);
    return text;
  }

  std::string pose_lines() const {
    std::string text;
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostNotes); ++i) {
      const Placement& placement = answer_.placements[i];
      if (!placement.pose.empty()) text += fmt::format("{}: {}\n", label(i), about_pose(placement, answer_));
    }
    return text;
  }

  std::string unresolved_lines() const {
    std::string text;
    const std::size_t count = answer_.unresolved.size();
    for (std::size_t i = 0; i < std::min(count, kMostNotes); ++i) {
      const PerFinger<Interval>& open = answer_.unresolved[i];
      text += fingers_ == 1 ? fmt::format("not decided: starts {}\n", span(open[0]))
                            : fmt::format("not decided: starts a {}, b {}\n", span(open[0]), span(open[1]));
    }
    if (count > kMostNotes) {
      text += fmt::format("... and {} more {}\n", count - kMostNotes, fingers_ == 1 ? "intervals" : "boxes");
    }
    return text;
  }
};

/// With noise: where the part was at the first contacts, as all rows have it, and how sure that is.
std::string about_spread(const PoseSpread& spread, const Answer& answer) {
  const int decimals = decimals_for(answer.part.perimeter());
  const auto sd = [&](int k) { return std::sqrt(std::max(0.0, spread.covariance(k, k))); };
  const std::string instant = answer.pose_time.empty() ? "" : fmt::format(", at {:.6g} s,", answer.pose_time.front());
  const std::string heading =
      sd(2) < std::numbers::pi
          ? fmt::format("heading {} ± {} deg", degrees(spread.mean.heading), rough(sd(2) / kDegree))
          : "its heading unknown";
  return fmt::format("at the first contact{} the part was at x = {} ± {}, y = {} ± {}{}, {}", instant,
                     fixed(spread.mean.x, decimals), rough(sd(0)), fixed(spread.mean.y, decimals), rough(sd(1)),
                     behind(answer.part.unit()), heading);
}

}  // namespace

std::string about_pose(const Placement& placement, const Answer& answer) {
  const Part& part = answer.part;
  const int decimals = decimals_for(part.perimeter());
  const Pose& last = placement.pose.back();
  const double off = placement.pose_residual->length;
  const std::string agreement =
      off <= kAgreement * part.perimeter() ? "the contacts agree" : fmt::format("contacts off by {}", rough(off));
  const std::string face = answer.mirrored ? " face down" : "";
  // With noise the contacts are off along the part by as much as the start is: that says nothing of what was felt.
  if (placement.pose_spread) return about_spread(*placement.pose_spread, answer) + face;
  return fmt::format("the part is{} at x = {}, y = {}{}, heading {} deg; {}", face, fixed(last.x, decimals),
                     fixed(last.y, decimals), behind(part.unit()), degrees(last.heading), agreement);
}

std::string answer_text(const Answer& answer, const AnswerDetail& detail) { return AnswerText(answer).text(detail); }

}  // namespace rollfix::app
