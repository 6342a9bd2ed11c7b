#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/answer/answer.hpp"
#include "rollfix/belief/advise.hpp"
#include "rollfix/catalog/catalog.hpp"
#include "rollfix/files/documents.hpp"
#include "rollfix/touch/touch.hpp"

namespace rollfix {

/// What counts when parts are weighed against each other.
struct PartWeight {
  std::size_t part = 0;  // its place in the catalog
  std::string verdict;   // of locate
  bool fits = false;     // there is a placement, and the rows don't contradict it
  bool fits_badly = false;
  bool undecided = false;        // its search is incomplete
  std::size_t places = 0;        // that remain
  std::vector<double> starts{};  // of them, finger a's
  // With noise, of the whole roll:
  double peak = -std::numeric_limits<double>::infinity();  // as Evidence has it, ...
  double volume = 0;  // ... of first contacts that are anywhere on the boundary alike
  double widened = 1;
  double excess = 1;
  bool widely = false;  // it was looked at only with 2.5 times the noise, because nothing fitted well with less
};

/// Which of the parts, and how to work.
struct IdentifyOptions {
  bool use_index = true;             // false: every part is searched
  std::vector<std::size_t> among{};  // only these parts, by their places in the catalog, in order; none: all of it
  /// Where bounds leave more parts than this they are counted, and not searched: to see early how many remain.
  std::size_t most_searched = std::numeric_limits<std::size_t>::max();
  unsigned threads = 0;  // 0: as many as the machine has processors
  /// Called now and then by the thread that waits, with the number of parts that are done: false stops the work.
  std::function<bool(std::size_t done)> go_on{};
};

/// A part that the roll may have been on.
struct PartFound {
  PartWeight weight;
  Answer answer;  // as of this part alone: probabilities of places are given that it is this part
  double probability = std::numeric_limits<double>::quiet_NaN();  // that it is; NaN: no noise
  std::vector<std::size_t> congruent{};                           // parts that can't be told from it, by their places
};

/// A part that says it can't have been rolled on like this at all, and why: what `solve` throws.
struct PartRefused {
  std::size_t part = 0;
  std::string why;
};

/// Every part of a catalog that a roll fits.
struct Identified {
  std::vector<PartFound> parts;  // the likeliest first, without noise in the catalog's order
  std::string verdict;           // "unique part, 2 places", "3 parts", "none", ...
  Status status = Status::complete;
  double rest = 0;                    // with noise: probability of all that is not listed
  std::size_t asked = 0;              // parts
  std::size_t searched = 0;           // of them, that bounds did not rule out, ...
  std::size_t searched_widely = 0;    // ... and so many more with 2.5 times the noise
  std::vector<std::size_t> left{};    // parts that remain, as far as it was looked at: no other can be it
  bool counted = false;               // there are more than most_searched of them: nothing else is known
  std::vector<PartWeight> weights{};  // of all parts that something fits on, in the catalog's order
  std::vector<PartRefused> refused{};
  std::optional<Noise> noise{};  // as in the problem
  bool mirrored = false;
  std::size_t samples = 0;  // rows of the log, or readings
};

/// Every part of a catalog on which a roll can have been, and every place on it: what `solve` says of each part by
/// itself, to the bit, but that bounds rule out most parts at once, which loses none. `like`: the problem; its part
/// does not matter, and lengths are in the catalog's unit. Without noise all rows of a log have to fit, as far as their
/// digits tell. With noise parts are weighed by their evidence, times their count; ruled out is what would need errors
/// that occur once in a million rolls; where nothing fits well, with 2.5 times the noise. See docs/identify.md.
/// Throws InputError: a prior place, which is of one part; what `solve` throws where it throws it of all parts.
Identified identify(const Catalog& catalog, const Problem& like, const IdentifyOptions& options = {});

/// A part that the touches and rolls may have been on.
struct PartTouched {
  std::size_t part = 0;  // its place in the catalog
  TouchAnswer answer;    // as of this part alone: probabilities of poses are given that it is this part
  double probability = std::numeric_limits<double>::quiet_NaN();  // that it is; NaN: no noise
  std::vector<std::size_t> congruent{};                           // parts that can't be told from it, by their places
};

/// A roll on whichever part it is.
struct RollGiven {
  std::string name{};                // of its log
  std::vector<std::size_t> lines{};  // of the file: its first and its last row; of simulated rows none
  std::size_t rows = 0;
};

/// Every part of a catalog that touches and rolls fit.
struct IdentifiedByTouches {
  std::vector<PartTouched> parts{};  // the likeliest first, without noise in the catalog's order
  std::string verdict{};             // "unique part, unique pose", "3 parts", "none", ...
  Status status = Status::complete;
  double rest = 0;                       // with noise: probability of all that is not listed; NaN where undecided
  std::size_t asked = 0;                 // parts
  std::size_t searched = 0;              // of them, that bounds did not rule out
  std::vector<std::size_t> left{};       // parts that remain, as far as it was looked at: no other can be it
  bool counted = false;                  // there are more than most_searched of them: nothing else is known
  std::vector<std::size_t> undecided{};  // of them, whose search ran out of its budget
  std::vector<PartRefused> refused{};

