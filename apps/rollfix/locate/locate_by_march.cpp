#include "rollfix/locate/locate_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/march.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/program.hpp"
#include "text/text.hpp"

// `locate --march`: the answer by the paper's own algorithm, with its counts.
// Notation:
//   h, T / h        a step of the curves' parameter; steps of one loop: `steps_per_loop`
//   (s, t)          what was found: `start`, of one finger s alone
// Follows the paper (Jia, IROS 2001): section 2, eqs. (4) and (5), in `march_one`; section 3, eqs. (8) and (9), in
// `march_two`. docs/march.md.
// Idea: the march takes one reading of one finger, or two of two. Readings beyond these only drop what they do not fit,
// by the turning function.
namespace rollfix::app {
namespace {

/// A find of either algorithm; an entry for each finger.
struct Found {
  std::vector<double> start;  // arc length, in [0, P) of a closed part
  std::vector<double> end;    // at the last reading
  std::string how;
  double error = 0;        // of the start, length
  double residual = 0;     // radians
  double rate = 0;         // Lemma 2; 0 for bisection and at a boundary
  std::size_t rounds = 0;  // of the iteration, or halvings of the bisection
};

/// Steps of one kind.
struct Counted {
  std::string name;
  std::size_t count = 0;
};

/// What either march found, in one form.
struct Marched {
  std::vector<Found> found;
  std::size_t further = 0;                        // finds that a further reading does not fit
  std::vector<std::vector<Interval>> unresolved;  // an interval for each finger
  std::vector<Counted> steps;                     // by what they are for
  std::size_t total = 0;
  std::size_t rounds = 0;
  std::size_t steps_per_loop = 0;  // T/h

