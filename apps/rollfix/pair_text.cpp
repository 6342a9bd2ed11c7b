#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "rollfix/locate_outcome.hpp"
#include "rollfix/pair_outcome.hpp"
#include "rollfix/table.hpp"

namespace rollfix::app {
namespace {

std::string reading_lines(const PairOutcome& outcome) {
  const int decimals = decimals_for(outcome.part.perimeter());
  std::string text;
  for (std::size_t i = 0; i < outcome.readings.size(); ++i) {
    const PairReading& reading = outcome.readings[i];
    const std::string when = outcome.instants.empty() ? "" : fmt::format(" at {:.6g} s", outcome.instants[i]);
    text += fmt::format("reading    lengths {} and {}, turn {} deg{}\n", fixed(reading.length_a, decimals),
                        fixed(reading.length_b, decimals), degrees(reading.turn), when);
  }
  if (outcome.facing) text += fmt::format("facing     {} deg\n", degrees(*outcome.facing));
  return text;
}

/// The steepest of one finger's.
double steepest(const std::vector<double>& values) {
  double most = std::numeric_limits<double>::quiet_NaN();
  for (const double value : values) {
    if (!(std::abs(value) <= std::abs(most))) most = value;
  }
  return most;
}

std::string placement_table(const PairOutcome& outcome) {
  const std::vector<PairPlacement>& placements = outcome.found.placements;
  const int decimals = decimals_for(outcome.part.perimeter());
  Table table;
  table.add_column("", Table::Align::right);
  table.add_column("kind", Table::Align::left);
  for (const char* title :
       {"start a", "start b", "end a", "end b", "width a", "width b", "max da/dturn [/deg]", "max db/dturn [/deg]"}) {
    table.add_column(title);
  }
  if (outcome.weighing) {
    for (const char* title : {"probability", "sd a", "sd b"}) table.add_column(title);
  } else {
    table.add_column("error");
  }
  for (std::size_t i = 0; i < std::min(placements.size(), kMostRows); ++i) {
    const PairPlacement& placement = placements[i];
    std::vector<std::string> cells{fmt::format("{}", i),
                                   name_of(placement.kind),
                                   fixed(placement.start[0], decimals),
                                   fixed(placement.start[1], decimals),
                                   fixed(placement.end[0], decimals),
                                   fixed(placement.end[1], decimals),
                                   rough(placement.extent[0].width()),
                                   rough(placement.extent[1].width()),
                                   rough(steepest(placement.sensitivity.per_turn[0]) * kDegree),
                                   rough(steepest(placement.sensitivity.per_turn[1]) * kDegree)};
    if (outcome.weighing) {
      const PairMode& mode = outcome.weighing->modes[i];
      cells.push_back(fmt::format("{:.4f}", mode.probability));
      cells.push_back(rough(mode.sd[0]));
      cells.push_back(rough(mode.sd[1]));
    } else {
      cells.push_back(rough(placement.error));
    }
    table.add_row(std::move(cells));
  }
  std::string text = table.str();
  if (placements.size() > kMostRows) {
    text += fmt::format("... and {} more; --json lists them all\n", placements.size() - kMostRows);
  }
  return text;
}

std::string remark_on(const PairPlacement& placement, const Part& part) {
  const int decimals = decimals_for(part.perimeter());
  if (placement.kind == Kind::stretch) {
    if (placement.whole_loop[0] || placement.whole_loop[1]) return "fits all the way round the boundary";
    const PairPoint& from = placement.family.front();
    const PairPoint& to = placement.family.back();
    return fmt::format("a continuum of pairs, from ({}, {}) to ({}, {}); --json has its line", fixed(from[0], decimals),
                       fixed(from[1], decimals), fixed(to[0], decimals), fixed(to[1], decimals));
  }
  if (placement.roots.size() > 1) {
    return fmt::format("holds {} exact pairs, closer together than the tolerance can tell", placement.roots.size());
  }
  if (placement.roots.empty()) return "fits within the tolerance, nowhere exactly";
  return "";
}

std::string remarks(const PairOutcome& outcome) {
  std::string text;
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(outcome.found.placements.size(), kMostRows); ++i) {
    const std::string remark = remark_on(outcome.found.placements[i], outcome.part);
    if (!remark.empty() && ++count <= kMostNotes) text += fmt::format("{}: {}\n", i, remark);
  }
  if (count > kMostNotes) text += fmt::format("... and {} more such remarks\n", count - kMostNotes);
  for (std::size_t i = 0; i < std::min(outcome.poses.size(), kMostNotes); ++i) {
    if (outcome.poses[i]) text += fmt::format("{}: {}\n", i, about_pose(*outcome.poses[i], outcome.part));
  }
  const std::vector<PairBox>& unresolved = outcome.found.unresolved;
  const int decimals = decimals_for(outcome.part.perimeter());
  for (std::size_t i = 0; i < std::min(unresolved.size(), kMostNotes); ++i) {
    text += fmt::format("not decided: starts a from {} to {}, b from {} to {}\n", fixed(unresolved[i][0].lo, decimals),
                        fixed(unresolved[i][0].hi, decimals), fixed(unresolved[i][1].lo, decimals),
                        fixed(unresolved[i][1].hi, decimals));
  }
  if (unresolved.size() > kMostNotes) text += fmt::format("... and {} more boxes\n", unresolved.size() - kMostNotes);
  return text;
}

/// The verdict with what to do next.
std::string pair_advice(const PairOutcome& outcome) {
  const PairSearch& found = outcome.found;
  if (outcome.weighing) return advice(*outcome.weighing);
  const std::string verdict = found.verdict();
  if (found.status == Status::incomplete) {
    return fmt::format("{}: {} found, {} left open; try a larger --budget", verdict,
                       found.placements.size() == 1 ? "1 pair" : fmt::format("{} pairs", found.placements.size()),
                       found.unresolved.size() == 1 ? "1 box" : fmt::format("{} boxes", found.unresolved.size()));
  }
  if (found.placements.empty() && !outcome.dropped.items.empty()) {
    return verdict + ": " + all_dropped_advice(outcome.dropped.items.size());
  }
  if (found.placements.empty()) {
    return verdict + ": nothing fits; check the units, the signs (positive along the outline), and the fingers' radii";
  }
  if (verdict == "unobservable") {
    return verdict + ": pairs all the way round the boundary fit; no such roll, however long, can tell them apart";
  }
  if (verdict != "unique") return verdict + ": roll on to tell them apart";
  const int decimals = decimals_for(outcome.part.perimeter());
  const PairPlacement& only = found.placements.front();
  return fmt::format("{}: finger a started at s = {}, finger b at {}", verdict, fixed(only.start[0], decimals),
                     fixed(only.start[1], decimals));
}

}  // namespace

std::string pair_text(const PairOutcome& outcome) {
  const int decimals = decimals_for(outcome.part.perimeter());
  std::string text = pair_advice(outcome) + "\n\n";
  text += fmt::format("part       {}, {}, perimeter {}\n", outcome.part.name(),
                      outcome.part.closed() ? "closed" : "open", fixed(outcome.part.perimeter(), decimals));
  text += reading_lines(outcome);
  text += fmt::format("tolerance  {:.3g} deg = {:.3g} rad, {}\n", outcome.tolerance.value / kDegree,
                      outcome.tolerance.value, outcome.tolerance.source);
  if (outcome.weighing) text += weighing_lines(*outcome.weighing);
  text += dropped_text(outcome.dropped, outcome.part);
  if (!outcome.found.placements.empty()) text += "\n" + placement_table(outcome);
  const std::string below = remarks(outcome);
  if (!below.empty()) text += "\n" + below;
  return text;
}

}  // namespace rollfix::app
