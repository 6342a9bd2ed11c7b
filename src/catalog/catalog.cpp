#include "rollfix/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "catalog/bounds/bounds.hpp"
#include "database.hpp"
#include "files/part_record.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

// Finds the sources of a catalog, and reads one back.
//   entries, index  of all parts, read at once and checked: what bounds and lists need
//   part            made from its stored outline when it is asked for, then kept
//   sums            checksum of each part's row; what `shapes` has of the part holds only beside it
// Follows docs/identify.md, "The catalog". One mutex for the file and for what is kept: threads may share a catalog.
// Parts are made outside of it.
namespace rollfix {
namespace {

using catalog::CellPlaces;
using catalog::Database;
using catalog::kCells;
using catalog::kFineCells;
using catalog::PartRow;
using catalog::places_of;
using catalog::Profile;
using catalog::profile_from;
using catalog::Statement;
using catalog::sum_of;
using catalog::sum_of_fine;
using catalog::sum_of_unit;
using catalog::Transaction;

namespace fs = std::filesystem;

// Files of a folder that are tried; others are passed over.
constexpr std::array<std::string_view, 6> kEndings = {".csv", ".dat", ".txt", ".dxf", ".svg", ".json"};

/// By the file's ending alone: files are not opened to find out.
bool has_known_ending(const fs::path& file) {
  const std::string ending = ending_of(file.string());
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

/// "gallery:cam" and the like are made, not read.
bool is_gallery(const std::string& argument) { return argument.rfind("gallery:", 0) == 0; }

/// All outlines in a folder and its subfolders, named by their path in it, in the order of these names, so that a build
/// does not depend on the file system. Throws InputError: it can't be read, or there are none.
std::vector<CatalogSource> sources_in(const std::string& folder) {
  std::vector<CatalogSource> sources;
  std::error_code error;
  for (fs::recursive_directory_iterator file(folder, fs::directory_options::follow_directory_symlink, error), end;
       file != end; file.increment(error)) {
    // Folders are gone into by the iterator; all other files are no outlines.
    if (!file->is_regular_file() || !has_known_ending(file->path())) continue;
    sources.push_back({file->path().string(), file->path().lexically_relative(folder).string()});
  }
  // The iterator stops at an error, too: it is looked at behind the loop.
  if (error) throw InputError(fmt::format("{}: can't be read: {}", folder, error.message()));
  if (sources.empty()) {
    throw InputError(
        fmt::format("{}: expected outlines in this folder ({}), found none", folder, fmt::join(kEndings, ", ")));
  }
  std::sort(sources.begin(), sources.end(),
            [](const CatalogSource& a, const CatalogSource& b) { return a.name < b.name; });
  return sources;
}

/// A list names files and gallery shapes; an outline has numbers.
bool is_list(const std::string& path, std::string_view text) {
  const std::string ending = ending_of(path);
  if (ending == ".dxf" || ending == ".svg" || ending == ".json" || ending == ".dat") return false;
  for (const std::string_view line : split(text, '\n')) {
    if (line.empty() || line.front() == '#') continue;
    // The first line that is no comment decides.
    const std::string first(split(line, '\t')[0]);
    return is_gallery(first) || fs::exists(fs::path(path).parent_path() / first);
  }
  return false;
}

/// The sources that a list names, in its order; files relative to the list. Throws InputError: a count that is not a
/// number above 0.
std::vector<CatalogSource> sources_listed(const std::string& path, std::string_view text) {
  std::vector<CatalogSource> sources;
  std::size_t number = 0;
  for (const std::string_view line : split(text, '\n')) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = split(line, '\t');
    CatalogSource source;
    source.name = fields[0];
    // A file as it has to be opened from here; its name stays as it stands in the list.
    source.argument = is_gallery(source.name) ? source.name : (fs::path(path).parent_path() / source.name).string();
    if (fields.size() > 1) {
      // Behind a tabulator: how many of this part there are.
      const std::optional<double> count = parse_number(fields[1]);
      if (!count || !(*count > 0)) {
        throw InputError(fmt::format("{}:{}: count '{}': expected a number above 0", path, number, fields[1]));
      }
      source.count = *count;
    }
    sources.push_back(std::move(source));
  }
  return sources;
}

}  // namespace

std::vector<CatalogSource> catalog_sources(const std::string& argument) {
  // In this order: a gallery shape, a folder, a list, else one outline.
  if (is_gallery(argument)) return {{argument, argument}};
  if (fs::is_directory(argument)) return sources_in(argument);
  const std::string text = read_text(argument);
  if (is_list(argument, without_mark(text))) return sources_listed(argument, without_mark(text));
  return {{argument, fs::path(argument).filename().string()}};
}

namespace {

// Parts that are kept once they were loaded: some 100 kB each.
constexpr std::size_t kMostKept = 4096;
// Fine cells are kept once they were read where there are no more parts than these: 2 kB each.
constexpr std::size_t kMostFineKept = 16384;
// Middles of cells are kept of so many parts: 2.7 kB each.
constexpr std::size_t kMostPlacesKept = 65536;

// Beside a reader another program may change the file: what is found then.
constexpr const char* kTakenOut = "was taken out of the catalog meanwhile";
constexpr const char* kDamaged = "was damaged since it was written: its checksum does not fit; build the catalog again";

constexpr const char* kPartRows =
    "SELECT id, name, source, perimeter, period_turn, most_curvature, closed, reversed, measured, symmetry, count, "
    "profile, checksum FROM parts ORDER BY id";
constexpr int kPartSum = 12;  // the column of the checksum

/// A row of kPartRows; its texts are good until the next step.
PartRow part_row(const Statement& rows) {
  PartRow row;
  row.id = rows.whole(0);
  row.name = rows.bytes(1);
  row.source = rows.whole(2);
  row.perimeter = rows.number(3);
  row.period_turn = rows.number(4);
  row.most_curvature = rows.number(5);
  row.closed = rows.whole(6) != 0;
  row.reversed = rows.whole(7) != 0;
  row.measured = rows.whole(8) != 0;
  row.symmetry = rows.whole(9);
  row.count = rows.number(10);
  row.profile = rows.bytes(11);
  return row;
}

/// Reads the fine cells of one part after the other.
class FineReader {
 public:
  explicit FineReader(const Database& database)
      : open_(database.prepare("SELECT 1 FROM facts")),
        row_(database.prepare("SELECT fine, fine_checksum FROM shapes WHERE part = ?")) {
    // While a statement stands on a row the file is open for reading: else it would be opened for each part anew.
    open_.step();
  }

