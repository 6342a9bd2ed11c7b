#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "rollfix/locate_outcome.hpp"
#include "rollfix/table.hpp"

namespace rollfix::app {
namespace {

constexpr double kAgreement = 1e-9;  // contacts closer together than this share of the perimeter are the same

/// The names in figures: a0 is where the first placement starts.
std::string label(std::size_t i) { return fmt::format("a{}", i); }

/// The largest by size; of one reading simply its own.
double steepest(const Values& values) {
  double most = std::numeric_limits<double>::quiet_NaN();
  for (const double value : values) {
    if (std::isfinite(value) && !(std::abs(value) <= std::abs(most))) most = value;
  }
  return most;
}

std::string part_line(const Part& part) {
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("part       {}, {}, perimeter {}\n", part.name(), part.closed() ? "closed" : "open",
                     fixed(part.perimeter(), decimals));
}

std::string reading_lines(const LocateOutcome& outcome) {
  const int decimals = decimals_for(outcome.part.perimeter());
  std::string text;
  for (std::size_t i = 0; i < outcome.readings.size(); ++i) {
    const Reading& reading = outcome.readings[i];
    const std::string when = outcome.instants.empty() ? "" : fmt::format(" at {:.6g} s", outcome.instants[i]);
    text += fmt::format("reading    length {}, turn {} deg{}\n", fixed(reading.length, decimals), degrees(reading.turn),
                        when);
  }
  return text;
}

std::string tolerance_line(const Tolerance& tolerance) {
  return fmt::format("tolerance  {:.3g} deg = {:.3g} rad, {}\n", tolerance.value / kDegree, tolerance.value,
                     tolerance.source);
}

std::string more_line(std::size_t count) {
  if (count <= kMostRows) return "";
  return fmt::format("... and {} more; --json lists them all\n", count - kMostRows);
}

std::string placement_table(const LocateOutcome& outcome) {
  const std::vector<Placement>& placements = outcome.found.placements;
  const int decimals = decimals_for(outcome.part.perimeter());
  const std::string most = outcome.readings.size() > 1 ? "max " : "";
  Table table;
  table.add_column("", Table::Align::left);
  table.add_column("kind", Table::Align::left);
  for (const char* title : {"start", "end", "width", "tangent [deg]", "x", "y"}) table.add_column(title);
  table.add_column(most + "ds/dturn [/deg]");
  table.add_column(most + "ds/dlength");
  table.add_column("error");
  for (std::size_t i = 0; i < std::min(placements.size(), kMostRows); ++i) {
    const Placement& placement = placements[i];
    table.add_row({label(i), name_of(placement.kind), fixed(placement.start, decimals), fixed(placement.end, decimals),
                   rough(placement.extent.width()), degrees(placement.tangent), fixed(placement.point.x(), decimals),
                   fixed(placement.point.y(), decimals), rough(steepest(placement.sensitivity.per_turn) * kDegree),
                   rough(steepest(placement.sensitivity.per_length)), rough(placement.error)});
  }
  return table.str() + more_line(placements.size());
}

/// With noise: how probable each is, and how well it is known.
std::string weighed_table(const LocateOutcome& outcome) {
  const std::vector<Placement>& placements = outcome.found.placements;
  const int decimals = decimals_for(outcome.part.perimeter());
  Table table;
  table.add_column("", Table::Align::left);
  for (const char* title : {"probability", "start", "sd", "95 % from", "to", "end", "tangent [deg]", "x", "y"}) {
    table.add_column(title);
  }
  for (std::size_t i = 0; i < std::min(placements.size(), kMostRows); ++i) {
    const Placement& placement = placements[i];
    const Mode& mode = outcome.weighing->modes[i];
    table.add_row({label(i), fmt::format("{:.4f}", mode.probability), fixed(placement.start, decimals), rough(mode.sd),
                   fixed(mode.interval.lo, decimals), fixed(mode.interval.hi, decimals), fixed(placement.end, decimals),
                   degrees(placement.tangent), fixed(placement.point.x(), decimals),
                   fixed(placement.point.y(), decimals)});
  }
  return table.str() + more_line(placements.size());
}

/// "12.000 deg", or "from 12.000 to 34.000 deg"; turned by whole turns as the start's tangent is in the table.
std::string directions(const Interval& angles, double whole_turns) {
  const std::string lo = degrees(angles.lo - whole_turns);
  const std::string hi = degrees(angles.hi - whole_turns);
  return lo == hi ? lo + " deg" : fmt::format("from {} to {} deg", lo, hi);
}

std::string about_corner(const Pivot& pivot) {
  const double middle = pivot.start.middle();
  const double whole_turns = middle - std::remainder(middle, 2 * std::numbers::pi);
  return fmt::format("at a corner: the tangent points {} at the start, {} at the end",
                     directions(pivot.start, whole_turns), directions(pivot.end, whole_turns));
}

std::string remark_on(const Placement& placement, const Part& part) {
  const int decimals = decimals_for(part.perimeter());
  const std::string extent =
      fmt::format("from {} to {}", fixed(placement.extent.lo, decimals), fixed(placement.extent.hi, decimals));
  if (placement.kind == Kind::stretch) {
    return placement.whole_loop ? "every place on the boundary fits" : "every start " + extent + " fits";
  }
  if (placement.whole_loop) return "within the tolerance every place on the boundary fits";
  if (placement.kind == Kind::corner && placement.pivot) return about_corner(*placement.pivot);
  if (placement.roots.size() > 1) {
    return fmt::format("holds {} exact starts, closer together than the tolerance can tell", placement.roots.size());
  }
  if (placement.roots.empty()) return "fits within the tolerance, nowhere exactly";
  return "";
}

std::string remarks(const LocateOutcome& outcome) {
  std::string text;
  std::size_t count = 0;
  // Noise leaves hardly anything exact: there the probabilities say what is worth a remark.
  const std::size_t rows = outcome.weighing ? 0 : std::min(outcome.found.placements.size(), kMostRows);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::string remark = remark_on(outcome.found.placements[i], outcome.part);
    if (!remark.empty() && ++count <= kMostNotes) text += fmt::format("{}: {}\n", label(i), remark);
  }
  if (count > kMostNotes) text += fmt::format("... and {} more such remarks\n", count - kMostNotes);
  return text;
}

std::string pose_lines(const LocateOutcome& outcome) {
  std::string text;
  for (std::size_t i = 0; i < std::min(outcome.poses.size(), kMostNotes); ++i) {
    if (outcome.poses[i]) text += fmt::format("{}: {}\n", label(i), about_pose(*outcome.poses[i], outcome.part));
  }
  return text;
}

std::string unresolved_lines(const LocateOutcome& outcome) {
  const int decimals = decimals_for(outcome.part.perimeter());
  const std::vector<Interval>& unresolved = outcome.found.unresolved;
  std::string text;
  for (std::size_t i = 0; i < std::min(unresolved.size(), kMostNotes); ++i) {
    text += fmt::format("not decided: starts from {} to {}\n", fixed(unresolved[i].lo, decimals),
                        fixed(unresolved[i].hi, decimals));
  }
  if (unresolved.size() > kMostNotes) {
    text += fmt::format("... and {} more intervals\n", unresolved.size() - kMostNotes);
  }
  return text;
}

/// Where there is one placement only.
std::string advice_on_one(const std::string& verdict, const Placement& only, int decimals) {
  if (only.kind == Kind::stretch) {
    return only.whole_loop ? verdict + ": this roll looks the same from every place on the boundary"
                           : verdict + ": roll on, to where the curvature changes";
  }
  if (only.whole_loop) return verdict + ": within the tolerance every place fits; give more digits, or roll further";
  const std::string lo = fixed(only.extent.lo, decimals);
  const std::string hi = fixed(only.extent.hi, decimals);
  if (lo == hi) return fmt::format("{}: the finger started at s = {}", verdict, fixed(only.start, decimals));
  return fmt::format("{}: the finger started between s = {} and {}", verdict, lo, hi);
}

}  // namespace

