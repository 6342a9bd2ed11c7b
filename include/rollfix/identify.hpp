#pragma once

// Many parts in one SQLite file, and which of them a roll or touches fit: docs/identify.md has the tables.
//
//     const std::string path = (std::filesystem::temp_directory_path() / "two-parts.rollfix").string();
//     build_catalog(path, {{"gallery:ellipse,a=2,b=1", "ellipse"}, {"gallery:circle,r=1", "circle"}});
//     const Catalog catalog(path);
//     Problem asked{any_part_of(catalog), Reading(1.0, 0.5)};
//     asked.tolerance = 1e-6;
//     identify(catalog, asked).verdict;  // "unique part, 4 places"
//
// Degenerate cases: parts that no roll can tell apart are listed as congruent; while more than `most_searched` remain
// they are only counted.
//
// Accuracy: of each part the answer is that of `solve` of this part alone, to the bit; bounds only leave out parts on
// which nothing fits.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/advise.hpp"
#include "rollfix/files.hpp"
#include "rollfix/part.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"
#include "rollfix/tracker.hpp"

namespace rollfix {

/// A part of a catalog, as its lists show it.
struct CatalogEntry {
  std::int64_t id = 0;   // stays the same for as long as the part is there
  std::string name;      // no two have the same
  double perimeter = 0;  // in the catalog's unit
  int symmetry = 1;      // see symmetry(const Part&)
  bool closed = true;
  bool reversed = false;  // given clockwise
  double count = 1;       // so many of it are among what may be touched: what makes it likelier than another
};

/// What is not in a catalog, and why.
struct LeftOut {
  std::string source;  // the file, or gallery:...
  std::string why;
};

/// A catalog that is read. Parts are loaded when they are asked for. Any number of threads may share one.
class Catalog {
 public:
  /// Throws InputError: no such file, not a catalog, or of a version that this program does not know.
  explicit Catalog(const std::string& path);
  ~Catalog();
  Catalog(Catalog&&) noexcept;
  Catalog& operator=(Catalog&&) noexcept;

  const std::string& path() const;
  /// Of all lengths; empty: not known.
  const std::string& unit() const;
  std::size_t size() const;
  /// In the order of their ids, which is that in which they were added.
  const CatalogEntry& entry(std::size_t index) const;
  /// Where the name was read from.
  std::string source_of(std::size_t index) const;
  std::vector<LeftOut> left_out() const;

  /// The part, as if it had been loaded from its source; its name is the entry's. It is kept, so that the next one who
  /// asks has it at once. Throws InputError: the file was damaged.
  Part part(std::size_t index) const;

  struct Index;  // what identify() looks at first
  const Index& index() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What a log is read with while it is not known which part it is of: one of them, in the catalog's unit. Throws
/// InputError: there is none.
Part any_part_of(const Catalog& catalog);

/// What a catalog is built of: a file, "gallery:..." or a part that is there, and how many parts of it there are.
struct CatalogSource {
  std::string argument;  // as load_part takes it
  std::string name;      // of its part; of a drawing with several loops "name#1", "name#2", ... by falling area
  double count = 1;
  std::optional<Part> part{};  // what `argument` is called after; none: it is to be loaded
};

/// All that load_part takes in a folder and the folders in it, by name; or what a list names: a text file with a file
/// or gallery:... in each line, relative to the list, and behind a tabulator the count. Empty lines and lines that
/// begin with # are passed over. Any other file, and gallery:..., is a source itself. Throws InputError: nothing of the
/// name, a folder without any, a count that is not above 0.
std::vector<CatalogSource> catalog_sources(const std::string& argument);

/// How far a build is. Only what is safe in the file counts.
struct BuildProgress {
  std::size_t sources = 0;  // of them
  std::size_t done = 0;
  std::size_t parts = 0;  // in the catalog
};

struct BuildOptions {
  LoadOptions load{};  // how files are taken; `loop` is not asked: every closed loop of a drawing is a part
  unsigned jobs = 0;   // threads; 0: as many as the machine has processors
  /// Called now and then by the thread that waits: false stops the build; what was done stays.
  std::function<bool(const BuildProgress&)> go_on{};
};

struct BuildReport {
  std::size_t added = 0;      // parts
  std::size_t unchanged = 0;  // sources that were there already, as they are now
  std::size_t replaced = 0;   // sources that have changed since
  std::vector<LeftOut> left_out;
  std::vector<std::string> notes;
  bool stopped = false;  // by go_on
};

/// Adds parts to a catalog, which it makes where there is none. What was there is not read again unless its file has
/// changed, so that a build that was interrupted goes on where it was. Several parts are written in one transaction;
/// whatever happens, those that progress has told of are in the file. A source that can't be taken is left out, which
/// the catalog remembers. All parts are in one unit: that of `load.points.unit`, else of the first part that has one;
/// other units are converted.
/// Throws InputError: a file that is not a catalog or can't be written, one of another unit.
BuildReport build_catalog(const std::string& path, const std::vector<CatalogSource>& sources,
                          const BuildOptions& options = {});

/// Takes parts out, by name; so many were there. Throws InputError: a name that is not in the catalog, by which nothing
/// is taken out; and as build_catalog does.
std::size_t remove_from_catalog(const std::string& path, const std::vector<std::string>& names);

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
    Hypothesis hypothesis;  // `probability`: of this part and this place; `label`: of all parts' places its own
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

/// {"schema": "rollfix/advise/1", ...}, as of one part, with each hypothesis's part.
std::string format_next_roll(const Catalog& catalog, const Identified& found, const NextRollOfParts& next,
                             Layout layout = Layout::lines);

/// Which part of a catalog is it, row by row: what a Tracker tells has `parts`, as `identify` finds them, and no modes.
/// While more than 500 remain they are only counted. When a roll is over, the answer is that of `identify` for the same
/// rows. `fingers`, `noise` and `options` as of a Tracker, lengths in the catalog's unit, without what is said of the
/// start: a part has its own `s`. Throws InputError: an empty catalog, fingers with corners, and as Tracker does.
Tracker track(const std::shared_ptr<const Catalog>& catalog, std::vector<Finger> fingers, const Noise& noise,
              TrackOptions options = {});

}  // namespace rollfix
