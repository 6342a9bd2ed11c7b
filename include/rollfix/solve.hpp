#pragma once

// From a part and a roll on it to every place where the roll can have started: one finger on a part at rest, or two on
// a part that is free to move. Names are those of the JSON document.
//
//     const Part part = load_part("gallery:spline,n=9,seed=7,wobble=0.2");
//     Problem problem{part, Reading(0.9977, 0.99362)};  // length, turn in radians
//     problem.tolerance = 3e-4;                         // how far the turn may be off
//     const Answer answer = solve(problem);
//     answer.verdict.text();          // "ambiguous (6)"
//     answer.placements[0].start[0];  // 0.576029
//     const Log log = read_log("examples/roll.csv");
//     const Noise noise{.contact = 0.05, .angle = 0.006, .slip = 0.004};
//     const Answer noisy = solve({load_part("examples/wing.csv"), log, {disk(10)}, noise});
//     noisy.placements[0].probability > 0.5;  // true
//
// Degenerate cases: a roll that fits all the way round (a circle, a whole lap) is `unobservable`; one that nothing fits
// is `inconsistent`, and `diagnoses` says why; a continuum is one placement of kind `stretch`; L = 0 fits everywhere if
// the turn is 0; L may exceed the perimeter; an open outline has no place before its ends.
//
// Accuracy: without noise as of `locate`. With noise docs/calibration.md has how often the 95 % interval holds the true
// place, by length of log, kind of noise and outline.

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

/// What the fingers measured: readings, or a log.
struct Measurement {
  Measurement(Log of_roll) : log(std::move(of_roll)) {}                        // NOLINT: a log is a measurement
  Measurement(Reading reading) : readings{std::move(reading)} {}               // NOLINT
  Measurement(std::vector<Reading> of_roll) : readings(std::move(of_roll)) {}  // NOLINT
  Measurement(std::initializer_list<Reading> of_roll) : readings(of_roll) {}

  std::vector<Reading> readings;  // each measured from the first contacts; or
  std::optional<Log> log;
  std::vector<Rounding> roundings{};  // how far the digits of the readings, and of the facing, may be off; none: exact

  bool is_log() const { return log.has_value(); }
};

/// Readings as people write them, each "LENGTH,TURN" or "LENGTH_A,LENGTH_B,TURN", as in "0.9977,56.93deg" or
/// "8mm,0.31": they know their digits, so that the answer has every place that fits what was rounded. All numbers of a
/// reading count as rounded alike. `unit`: the part's, into which lengths with a unit are converted. Throws InputError:
/// a text that is not such a reading, or a unit that can't be converted.
Measurement typed(const std::vector<std::string>& readings, const std::string& unit = {});

/// A roll on a part, and how to look at it.
struct Problem {
  Part part;
  Measurement measured;
  std::vector<Finger> fingers{};  // none: not known; one serves both of two
  std::optional<Noise> noise{};   // none: exact but for rounded digits

  std::optional<double> tolerance{};    // radians; none: from the noise, or from the digits
  std::optional<std::size_t> budget{};  // of the search, see LocateOptions
  std::optional<double> facing{};       // of readings of two fingers, see LocateOptions; a log has it itself
  std::vector<double> at{};             // instants of a log, seconds; none: its last row, of two fingers the middle one
                                        // as well
  std::optional<Prior> prior{};         // with noise: about where finger a started
  std::optional<PosePrior> pose{};      // with noise: about how the part lay then
  bool mirrored = false;                // the part lies face down: the fingers measure the outline's mirror image
  bool either_way = false;   // lengths, of readings or of a log without u and psi, may count clockwise: both are tried
  bool robust = false;       // with noise: stray rows don't count, and rows that jump away are left out
  bool may_overlap = false;  // two fingers at different heights: disks that would overlap pass one another
  bool diagnose = true;      // where the rows fit badly it is found out what may be wrong, which takes a while
};

/// The search's tolerance and where it comes from.
struct Tolerance {
  enum class Source { smallest, digits, noise, given, least, part };
  double value = 0;  // radians
  Source source = Source::smallest;
};

/// Rows of a log in which a finger with corners may be on one of them: there u does not tell how its normal is turned.
/// They say where the contact is and leave open how the tangent points.
struct CornerRows {
  std::size_t count = 0;
  bool first = false;  // the first row is one
  bool last = false;   // the last row is one
};

/// How many placements were taken out, and why.
struct DroppedCounts {
  std::size_t reach = 0;       // a finger can't get there
  std::size_t overlap = 0;     // two fingers would overlap
  std::size_t improbable = 0;  // within the tolerance for the readings, but not for all samples together
};

