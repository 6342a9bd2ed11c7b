#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "outline/turn.hpp"
#include "rollfix/answer/part_facts.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/table.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr double kSurely = 3;        // standard deviations within which two lengths are taken as equal
constexpr double kAgreement = 1e-9;  // contacts closer together than this share of the perimeter are the same

using Rows = std::vector<std::string>;

/// The text of one answer. What is of a finger is said of each.
class AnswerText {
 public:
  explicit AnswerText(const Answer& answer)
      : answer_(answer),
        fingers_(answer.finger_count()),
        decimals_(decimals_for(answer.part.perimeter())),
        unit_(behind(answer.part.unit())) {}

  std::string text(bool explain) const {
    std::string text = advice() + "\n" + diagnosis_lines() + "\n" + head() + dropped_lines(explain);
    if (!answer_.placements.empty()) text += "\n" + (answer_.weighing ? weighed_table() : placement_table());
    const std::string below = remarks() + pose_lines() + unresolved_lines();
    if (!below.empty()) text += "\n" + below;
    return text;
  }

 private:
  // ---- words ----

  /// The names in figures: a0 is where the first placement starts; of two fingers it is pair 0.
  std::string label(std::size_t i) const { return fingers_ == 1 ? fmt::format("a{}", i) : fmt::format("{}", i); }
  /// "start", of two fingers "start a" and "start b".
  std::string of(const std::string& what, std::size_t finger) const {
    return fingers_ == 1 ? what : what + (finger == 0 ? " a" : " b");
  }
  std::string place(double s) const { return fixed(s, decimals_); }
  /// In a text, with the unit.
  std::string at(double s) const { return place(s) + unit_; }
  std::string span(const Interval& interval) const {
    return fmt::format("from {} to {}", place(interval.lo), at(interval.hi));
  }
  std::string over_lengths(const std::string& title) const { return title_in(title, answer_.part.unit()); }
  std::string where(const Placement& placement) const {
    if (fingers_ == 1) {
      return fmt::format("s = {:.6g}, sd {:.2g}{}{}", placement.start[0], placement.sd[0], unit_, way_of(placement));
    }
    return fmt::format("finger a at s = {:.6g}, sd {:.2g}, finger b at {:.6g}, sd {:.2g}{}{}", placement.start[0],
                       placement.sd[0], placement.start[1], placement.sd[1], unit_, way_of(placement));
  }
  /// ", lengths counted cw", where that was to be found out.
  std::string way_of(const Placement& placement) const {
    if (!answer_.either_way) return "";
    return placement.clockwise ? ", lengths counted cw" : ", lengths counted ccw";
  }
  std::string more_line(std::size_t count) const {
    return count <= kMostRows ? "" : fmt::format("... and {} more; --json lists them all\n", count - kMostRows);
  }

  // ---- the verdict with what to do next ----

  std::string advice() const {
    const std::string verdict = answer_.verdict.text();
    if (answer_.weighing && (answer_.status == Status::complete || fingers_ == 2)) return verdict + weighed_advice();
    if (answer_.status == Status::incomplete) {
      return fmt::format("undecided: {} found, {} left open; try a larger --budget",
                         fingers_ == 1 ? counted(answer_.placements.size(), "placement", "placements")
                                       : counted(answer_.placements.size(), "pair", "pairs"),
                         fingers_ == 1 ? counted(answer_.unresolved.size(), "interval", "intervals")
                                       : counted(answer_.unresolved.size(), "box", "boxes"));
    }
    return verdict + searched_advice();
  }

  std::string searched_advice() const {
    const auto contradicted =
        static_cast<std::size_t>(std::count_if(answer_.placements.begin(), answer_.placements.end(),
                                               [](const Placement& placement) { return placement.is_contradicted; }));
    if (contradicted > 0) return advice_on_contradicted(contradicted);
    if (answer_.placements.empty() && !answer_.impossible.empty()) {
      return fmt::format(": {} would fit, but the finger can't get there; check the finger's size, or see --explain",
                         counted(answer_.impossible.size(), "placement", "placements"));
    }
    if (answer_.placements.empty() && !answer_.diagnoses.empty()) return ": nothing fits";
    if (answer_.placements.empty()) {
      return fmt::format(": nothing fits; check the units, the signs (positive along the outline), and the {}",
                         fingers_ == 1 ? "finger's radius" : "fingers' radii");
    }
    if (answer_.verdict.name == Verdict::unobservable && fingers_ == 2) {
      return all_the_way_round();
    }
    if (answer_.placements.size() > 1) return ": roll on to tell them apart";
    return advice_on_one(answer_.placements.front());
  }

