#pragma once

// Row by row: where the contacts are by now, while one finger or two roll on: docs/watch.md.
//
//     const Part part = load_part("examples/wing.csv");
//     Tracker tracker(part, {disk(10)}, {.contact = 0.05, .angle = 0.006, .slip = 0.004});
//     std::size_t told = 0;
//     for (int row = 0; row < 20; ++row) told += tracker.push(0.04 * row, -0.04 * row, -1.4 + 0.043 * row).size();
//     told > 0;  // true

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/belief.hpp"
#include "rollfix/finger.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/locate.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/reading.hpp"

namespace rollfix {

class Catalog;
struct Identified;

/// Why a roll is over.
enum class RollEnd {
  lost,       // contact
  jump,       // the next row is farther away than is physical: another roll
  restarted,  // another log began
  ended,      // there is no more of the log
  elsewhere   // it contradicts what was measured before: the finger was carried to another place
};

/// What is known of a roll after one of its samples.
struct Tracked {
  std::size_t roll = 0;     // from 1; 0: there was none yet
  std::size_t samples = 0;  // of this roll so far
  Sample sample;            // the last of them, after which the rest holds
  Verdict verdict;          // `verdict.text()` in words; `held->verdict_text()` beside a wheel
  std::vector<Mode> modes;  // the most probable first: `start` of the roll, `end_mean` and `end_sd` of the contact now
  double rest = 0;          // probability outside of them
  Fit fit;                  // how well the samples fit, and what they tell of the scales and of a bias
  std::optional<RollEnd> over{};     // the roll is over, and this is the last that is known of it
  std::size_t impossible = 0;        // then: places that fit, and that the fingers can't have
  std::vector<Diagnosis> diagnoses;  // then, where its rows fit badly: why, see Answer
  /// Beside a wheel without skin: what `solve` says, of which the modes have the places of both.
  std::shared_ptr<const HoldAnswer> held{};
  /// Of a catalog, see rollfix/identify.hpp: the parts that remain. The places are theirs; there are no modes.
  std::shared_ptr<const Identified> parts{};
};

/// Whether somebody who knows the one answer wants to hear the other: another verdict, or the most probable place is
/// not one that was known, or it is twice as certain, or its probability is another by a tenth. That two places which
/// are about as probable change ranks is no news.
bool is_news(const Tracked& said, const Tracked& now, const Part& part);

/// Somebody who watches a screen, and a robot's next decision, can wait this long.
inline constexpr std::chrono::milliseconds kMostDelay{100};

/// How a roll is followed. What is known before holds of every roll's first contacts.
struct TrackOptions {
  std::string name = "the log";         // for messages
  std::optional<std::string> name_b{};  // of two logs, one of each finger, that of finger b; beside a wheel its pin's
  std::optional<Prior> prior{};         // about where finger a starts
  std::optional<PosePrior> pose{};      // about how the part lies
  bool robust = false;                  // stray rows don't count
  bool may_overlap = false;             // see Problem
  LogOptions log{};                     // how rows are read; its `mirrored` is left to `mirrored` below
  bool again = false;                   // a roll that is contradicted is over, and another begins, anywhere
  std::size_t every = 0;                // tell after every so many samples; 0: when there is news
  bool live = false;                    // somebody waits: nothing new is kept back for longer than kMostDelay
  std::optional<double> wheel{};        // finger b is a wheel without skin: its radius
  std::optional<double> squeezed{};     // beside a wheel, see HoldProblem
  bool mirrored = false;                // the part lies face down
  /// Whether news can be told without making the log wait. What is told later is what is known by then. None: always.
  std::function<bool()> is_ready{};
};

/// Where the contacts are, row by row, while one finger or two roll on a part, or a jaw beside a wheel without skin:
/// the posterior of `locate`, in memory that does not grow with the roll (docs/watch.md, docs/belief.md). Rows come as
/// numbers, as lines of a log, or as what a stream made of them: use one of the three.
///
/// `push` returns what is worth telling of the row, in order: nothing mostly; the first contact of a roll, of one
/// sample; news (see is_news); the end of a roll (`over`), which of a row that jumps away comes before the first
/// contact of the next one. The answer at the end of a roll is that of `solve` for the same rows, to the last bit, up
/// to 4,096 rows; of a longer roll it is the posterior of all rows, and places out of reach are not left out of it.
///
/// Taking a row is cheap, working out what it means is not: docs/watch.md has the figures. So that is done after
/// every sample at first, and then each time a roll has grown by a quarter; where it is `live` as often as kMostDelay
/// asks for as well, for at most half of the time. Without `live` the same rows give the same answers every time.
///
/// Degenerate cases. A roll too short to tell anything is `unobservable`: any place fits. On a circle it stays so. Rows
/// on a corner of a finger count when the roll is over; until then they are left out. A row that can't be read, or is
/// farther away than is physical, ends no program: messages() says what became of it.
class Tracker {
 public:
  /// Lengths in the part's unit, angles in radians, times in seconds. `fingers`: one that serves both of two, or each;
  /// beside a wheel the one with skin; none where the log is of length and turn, or of distance and dturn. Throws
  /// InputError: noise, prior, pose or fingers that are not valid; what is not taken beside a wheel, or `mirrored`: an
  /// open outline of a finger, a jaw with a pose or noise `position`.
  Tracker(const Part& part, std::vector<Finger> fingers, const Noise& noise, TrackOptions options = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// The next row of one finger, of two, or of an instant in which not every finger touches, as LogStream takes them.
  /// Throws InputError: no finger is known, or what the noise or the pose is about is not in the first row, such as a
  /// finger's centre; `name_b` or a wheel, whose rows are lines.
  std::vector<Tracked> push(std::optional<double> time, double u, double psi, std::optional<double> x = {},
                            std::optional<double> y = {});
  std::vector<Tracked> push(std::optional<double> time, const PerFinger<Touch>& fingers);
  std::vector<Tracked> push_off(std::optional<double> time);

  /// The next line of a log, its header included, of two logs of the first or of the second, 0 or 1. Throws InputError:
  /// what LogStream::push and PairedStream::push throw, and as above.
  std::vector<Tracked> push(std::string_view line, std::size_t which = 0);
  /// What a stream made of a line, which knows what `kind` of log it is. Throws InputError: as above.
  std::vector<Tracked> push(const LogLine& row, LogKind kind);

  /// Why rows of the last push were left out, or began another roll.
  const std::vector<std::string>& messages() const;

  /// After a dropped connection: the next row continues the roll, see LogStream and PairedStream.
  void resume(std::size_t which = 0);
  /// Of two logs: no more lines of this one before more of the other one have come.
  bool is_ahead(std::size_t which) const;
  /// The roll is over, if there is one; the next row begins another.
  std::vector<Tracked> finish(RollEnd why = RollEnd::ended);

  /// What is known of all samples so far, worked out now if it was not yet.
  const Tracked& now();
  /// The same when it was last worked out.
  const Tracked& last() const;

  /// Whether there is news that `is_ready` kept back, or, live, samples that nothing was made of yet: then catch_up()
  /// is due when no row has come for kMostDelay.
  bool is_behind() const;
  std::vector<Tracked> catch_up();

 private:
  struct State;
  friend Tracker track(const std::shared_ptr<const Catalog>&, std::vector<Finger>, const Noise&, TrackOptions);
  explicit Tracker(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace rollfix