  /// False: there is no such part.
  bool find(std::int64_t part) {
    row_.reset();
    row_.bind(0, part);
    return row_.step();
  }
  /// Of the part that was found, until the next one is.
  std::string_view bytes() const { return row_.bytes(0); }
  /// Whether the bytes are what was written, for this part.
  bool fits(std::uint64_t part_sum) const {
    return static_cast<std::int64_t>(sum_of_fine(bytes(), part_sum)) == row_.whole(1);
  }

 private:
  Statement open_;  // keeps the file open
  Statement row_;   // the part that was found
};

/// The bytes of a part as they stand in the catalog.
struct Stored {
  std::string outline;
  std::string numbers;
};

}  // namespace

/// The file, what was read of it at once, and what is kept of single parts.
struct Catalog::State {
  explicit State(const std::string& file) : database(file, Database::Access::read), path(file) {
    // All of one state of the file, whatever others write meanwhile.
    Transaction all(database, Database::Access::read);
    require_catalog(database);
    unit = fact(database, "unit");
    read_entries();
    all.commit();
    // What the index has not in memory it asks for when it is needed.
    index.fine = [this](const std::vector<std::size_t>& parts) { return fine_profiles(parts); };
    index.places = [this](std::size_t which) { return places(which); };
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Each throws InputError, naming the part, where the file was damaged or changed.
  void read_entries();
  Stored stored(std::size_t which);
  std::vector<Profile<kFineCells>> fine_profiles(const std::vector<std::size_t>& parts);
  CellPlaces places(std::size_t which);
  Part part(std::size_t which);
  [[noreturn]] void refuse(std::size_t which, const char* what) const;

  Database database;
  std::string path;
  std::string unit;                   // of all lengths; empty: not known
  std::vector<CatalogEntry> entries;  // by id
  std::vector<std::uint64_t> sums;    // the checksum of each
  Index index;
  std::mutex mutex;                            // of the file, and of what is kept
  std::unordered_map<std::size_t, Part> kept;  // these three by the part's place in the catalog
  std::unordered_map<std::size_t, Profile<kFineCells>> fine_kept;
  std::unordered_map<std::size_t, CellPlaces> places_kept;
};

/// All rows of `parts`, checked one by one and as a whole. O(parts), 660 bytes each, and its name.
void Catalog::State::read_entries() {
  const auto count = static_cast<std::size_t>([&] {
    Statement asked = database.prepare("SELECT count(*) FROM parts");
    asked.step();
    return asked.whole(0);
  }());
  entries.reserve(count);
  sums.reserve(count);
  index.courses.reserve(count);
  index.coarse.reserve(count);
  index.cells.reserve(count);
  index.measured.reserve(count);
  std::uint64_t whole = sum_of_unit(unit);
  Statement rows = database.prepare(kPartRows);
  while (rows.step()) {
    const PartRow row = part_row(rows);
    // A row by its own checksum, its cells by theirs, and all rows by the sum of sums: so no row can be missing either.
    const std::uint64_t sum = sum_of(row);
    // What is kept in memory of a part: its bounds on 64 cells, and on 16, which follow from these.
    const std::optional<Profile<kCells>> profile = profile_from(row.profile);
    if (!profile || static_cast<std::int64_t>(sum) != rows.whole(kPartSum)) {
      throw InputError(fmt::format("{}: {}: {}", path, row.name, kDamaged));
    }
    // Modulo 2^64, in any order.
    whole += sum;
    sums.push_back(sum);
    index.courses.push_back({static_cast<float>(row.perimeter), static_cast<float>(row.period_turn),
                             static_cast<float>(row.most_curvature), row.closed});
    index.coarse.push_back(coarser(*profile));
    index.cells.push_back(*profile);
    index.measured.push_back(static_cast<std::uint8_t>(row.measured));
    entries.push_back({row.id, std::string(row.name), row.perimeter, static_cast<int>(row.symmetry), row.closed,
                       row.reversed, row.count});
  }
  if (whole != whole_sum(database)) throw InputError(fmt::format("{}: {}", path, kDamaged));
}

/// The outline's bytes, checked. Copied, so that the lock ends here.
Stored Catalog::State::stored(std::size_t which) {
  const std::lock_guard lock(mutex);
  Statement row = database.prepare("SELECT outline, numbers, checksum FROM shapes WHERE part = ?");
  // By its id, which no other part has: the entry may be older than what others have written since.
  row.bind(0, entries[which].id);
  if (!row.step()) refuse(which, kTakenOut);
  Stored stored{std::string(row.bytes(0)), std::string(row.bytes(1))};
  const std::uint64_t sum = sum_of({stored.outline, stored.numbers}, sums[which]);
  if (static_cast<std::int64_t>(sum) != row.whole(2)) refuse(which, kDamaged);
  return stored;
}

/// Theta on the 256 cells of each of these parts, kept or read from the file.
std::vector<Profile<kFineCells>> Catalog::State::fine_profiles(const std::vector<std::size_t>& parts) {
  std::vector<Profile<kFineCells>> profiles;
  profiles.reserve(parts.size());
  const std::lock_guard lock(mutex);
  // Of large catalogs fine cells are read each time: memory is bounded.
  const bool is_small = entries.size() <= kMostFineKept;
  std::optional<FineReader> reader;
  for (const std::size_t which : parts) {
    const auto found = fine_kept.find(which);
    // Read before.
    if (found != fine_kept.end()) {
      profiles.push_back(found->second);
      continue;
    }
    // One reader for all parts of the call.
    if (!reader) reader.emplace(database);
    if (!reader->find(entries[which].id)) refuse(which, kTakenOut);
    if (!reader->fits(sums[which])) refuse(which, kDamaged);
    // The bytes count from the bounds of the cells of 64, which are in memory.
    const std::optional<Profile<kFineCells>> profile = fine_profile_from(reader->bytes(), index.cells[which]);
    if (!profile) refuse(which, kDamaged);
    profiles.push_back(*profile);
    if (is_small) fine_kept.emplace(which, *profile);
  }
  return profiles;
}

/// Middles of the cells of a part, computed when they are first asked for. Two threads may both compute them, to the
/// same bits.
CellPlaces Catalog::State::places(std::size_t which) {
  {
    const std::lock_guard lock(mutex);
    const auto found = places_kept.find(which);
    if (found != places_kept.end()) return found->second;
  }
  // Without the lock: this takes long.
  const CellPlaces places = places_of(part(which));
  const std::lock_guard lock(mutex);
  if (places_kept.size() < kMostPlacesKept) places_kept.emplace(which, places);
  return places;
}

/// A part that is kept, or one made of its bytes. Two threads may make the same part, which does no harm.
Part Catalog::State::part(std::size_t which) {
  {
    const std::lock_guard lock(mutex);
    const auto found = kept.find(which);
    if (found != kept.end()) return found->second;
  }
  const Stored bytes = stored(which);
  const std::string& name = entries[which].name;
  try {
    Part part = part_of(bytes.outline, bytes.numbers, name);
    const std::lock_guard lock(mutex);
    // All at once: what is asked for again is soon back.
    if (kept.size() >= kMostKept) kept.clear();
    kept.emplace(which, part);
    return part;
  } catch (const InputError&) {
    // Says itself what is wrong.
    throw;
  } catch (const std::exception&) {  // of a library, in its own words
    throw InputError(fmt::format("{}: {}: is damaged: build the catalog again", path, name));
  }
}

/// Throws InputError: what is wrong with this part of the file.
void Catalog::State::refuse(std::size_t which, const char* what) const {
  throw InputError(fmt::format("{}: {}: {}", path, entries[which].name, what));
}

Catalog::Catalog(const std::string& path) : state_(std::make_unique<State>(path)) {}
Catalog::~Catalog() = default;
Catalog::Catalog(Catalog&&) noexcept = default;
Catalog& Catalog::operator=(Catalog&&) noexcept = default;

const std::string& Catalog::path() const { return state_->path; }
const std::string& Catalog::unit() const { return state_->unit; }
std::size_t Catalog::size() const { return state_->entries.size(); }
const CatalogEntry& Catalog::entry(std::size_t index) const { return state_->entries[index]; }
const Catalog::Index& Catalog::index() const { return state_->index; }

/// The first part: it only stands for the others.
Part any_part_of(const Catalog& catalog) {
  if (catalog.size() == 0) throw InputError(fmt::format("{}: the catalog has no parts", catalog.path()));
  return with_unit(catalog.part(0), catalog.unit());
}

/// Asked of the file: few need it.
std::string Catalog::source_of(std::size_t index) const {
  const std::lock_guard lock(state_->mutex);
  Statement row = state_->database.prepare(
      "SELECT argument FROM sources JOIN parts ON parts.source = sources.id WHERE parts.id = ?");
  row.bind(0, state_->entries[index].id);
  return row.step() ? std::string(row.bytes(0)) : std::string();
}

std::vector<LeftOut> Catalog::left_out() const {
  const std::lock_guard lock(state_->mutex);
  std::vector<LeftOut> all;
  Statement rows = state_->database.prepare("SELECT what, why FROM left_out ORDER BY rowid");
  while (rows.step()) all.push_back({std::string(rows.bytes(0)), std::string(rows.bytes(1))});
  return all;
}

Part Catalog::part(std::size_t index) const { return state_->part(index); }

}  // namespace rollfix