  /// Without noise, where rows that were not searched with, or centres, don't go with some of what was found.
  std::string advice_on_contradicted(std::size_t count) const {
    constexpr const char* kBy = "contradicted by other rows of the log or by the contacts in the world";
    const std::size_t left = answer_.placements.size() - count;
    if (left > 0) {
      return fmt::format("{}; {} more that the readings allow {} {}, and {} last",
                         left == 1 ? advice_on_one(answer_.placements.front()) : "", count, count == 1 ? "is" : "are",
                         kBy, count == 1 ? "comes" : "come");
    }
    return fmt::format(": {} {}",
                       count == 1 ? "the place that the readings allow is" : "all that the readings allow are", kBy);
  }

  /// Whether it is the part's shape, or the roll's, that lets every place fit, and not the tolerance: the part looks
  /// the same all round, or the roll told nothing: none at all, or of two fingers equal ones under a part that did not
  /// turn.
  bool looks_the_same() const {
    const auto is_whole = [](const Placement& placement) {
      return placement.kind == Kind::stretch &&
             std::any_of(placement.whole_loop.begin(), placement.whole_loop.end(), [](bool b) { return b; });
    };
    if (!answer_.weighing) return std::any_of(answer_.placements.begin(), answer_.placements.end(), is_whole);
    if (symmetry(answer_.part) == 0) return true;
    const Noise& noise = answer_.weighing->noise;
    const double most_length = std::max(kAgreement * answer_.part.perimeter(), kSurely * noise.contact);
    return std::all_of(answer_.readings.begin(), answer_.readings.end(), [&](const Reading& reading) {
      const double length = fingers_ == 1 ? reading.length[0] : reading.length[0] - reading.length[1];
      return std::abs(length) <= most_length && std::abs(reading.turn) <= answer_.tolerance.value;
    });
  }
  std::string all_the_way_round() const {
    if (looks_the_same()) {
      return ": pairs all the way round the boundary fit; no such roll, however long, can tell them apart";
    }
    return fmt::format(": within the {} pairs all the way round the boundary fit; roll further, or {}",
                       answer_.weighing ? "noise" : "tolerance",
                       answer_.weighing ? "measure better" : "give more digits");
  }

  std::string advice_on_one(const Placement& only) const {
    if (fingers_ == 2) {
      if (answer_.verdict.name != Verdict::unique) return ": roll on to tell them apart";
      return fmt::format(": finger a started at s = {}, finger b at {}{}", at(only.start[0]), at(only.start[1]),
                         way_of(only));
    }
    if (only.kind == Kind::stretch) {
      return only.whole_loop[0] ? ": this roll looks the same from every place on the boundary"
                                : ": roll on, to where the curvature changes";
    }
    if (only.whole_loop[0]) return ": within the tolerance every place fits; give more digits, or roll further";
    const std::string lo = place(only.extent[0].lo);
    const std::string hi = place(only.extent[0].hi);
    if (lo == hi) return fmt::format(": the finger started at s = {}{}", at(only.start[0]), way_of(only));
    return fmt::format(": the finger started between s = {} and {}{}{}", lo, hi, unit_, way_of(only));
  }

  std::string weighed_advice() const {
    if (answer_.verdict.name == Verdict::inconsistent && !answer_.diagnoses.empty()) return ": nothing fits";
    if (answer_.placements.empty()) return ": nothing that fits is within the finger's reach";
    const Placement& first = answer_.placements.front();
    const Verdict& verdict = answer_.verdict;
    if (is_doubted() && verdict.name != Verdict::unobservable) {
      return fmt::format(": taken as said, the {} {}, but what follows is likelier",
                         verdict.name != Verdict::unique ? "likeliest start is"
                         : fingers_ == 1                 ? "finger started at"
                                                         : "roll started with",
                         where(first));
    }
    if (verdict.name == Verdict::unique) {
      return (fingers_ == 1 ? ": the finger started at " : ": the roll started with ") + where(first);
    }
    if (verdict.name == Verdict::unobservable) {
      if (fingers_ == 2) return all_the_way_round();
      return looks_the_same() ? ": this roll looks the same from every place on the boundary"
                              : ": within the noise every place fits; roll further, or measure better";
    }
    if (fingers_ == 1 && (answer_.placements.size() == 1 || verdict.stretches > 0)) {
      return fmt::format(": the likeliest start is {}; roll on to know it better", where(first));
    }
    return fmt::format(": the likeliest start is {}, with probability {:.2f}; roll on to tell them apart", where(first),
                       first.probability);
  }