  bool complete() const { return unresolved.empty(); }
};

/// How a segment was found; `boundary`: at the end of a mode.
const char* name_of(march::Found found) {
  switch (found) {
    case march::Found::case_1:
      return "case 1";
    case march::Found::case_2:
      return "case 2";
    case march::Found::bisection:
      return "bisection";
    case march::Found::boundary:
      break;
  }
  return "boundary";
}

/// Likewise of a pair.
const char* name_of(march::PairFound found) {
  switch (found) {
    case march::PairFound::bisection:
      return "bisection";
    case march::PairFound::iteration:
      return "iteration";
    case march::PairFound::boundary:
      break;
  }
  return "boundary";
}

/// Section 2.
/// The paper's segments for the first reading; `doubts` become unresolved intervals.
Marched march_one(const Part& part, const MarchQuestion& question) {
  march::Options options;
  options.step = question.step;
  const march::March prepared(part.outline(), march::curvature_density(), options);
  const march::Result result = prepared.segments(question.readings.front().length[0], question.readings.front().turn);
  Marched marched;
  for (const march::Segment& segment : result.segments) {
    marched.found.push_back({{segment.start},
                             {},
                             name_of(segment.found),
                             segment.error,
                             segment.integral_error,
                             segment.rate,
                             segment.iterations});
  }
  for (const march::Doubt& doubt : result.doubts) marched.unresolved.push_back({doubt.where});
  marched.steps = {{"preprocessing", result.steps.preprocessing},
                   {"start", result.steps.start},
                   {"marching", result.steps.marching},
                   {"bisection", result.steps.bisection}};
  marched.total = result.steps.total();
  marched.rounds = result.iterations;
  marched.steps_per_loop = result.steps_per_loop;
  return marched;
}

/// Section 3.
/// The paper's pairs for the first two readings.
Marched march_two(const Part& part, const MarchQuestion& question) {
  march::PairMarchOptions options;
  options.step = question.step;
  const MarchReading& first = question.readings[0];
  const MarchReading& second = question.readings[1];
  const march::PairResult result =
      march::PairMarch(part.outline(), options)
          .pairs({first.length[0], first.length[1], first.turn}, {second.length[0], second.length[1], second.turn});
  Marched marched;
  for (const march::StartPair& pair : result.pairs) {
    marched.found.push_back({{pair.s, pair.t},
                             {},
                             name_of(pair.found),
                             pair.error,
                             std::max(pair.residual_8, pair.residual_9),
                             pair.rate,
                             pair.iterations});
  }
  for (const march::PairDoubt& doubt : result.doubts) marched.unresolved.push_back({doubt.s, doubt.t});
  marched.steps = {{"preprocessing", result.steps.preprocessing}, {"stationary", result.steps.stationary},
                   {"evaluation", result.steps.evaluation},       {"subintervals", result.steps.subintervals},
                   {"iteration", result.steps.iteration},         {"bisection", result.steps.bisection}};
  marched.total = result.steps.total();
  marched.rounds = result.iterations;
  marched.steps_per_loop = result.steps_per_loop;
  return marched;
}

/// By how much a reading is off for a roll from these starts: the turning function tells.
/// |Phi of finger a's roll - Phi of finger b's - theta|, radians; of one finger without the second term.
double residual(const Part& part, const MarchReading& reading, const std::vector<double>& start) {
  double turn = -reading.turn;
  for (std::size_t i = 0; i < start.size(); ++i) {
    const double along = part.turning().angle(start[i] + reading.length[i]) - part.turning().angle(start[i]);
    turn += i == 0 ? along : -along;
  }
  return std::fabs(turn);
}

/// "To eliminate the ambiguities, the disk continues rolling": whatever a further reading does not fit goes.
void judge_by_further_readings(const Part& part, const MarchQuestion& question, std::size_t used, Marched& marched) {
  // The largest residual over all further readings; the readings that were searched with are not compared again.
  const auto misfit = [&](Found& found) {
    for (std::size_t k = used; k < question.readings.size(); ++k) {
      found.residual = std::max(found.residual, residual(part, question.readings[k], found.start));
    }
    return used < question.readings.size() && found.residual > question.tolerance;
  };
  const auto rest = std::remove_if(marched.found.begin(), marched.found.end(), misfit);
  marched.further = static_cast<std::size_t>(marched.found.end() - rest);
  marched.found.erase(rest, marched.found.end());
  for (Found& found : marched.found) {
    for (std::size_t i = 0; i < found.start.size(); ++i) {
      // The end of the roll after the last reading; on a closed part on the first lap.
      const double end = found.start[i] + question.readings.back().length[i];
      found.end.push_back(part.closed() ? wrap(end, part.perimeter()).base : end);
    }
  }
}

std::string march_verdict(const Marched& marched) {
  if (!marched.complete()) return "undecided";
  if (marched.found.empty()) return "inconsistent";
  return marched.found.size() == 1 ? "unique" : fmt::format("ambiguous ({})", marched.found.size());
}

/// As `locate` lists a placement, with what the march alone knows: how it was found, rate and rounds.
Json placement_json(const Part& part, const Found& found) {
  Json extent = Json::array(), point = Json::array(), tangent = Json::array();
  for (const double start : found.start) {
    extent.push_back(json_interval({start, start}));
    const Vec2 where = part.point(start);
    point.push_back(Json::array({json_number(where.x()), json_number(where.y())}));
    tangent.push_back(json_number(part.tangent(start)));
  }
  return {{"kind", "crossing"},
          {"start", json_numbers(found.start)},
          {"end", json_numbers(found.end)},
          {"extent", extent},
          {"roots", Json::array({json_numbers(found.start)})},
          {"error", json_number(found.error)},
          {"point", point},
          {"tangent", tangent},
          {"residual", json_number(found.residual)},
          {"sensitivity", nullptr},
          {"probability", nullptr},
          {"pose", nullptr},
          {"found", found.how},
          {"rate", json_number(found.rate)},
          {"rounds", found.rounds}};
}

/// Schema rollfix/locate/1 with `method` march.
std::string march_json(const Part& part, const MarchQuestion& question, const Marched& marched) {
  Json readings = Json::array(), placements = Json::array(), unresolved = Json::array();
  for (const MarchReading& reading : question.readings) {
    readings.push_back({{"length", json_numbers(reading.length)}, {"turn", json_number(reading.turn)}});
  }
  for (const Found& found : marched.found) placements.push_back(placement_json(part, found));
  for (const std::vector<Interval>& where : marched.unresolved) {
    Json box = Json::array();
    for (const Interval& interval : where) box.push_back(json_interval(interval));
    unresolved.push_back(where.size() == 1 ? box.front() : box);
  }
  Json counts = {{"steps_per_loop", marched.steps_per_loop}, {"rounds", marched.rounds}, {"steps", marched.total}};
  for (const Counted& counted : marched.steps) counts[counted.name] = counted.count;
  return json_text({{"schema", "rollfix/locate/1"},
                    {"method", "march"},
                    {"status", marched.complete() ? "complete" : "incomplete"},
                    {"verdict", march_verdict(marched)},
                    {"part", part_json(part)},
                    {"fingers", question.readings.front().length.size()},
                    {"readings", readings},
                    {"tolerance", json_number(question.tolerance)},
                    {"placements", placements},
                    {"dropped", {{"further_reading", marched.further}}},
                    {"unresolved", unresolved},
                    {"counts", counts}});
}

/// No more than kMostRows rows.
std::string table_of(const Part& part, const Marched& marched) {
  const int decimals = decimals_for(part.perimeter());
  const bool two = marched.found.front().start.size() == 2;
  Table table;
  table.add_column("", Table::Align::left);
  table.add_column("found by", Table::Align::left);
  for (const char* title : {"start", "end"}) {
    for (const char* finger : {" a", " b"}) {
      if (two || finger[1] == 'a') table.add_column(two ? std::string(title) + finger : title);
    }
  }
  for (const char* title : {"rate", "rounds", "error"}) table.add_column(title);
  for (std::size_t k = 0; k < std::min(marched.found.size(), kMostRows); ++k) {
    const Found& found = marched.found[k];
    std::vector<std::string> cells{fmt::format("{}{}", two ? "" : "a", k), found.how};
    for (const std::vector<double>& places : {found.start, found.end}) {
      for (const double place : places) cells.push_back(fixed(place, decimals));
    }
    for (const std::string& cell : {found.rate == 0 ? std::string("-") : fixed(found.rate, 6),
                                    std::to_string(found.rounds), rough(found.error)}) {
      cells.push_back(cell);
    }
    table.add_row(std::move(cells));
  }
  const std::size_t more = marched.found.size() - std::min(marched.found.size(), kMostRows);
  return '\n' + table.str() + (more == 0 ? "" : fmt::format("... and {} more; --json lists them all\n", more));
}

/// As `locate` prints its answer.
std::string march_text(const Part& part, const MarchQuestion& question, const Marched& marched) {
  const int decimals = decimals_for(part.perimeter());
  const auto loop = static_cast<double>(marched.steps_per_loop);
  std::string text = fmt::format("{}: by the paper's march\n\npart       {}, {}, perimeter {}{}\n",
                                 march_verdict(marched), plain(part.name()), part.closed() ? "closed" : "open",
                                 fixed(part.perimeter(), decimals), behind(part.unit()));
  for (const MarchReading& reading : question.readings) {
    std::string lengths = fixed(reading.length[0], decimals);
    if (reading.length.size() == 2) lengths += " and " + fixed(reading.length[1], decimals);
    text += fmt::format("reading    length{} {}, turn {} deg\n", reading.length.size() == 2 ? "s" : "", lengths,
                        degrees(reading.turn));
  }
  text += fmt::format("T/h        {} steps make one loop\n", marched.steps_per_loop);
  text += fmt::format("steps      {} = {:.3f} T/h:", marched.total, static_cast<double>(marched.total) / loop);
  for (const Counted& counted : marched.steps) {
    text += fmt::format("{} {} {}", &counted == marched.steps.data() ? "" : ",", counted.name, counted.count);
  }
  text += fmt::format("\nrounds     {}\n", marched.rounds);
  if (marched.further > 0) text += fmt::format("dropped    {} that a further reading does not fit\n", marched.further);
  if (!marched.found.empty()) text += table_of(part, marched);
  for (const std::vector<Interval>& where : marched.unresolved) {
    text += "not decided: starts";
    for (const Interval& interval : where) {
      text += fmt::format("{} from {} to {}", &interval == where.data() ? "" : ",", fixed(interval.lo, decimals),
                          fixed(interval.hi, decimals));
    }
    text += '\n';
  }
  return text;
}

}  // namespace

void add_march_arguments(CLI::App& command, MarchArguments& arguments) {
  add_switch(command, "--march", arguments.march, "answer by the algorithm that the paper publishes, with its counts");
  command.add_option("--step", arguments.step, "with --march: the paper's h, a step of the curves' parameter")
      ->type_name("H");
}

double read_step(const MarchArguments& arguments) {
  if (arguments.step.empty()) return 0;
  if (!arguments.march) throw InputError("--step is the march's: give --march as well");
  const double step = read_number(arguments.step, "--step " + arguments.step);
  if (!(step > 0)) throw InputError(fmt::format("--step {}: expected a number above 0", arguments.step));
  return step;
}

/// One reading is used for one finger, two for two; all others judge what was found.
Report locate_by_march(const Part& part, const MarchQuestion& question) {
  // One reading of one finger, two of two: as many as fingers.
  const std::size_t used = question.readings.front().length.size();
  if (question.readings.size() < used) {
    throw InputError("--march: the paper needs two readings of two fingers, found one; leave --march out");
  }
  Marched marched;
  try {
    marched = used == 1 ? march_one(part, question) : march_two(part, question);
  } catch (const march::Refusal& refusal) {
    throw InputError(fmt::format("{}; leave --march out", refusal.what()));
  }
  judge_by_further_readings(part, question, used, marched);
  Report report;
  report.data = question.json ? march_json(part, question, marched) : march_text(part, question, marched);
  report.exit_code = !marched.complete()      ? ExitCode::incomplete
                     : !marched.found.empty() ? ExitCode::fits
                                              : ExitCode::nothing_fits;
  return report;
}

}  // namespace rollfix::app