  // As in the problem.
  std::vector<RollGiven> rolls{};
  std::vector<MeasuredTouch> touches{};
  std::vector<TouchTolerance> tolerance{};  // that was searched with, for each of the touches
  std::vector<Clear> clear{};
  double radius = 0;  // of the finger; 0: a point
  std::optional<Noise> noise{};
  bool mirrored = false;
};

/// Every part of a catalog that the touches and rolls can have been on, and every pose of it: what `solve` says of each
/// part by itself, to the bit, but that bounds rule out most parts at once, which loses none. `asked`: the problem; its
/// part does not matter, and lengths are in the catalog's unit. With noise parts are weighed by the likelihood of all
/// touches and rows, averaged over the poses and over contacts that are anywhere on the boundary alike, times their
/// count. One touch fits every part. See docs/identify.md.
/// Throws InputError: one roll and no touch (which is a Problem), and what `solve` throws where it throws it of all
/// parts.
IdentifiedByTouches identify(const Catalog& catalog, const TouchProblem& asked, const IdentifyOptions& options = {});

/// Which roll tells apart the parts, and the places on them, that remain.
struct NextRollOfParts {
  struct Place {
    std::size_t part = 0;   // its place in Identified::parts
    Contender contender;    // `probability`: of this part and this place; `label`: of all parts' places its own
    double turn_ahead = 0;  // along the advised roll if this is the place, radians; 0: none is advised
  };
  std::vector<Place> places;
  std::optional<Advice> advice{};  // none where there is nothing to tell apart
  std::string why{};               // where there is none, or no roll helps: why, in words; else empty

  bool helps() const { return advice && advice->helps; }
};

/// As next_roll(const Answer&) does of one part's places, of all parts that were found. Without noise all places of all
/// parts are as probable. Throws InputError: rolls that may have gone either way, and as `advise` does.
NextRollOfParts next_roll(const Identified& found, const std::optional<Interval>& travel = {});

}  // namespace rollfix

// The JSON documents of catalogs, as text: docs/json.md lists their fields.
namespace rollfix {

/// "rollfix/identify/1".
std::string format_identified(const Catalog& catalog, const Identified& found, Layout layout = Layout::lines);

/// "rollfix/identify/1" of touches.
std::string format_identified(const Catalog& catalog, const IdentifiedByTouches& found, Layout layout = Layout::lines);

/// {"schema": "rollfix/advise/1", ...}, as of one part, with each contender's part.
std::string format_next_roll(const Catalog& catalog, const Identified& found, const NextRollOfParts& next,
                             Layout layout = Layout::lines);

}  // namespace rollfix