  /// Whether something else explains the rows better than what was said of them.
  bool is_doubted() const {
    double total = 0;
    for (const Placement& placement : answer_.placements) total += placement.probability;
    constexpr double kDoubtful = 0.25;  // what is said is not more than a third as likely as what else there is
    return !answer_.diagnoses.empty() && total < kDoubtful;
  }

  /// What may be wrong, with the option that mends it and the answer then.
  std::string diagnosis_lines() const {
    std::string text;
    for (const Diagnosis& diagnosis : answer_.diagnoses) {
      const bool is_first = text.empty();
      text += fmt::format("{} {}\n  {}{}\n", is_first ? "likeliest:" : "or:       ", about(diagnosis),
                          cure_of(diagnosis, answer_.fingers, answer_.weighing ? answer_.weighing->noise : Noise{}),
                          then(diagnosis));
    }
    return text;
  }
  std::string then(const Diagnosis& diagnosis) const {
    if (diagnosis.modes.empty()) return "";
    const Mode& first = diagnosis.modes.front();
    const std::string start = fingers_ == 1
                                  ? fmt::format("s = {:.6g}, sd {:.2g}", first.start[0], first.sd[0])
                                  : fmt::format("a at s = {:.6g}, b at {:.6g}", first.start[0], first.start[1]);
    return fmt::format("; then {}: {}", diagnosis.verdict.text(), start);
  }

  // ---- what was asked ----

  std::string head() const {
    const Part& part = answer_.part;
    return fmt::format("part       {}, {}, perimeter {}\n", part.name(), part.closed() ? "closed" : "open",
                       at(part.perimeter())) +
           accuracy_line() + reading_lines() + direction_line() + tolerance_line() +
           (answer_.weighing ? weighing_lines() : "");
  }

  std::string accuracy_line() const {
    const Accuracy& accuracy = answer_.part.outline().accuracy;
    return accuracy.is_exact() ? "" : fmt::format("accuracy   of the taught part: {}\n", accuracy_text(accuracy));
  }

  std::string reading_lines() const {
    std::string text;
    for (std::size_t i = 0; i < answer_.readings.size(); ++i) {
      const Reading& reading = answer_.readings[i];
      const std::string lengths =
          fingers_ == 1 ? "length " + at(reading.length[0])
                        : fmt::format("lengths {} and {}", place(reading.length[0]), at(reading.length[1]));
      const std::string when = answer_.times.empty() ? "" : fmt::format(" at {:.6g} s", answer_.times[i]);
      text += fmt::format("reading    {}, turn {} deg{}\n", lengths, degrees(reading.turn), when);
    }
    if (answer_.facing) text += fmt::format("facing     {} deg\n", degrees(*answer_.facing));
    return text;
  }

  /// Where either way round was tried: what each has.
  std::string direction_line() const {
    if (!answer_.either_way) return "";
    double probability = 0;
    std::size_t count = 0;
    for (const Placement& placement : answer_.placements) {
      if (!placement.clockwise) continue;
      probability += placement.probability;
      ++count;
    }
    const auto placements = [](std::size_t n) { return counted(n, "placement", "placements"); };
    if (!answer_.weighing) {
      return fmt::format("direction  either: {} with lengths counted ccw, {} with lengths counted cw\n",
                         placements(answer_.placements.size() - count), placements(count));
    }
    return fmt::format("direction  either: lengths counted cw with probability {:.4f}\n", probability);
  }

  std::string tolerance_line() const {
    constexpr std::array<const char*, 6> kSources = {
        "default",  "from the digits given", "from the noise",
        "as given", "the least there is",    "from the accuracy of the taught part"};
    const Tolerance& tolerance = answer_.tolerance;
    return fmt::format("tolerance  {:.3g} deg = {:.3g} rad, {}\n", tolerance.value / kDegree, tolerance.value,
                       kSources[static_cast<std::size_t>(tolerance.source)]);
  }