std::string about_pose(const Poses& poses, const Part& part) {
  const int decimals = decimals_for(part.perimeter());
  const Pose& last = poses.pose.back();
  const double off = *std::max_element(poses.residual.begin(), poses.residual.end());
  const std::string agreement =
      off <= kAgreement * part.perimeter() ? "the contacts agree" : fmt::format("contacts off by {}", rough(off));
  return fmt::format("the part is at x = {}, y = {}, heading {} deg; {}", fixed(last.x, decimals),
                     fixed(last.y, decimals), degrees(last.heading), agreement);
}

std::string advice(const LocateOutcome& outcome) {
  const Search& found = outcome.found;
  if (outcome.weighing && found.status == Status::complete) return advice(*outcome.weighing);
  const std::string verdict = found.verdict();
  if (found.status == Status::incomplete) {
    return fmt::format(
        "{}: {} found, {} left open; try a larger --budget", verdict,
        found.placements.size() == 1 ? "1 placement" : fmt::format("{} placements", found.placements.size()),
        found.unresolved.size() == 1 ? "1 interval" : fmt::format("{} intervals", found.unresolved.size()));
  }
  if (found.placements.empty() && !outcome.dropped.items.empty()) {
    return verdict + ": " + all_dropped_advice(outcome.dropped.items.size());
  }
  if (found.placements.empty()) {
    return verdict + ": nothing fits; check the units, the signs (positive along the outline), and the finger's radius";
  }
  if (found.placements.size() > 1) return verdict + ": roll on to tell them apart";
  return advice_on_one(verdict, found.placements.front(), decimals_for(outcome.part.perimeter()));
}

std::string locate_text(const LocateOutcome& outcome) {
  std::string text = advice(outcome) + "\n\n" + part_line(outcome.part) + reading_lines(outcome) +
                     tolerance_line(outcome.tolerance) + (outcome.weighing ? weighing_lines(*outcome.weighing) : "") +
                     dropped_text(outcome.dropped, outcome.part);
  if (!outcome.found.placements.empty())
    text += "\n" + (outcome.weighing ? weighed_table(outcome) : placement_table(outcome));
  const std::string below = remarks(outcome) + pose_lines(outcome) + unresolved_lines(outcome);
  if (!below.empty()) text += "\n" + below;
  return text;
}

}  // namespace rollfix::app