/// What noise is made of and what it leaves; of an answer with noise.
struct Weighing {
  Noise noise;
  std::optional<Prior> prior{};
  std::optional<PosePrior> pose{};
  bool robust = false;
  std::size_t samples = 0;
  Fit fit;              // of the rows to the likeliest place
  Evidence evidence{};  // of all samples, with what the fingers can do
  double rest = 0;      // probability of what is not listed
  std::vector<Placement> improbable{};
  PerFinger<Density> density{};  // of the first contacts, see Belief::density; either way: of both, one over the other
};

/// Every place where the roll can have started, and what is known of each.
struct Answer {
  Part part;
  std::vector<Finger> fingers{};    // as in the problem
  std::vector<Reading> readings{};  // that were searched with
  std::vector<double> times{};      // of a log with times: of each reading, seconds
  std::optional<double> facing{};   // of two fingers, radians
  Tolerance tolerance{};
  Status status = Status::complete;
  Verdict verdict{};
  std::vector<Placement> placements{};  // ordered by start; with noise the most probable first
  std::vector<double> pose_time{};      // of a log with times: of each pose, seconds
  bool has_reach = false;               // what the fingers can't do was dropped
  DroppedCounts dropped{};
  std::vector<Impossible> impossible{};  // what the fingers can't do
  std::vector<PerFinger<Interval>> unresolved{};
  SearchCounts counts{};
  std::optional<Weighing> weighing{};  // with noise
  std::vector<Diagnosis> diagnoses{};  // where the rows fit badly: what explains them, the likeliest first; never empty
  std::vector<std::size_t> strays{};   // robust, of a log: lines that jump away and were left out
  bool mirrored = false;               // places are along the outline as stored; poses are of the part face down
  bool either_way = false;             // as in the problem: each placement says which; readings are as given
  std::string other_way{};             // of that: why the rows can't have gone one of the ways at all; empty: they can
  bool lengths_reversed = false;       // a log's lengths changed their signs, as the part is stored the other way round
  CornerRows corner_rows{};            // of a log

  std::size_t finger_count() const { return readings.front().fingers(); }
};

/// From a part and a roll on it to every place where the roll can have started: the readings that are meant and the
/// tolerance that their digits or their noise ask for, the search, with noise the weighing of all rows, what the
/// fingers can't do, and where the part is in the world. One finger on a part at rest, or two on a part that is free to
/// move. Throws InputError: what `locate`, `readings`, `facing` and Belief throw, and a fact that does not go with the
/// others, by the name of the Problem's field.
Answer solve(const Problem& problem);

/// Whether it is known where such a finger can touch a part without entering it elsewhere: of disks and jaws.
bool has_reach(const Finger& finger);

/// How far it can reach. REQUIRES has_reach(finger). Throws InputError as reach_of_disk does.
Reach reach_of(const Part& part, const Finger& finger);

/// How to work on many problems.
struct ManyOptions {
  unsigned threads = 0;  // 0: as many as the machine has processors
  /// Called now and then by the thread that waits, with the number of problems that are done: false stops the work.
  std::function<bool(std::size_t done)> go_on{};
};

/// Many answers as columns, for when there are too many to keep each: placement number p of problem k is row
/// offsets[k] + p. What is of a finger has `fingers` entries in a row, [row * fingers + finger].
struct AnswerTable {
  std::size_t fingers = 1;
  std::vector<std::int64_t> offsets{0};  // of the problems, and behind the last the number of rows

  // Of each problem:
  std::vector<std::uint8_t> status;                         // as Status
  std::vector<std::uint8_t> verdict;                        // as Verdict::Name
  std::vector<double> tolerance;                            // radians; NaN where there is an error
  std::vector<std::pair<std::size_t, std::string>> errors;  // problem and message, in order

  // Of each placement:
  std::vector<std::uint8_t> kind;        // as Kind
  std::vector<double> start;             //
  std::vector<double> end;               //
  std::vector<double> extent;            // lo, hi of each finger
  std::vector<double> point;             // x, y of each finger
  std::vector<double> tangent;           //
  std::vector<double> error;             // one a row
  std::vector<double> residual;          // one a row
  std::vector<double> probability;       // one a row; NaN without noise
  std::vector<std::uint8_t> whole_loop;  // of finger a or of both

  std::size_t problems() const { return offsets.size() - 1; }
};

/// Turns the problem that it is given, which is `like` or an earlier one, into number k. It is called from several
/// threads, of each with a problem of its own. What it throws as InputError is that problem's error.
using ProblemMaker = std::function<void(std::size_t k, Problem& problem)>;

/// The answers to problems 0 to count - 1, all of as many fingers as `fingers`; the same bits with any number of
/// threads. Throws what `solve` throws but InputError, and InputError where go_on stopped it.
AnswerTable solve_table(const Problem& like, std::size_t count, const ProblemMaker& make, std::size_t fingers,
                        const ManyOptions& options = {});

}  // namespace rollfix