  /// "noise      contact 0.1, ..." and what the samples are like.
  std::string weighing_lines() const {
    const Weighing& weighing = *answer_.weighing;
    std::vector<std::string> noise;
    for (const NoiseKind& kind : kNoiseKinds) {
      const double sd = weighing.noise.*kind.sd;
      if (sd == 0) continue;
      const bool is_of_gyroscope = kind.unit == NoiseKind::Unit::rate || kind.unit == NoiseKind::Unit::walk;
      if (is_of_gyroscope) {
        const bool is_rate = kind.unit == NoiseKind::Unit::rate;
        noise.push_back(fmt::format("{} {:.4g} {}", kind.name, sd / kDegree * (is_rate ? 3600 : 60),
                                    is_rate ? "deg/h" : "deg/sqrt(h)"));
        continue;
      }
      const std::string& unit = kind.unit == NoiseKind::Unit::length ? unit_ : "";
      noise.push_back(kind.unit == NoiseKind::Unit::angle ? fmt::format("{} {} deg", kind.name, degrees(sd))
                                                          : fmt::format("{} {:.4g}{}", kind.name, sd, unit));
    }
    std::string text = fmt::format("noise      {}{}\n", fmt::join(noise, ", "), weighing.robust ? "; robust" : "");
    if (weighing.prior) {
      text += fmt::format("prior      s = {:.6g}, sd {:.4g}{}\n", weighing.prior->s, weighing.prior->sd, unit_);
    }
    if (weighing.pose) text += "prior      " + prior_text(*weighing.pose) + '\n';
    text += scale_lines();
    text += fmt::format("samples    {}", weighing.samples);
    if (weighing.fit.excess > 1)
      text += fmt::format("; off by {:.2f} times the noise, widened by that", weighing.fit.excess);
    text += '\n';
    if (answer_.dropped.improbable > 0) {
      text += fmt::format("dropped    {} that the readings alone allow, but not all samples together\n",
                          answer_.dropped.improbable);
    }
    return text;
  }

  std::string prior_text(const PosePrior& prior) const {
    const std::string heading =
        fmt::format("heading {} deg, sd {} deg", degrees(prior.mean.heading), rough(prior.heading_sd / kDegree));
    if (!std::isfinite(prior.place_sd)) return "the part's " + heading;
    return fmt::format("the part at x = {:.6g}, y = {:.6g}, sd {:.4g}{}, {}", prior.mean.x, prior.mean.y,
                       prior.place_sd, unit_, heading);
  }

  /// What the rows say of the lengths, and what was taken as exact.
  std::string scale_lines() const {
    const Weighing& weighing = *answer_.weighing;
    std::string text;
    for (std::size_t finger = 0; finger < fingers_; ++finger) {
      const double sd = weighing.fit.length_scale_sd[finger];
      if (!(sd > 0)) continue;
      const double scale = weighing.fit.length_scale[finger];
      const std::string whose = fingers_ == 1 ? "" : finger == 0 ? "of finger a " : "of finger b ";
      text += fmt::format("lengths    {}{:.4f} +- {:.2g} times what was measured", whose, scale, sd);
      const double off = 100 * (scale - 1);
      if (std::abs(scale - 1) > 2 * sd) {
        text += fmt::format(": they are {:.2g} % {}", std::abs(off), off > 0 ? "longer" : "shorter");
      }
      text += '\n';
    }
    std::vector<std::string> exact;
    if (weighing.noise.slip <= 0) exact.emplace_back("slip");
    if (weighing.noise.radius <= 0 && !answer_.fingers.empty() && answer_.fingers.front().is_disk()) {
      exact.emplace_back("the finger's radius");
    }
    if (!exact.empty()) text += fmt::format("exact      {}: taken to be as said\n", fmt::join(exact, ", "));
    if (weighing.noise.position <= 0 && !answer_.placements.empty() && answer_.placements.front().pose_spread) {
      text += "centres    x and y only tell where the part is; --noise position=SD makes them evidence\n";
    }
    return text;
  }

  // ---- what the fingers can't do ----

  std::string dropped_lines(bool explain) const {
    const std::string hint = explain ? "" : " (--explain lists them)";
    std::string text;
    if (answer_.dropped.reach > 0) {
      text += fmt::format("dropped    {} that {} finger can't reach{}\n", answer_.dropped.reach,
                          fingers_ == 1 ? "the" : "a", hint);
    }
    if (answer_.dropped.overlap > 0) {
      text += fmt::format("dropped    {} whose fingers would overlap{}\n", answer_.dropped.overlap, hint);
    }
    if (!explain) return text;
    for (std::size_t k = 0; k < std::min(answer_.impossible.size(), kMostRows); ++k) {
      text += "  " + about_impossible(answer_.impossible[k]) + '\n';
    }
    return text + more_line(answer_.impossible.size());
  }

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

  // ---- the tables ----

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

  std::string placement_table() const {
    const std::string most = fingers_ == 2 || answer_.readings.size() > 1 ? "max " : "";
    Table table;
    table.add_column("", fingers_ == 1 ? Table::Align::left : Table::Align::right);
    table.add_column("kind", Table::Align::left);
    if (answer_.either_way) table.add_column("way", Table::Align::left);
    for (const char* title : {"start", "end", "width"}) add_columns(table, title);
    add_position_columns(table);
    for (std::size_t finger = 0; finger < fingers_; ++finger) {
      const char* change = fingers_ == 1 ? "ds" : finger == 0 ? "da" : "db";
      table.add_column(fmt::format("{}{}/dturn [{}/deg]", most, change, answer_.part.unit()));
    }
    if (fingers_ == 1) table.add_column(most + "ds/dlength");
    table.add_column(over_lengths("error"));
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostRows); ++i) {
      const Placement& placement = answer_.placements[i];
      Rows cells{label(i), name_of(placement.kind)};
      if (answer_.either_way) cells.emplace_back(placement.clockwise ? "cw" : "ccw");
      add_cells(cells, [&](std::size_t finger) { return place(placement.start[finger]); });
      add_cells(cells, [&](std::size_t finger) { return place(placement.end[finger]); });
      add_cells(cells, [&](std::size_t finger) { return rough(placement.extent[finger].width()); });
      add_position(placement, cells);
      const Sensitivity& sensitivity = placement.sensitivity;
      add_cells(cells, [&](std::size_t finger) {
        return rough(finger < sensitivity.per_turn.size() ? steepest(sensitivity.per_turn[finger]) * kDegree
                                                          : std::numeric_limits<double>::quiet_NaN());
      });
      if (fingers_ == 1) cells.push_back(rough(steepest_by_length(sensitivity)));
      cells.push_back(rough(placement.error));
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

  // ---- below the table ----

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

  const Answer& answer_;
  std::size_t fingers_;
  int decimals_;
  std::string unit_;  // behind a length
};

std::string place_text(const Part& part, double s, const Vec2& point) {
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("s = {}, ({}, {})", fixed(s, decimals), fixed(point.x(), decimals), fixed(point.y(), decimals));
}

}  // namespace

std::string about(const Obstruction& obstruction, const Part& part) {
  if (obstruction.concave_corner) {
    return "the finger would roll over the concave corner at " + place_text(part, obstruction.s, obstruction.hit.point);
  }
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("touching at s = {} the finger would hit the part at {}, {} deep", fixed(obstruction.s, decimals),
                     place_text(part, obstruction.hit.s, obstruction.hit.point), rough(obstruction.hit.depth));
}

std::string accuracy_text(const Accuracy& accuracy) {
  constexpr double kExact = 1e-8;  // radians, or a share: rounding
  std::vector<std::string> sds;
  if (accuracy.turn > kExact) {
    sds.push_back(fmt::format("tangents sd {:.3g} deg (alike over {:.3g})", accuracy.turn / kDegree, accuracy.alike));
  }
  if (accuracy.walk > 0) {
    sds.push_back(fmt::format("turns sd {:.3g} deg per square root of length", accuracy.walk / kDegree));
  }
  if (accuracy.length > kExact) sds.push_back(fmt::format("lengths sd {:.3g} %", 100 * accuracy.length));
  if (sds.empty()) return "that of exact rows: off by rounding alone";
  return fmt::format("{}", fmt::join(sds, ", "));
}

namespace {

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
  if (placement.pose_spread) return about_spread(*placement.pose_spread, answer) + face + "; " + agreement;
  return fmt::format("the part is{} at x = {}, y = {}{}, heading {} deg; {}", face, fixed(last.x, decimals),
                     fixed(last.y, decimals), behind(part.unit()), degrees(last.heading), agreement);
}

std::string answer_text(const Answer& answer, bool explain) { return AnswerText(answer).text(explain); }

}  // namespace rollfix::app
