#include "log/header/log_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/error.hpp"
#include "text/text.hpp"

// What columns are called, and guesses where the header calls them otherwise.
//   words           of a name, in small letters: "contact_deg" is contact, deg; "skinL" is skin, l: `words_of`
//   likeness        how much a name sounds like a column: 20 + rank for a whole word, rank for a part of one
//   guess           the column of the header that sounds most like one that is missing: Guesses
// Follows docs/rolling.md, "Logs". Guesses only go into messages, as text to type: nothing is read by them.
namespace rollfix {
namespace {

/// The name without this end; nothing where it has another.
std::optional<std::string_view> stem_of(std::string_view name, std::string_view suffix) {
  if (name.size() <= suffix.size() || name.substr(name.size() - suffix.size()) != suffix) return std::nullopt;
  return name.substr(0, name.size() - suffix.size());
}

}  // namespace

bool is_known(std::string_view name) {
  return std::find(kColumnNames.begin(), kColumnNames.end(), name) != kColumnNames.end();
}

bool is_known_of_any(std::string_view name) {
  const std::array<std::string, 3> suffixes = {"", kFingerSuffixes[0], kFingerSuffixes[1]};
  return std::any_of(suffixes.begin(), suffixes.end(),
                     [&](const std::string& suffix) { return column_named(name, suffix).has_value(); });
}

bool says_where(std::string_view name) {
  return std::any_of(kColumnPairs.begin(), kColumnPairs.end(), [&](const ColumnPair& pair) {
    return name == name_of(pair.place) || name == name_of(pair.angle);
  });
}

bool says_where_of_one_of_two(std::string_view name) {
  return std::any_of(kFingerSuffixes.begin(), kFingerSuffixes.end(), [&](const char* suffix) {
    const auto stem = stem_of(name, suffix);
    return stem && says_where(*stem);
  });
}

/// Without a suffix, of the log of one finger; with one, of one of two. Names have to match exactly, in small letters.
std::optional<Column> column_named(std::string_view name, const std::string& suffix) {
  for (std::size_t k = 0; k < kColumnCount; ++k) {
    const auto column = static_cast<Column>(k);
    // The time is common to both fingers and never has a suffix; `contact` may have one.
    const bool is_common = column == Column::time || column == Column::contact;
    if (name == kColumnNames[k] + suffix && (suffix.empty() || column != Column::time)) return column;
    if (is_common && name == kColumnNames[k]) return column;
  }
  return std::nullopt;
}

/// Cuts "wrapped" or "unwrapped" off the end of a unit, with the colon before it; nothing where it does not end so.
std::optional<bool> take_wrapping(std::string_view& unit) {
  const std::size_t colon = unit.rfind(':');
  const std::string_view last = colon == std::string_view::npos ? unit : trimmed(unit.substr(colon + 1));
  if (last != "wrapped" && last != "unwrapped") return std::nullopt;
  unit = colon == std::string_view::npos ? std::string_view() : trimmed(unit.substr(0, colon));
  return last == "wrapped";
}

bool takes(Column column, Dimension dimension) {
  switch (column) {
    case Column::time:
      return dimension == Dimension::time;
    // Of a disk an angle, of any other finger a length.
    case Column::u:
      return dimension != Dimension::time;
    case Column::x:
    case Column::y:
    case Column::length:
    case Column::distance:
      return dimension == Dimension::length;
    case Column::psi:
    case Column::turn:
    case Column::dturn:
      return dimension == Dimension::angle;
    case Column::contact:  // 0 or 1
      break;
  }
  return false;
}

std::string what_it_takes(Column column) {
  std::vector<std::string> taken;
  for (const Dimension dimension : {Dimension::angle, Dimension::length, Dimension::time}) {
    if (takes(column, dimension)) taken.push_back(fmt::format("{} ({})", name_of(dimension), unit_names(dimension)));
  }
  return taken.empty() ? "0 or 1, without a unit" : fmt::format("{}", fmt::join(taken, " or "));
}

namespace {

/// One field of `columns`: COLUMN=NAME, COLUMN=NAME:UNIT, and of u and psi ":wrapped" or ":unwrapped" at the end.
/// `what` begins the message. Throws InputError: another form, a column that is not known, a unit that is not the
/// column's.
ColumnSource parse_source(std::string_view field, const std::string& what) {
  const std::size_t mark = field.find('=');
  if (mark == std::string_view::npos || mark == 0 || mark + 1 == field.size()) {
    throw InputError(
        fmt::format("{}: '{}' is not COLUMN=NAME or COLUMN=NAME:UNIT, as in u=contact_deg:deg", what, shown(field)));
  }
  ColumnSource source{std::string(trimmed(field.substr(0, mark))), std::string(trimmed(field.substr(mark + 1)))};
  // The column of one finger, or of either of two.
  std::optional<Column> column;
  for (const char* const suffix : {"", kFingerSuffixes[0], kFingerSuffixes[1]}) {
    if (!column) column = column_named(source.column, suffix);
  }
  if (!column) {
    throw InputError(fmt::format("{}: there is no column '{}'; {}; of two fingers with _a and _b behind them", what,
                                 shown(source.column),
                                 known_names(source.column, {kColumnNames.begin(), kColumnNames.end()})));
  }
  // From the end: first how it is wrapped, then the unit. What is left is the name, which may hold colons itself.
  std::string wrapping;
  std::string_view before = source.name;
  const bool may_wrap = column == Column::u || column == Column::psi;
  if (may_wrap && before.find(':') != std::string_view::npos && take_wrapping(before)) {
    wrapping = trimmed(std::string_view(source.name).substr(source.name.rfind(':') + 1));
    source.name = before;
  }
  source.unit = wrapping;
  // The last colon: a name may hold others, and then needs a unit behind it.
  const std::size_t colon = source.name.rfind(':');
  if (colon == std::string::npos) return source;
  const std::optional<Unit> unit = unit_named(trimmed(std::string_view(source.name).substr(colon + 1)));
  if (!unit || !takes(*column, unit->dimension)) {
    throw InputError(
        fmt::format("{}: '{}' of {} is not in a unit of it, expected {}; behind a name with a colon in it "
                    "goes another colon and the unit",
                    what, shown(source.name), source.column, what_it_takes(*column)));
  }
  source.unit = fmt::format("{}{}{}", unit->name, wrapping.empty() ? "" : ":", wrapping);
  source.name = trimmed(std::string_view(source.name).substr(0, colon));
  return source;
}

}  // namespace

/// Fields between commas, each column at most once.
std::vector<ColumnSource> parse_columns(std::string_view text) {
  const std::string what = fmt::format("`columns` {}", shown(text));
  std::vector<ColumnSource> sources;
  for (const std::string_view field : split(text, ',')) {
    sources.push_back(parse_source(field, what));
    // One column can't be in two places.
    const auto is_same = [&](const ColumnSource& one) { return one.column == sources.back().column; };
    if (std::find_if(sources.begin(), sources.end(), is_same) != sources.end() - 1) {
      throw InputError(fmt::format("{}: {} is given twice", what, sources.back().column));
    }
  }
  return sources;
}

namespace {

/// What people call a column, the likeliest first.
struct Habit {
  Column column;
  std::array<std::string_view, 10> words;  // unused places are empty
};

constexpr std::array kHabits = {
    Habit{Column::time, {"time", "stamp", "timestamp", "t", "clock", "ts"}},
    Habit{Column::u, {"u", "contact", "skin", "tactile", "taxel", "cop", "touch", "pad", "angle"}},
    Habit{Column::psi, {"psi", "yaw", "orientation", "heading", "rotation", "rot", "joint", "theta", "phi", "finger"}},
    Habit{Column::x, {"x", "px", "posx"}},
    Habit{Column::y, {"y", "py", "posy"}},
    Habit{Column::length,
          {"length", "travelled", "traveled", "path", "arc", "odometer", "odo", "dist", "distance", "s"}},
    Habit{Column::turn, {"turn", "tangent", "heading", "yaw", "theta", "angle", "psi"}},
    Habit{Column::distance, {"distance", "step", "encoder", "dist", "ds", "dl", "wheel", "delta"}},
    Habit{Column::dturn, {"dturn", "gyro", "dtheta", "dyaw", "dpsi", "dheading"}},
};

/// "contact_deg" as contact, deg; "skinL" as skin, l.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  const std::string letters = lower_case(name);
  for (std::size_t k = 0; k < name.size(); ++k) {
    const char c = letters[k];
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    const bool begins = k > 0 && c != name[k] && letters[k - 1] == name[k - 1];  // a capital behind none
    if ((begins || !is_letter) && !words.back().empty()) words.emplace_back();
    if (is_letter) words.back() += c;
  }
  // A name that ends in a mark, as in "u_".
  if (words.back().empty() && words.size() > 1) words.pop_back();
  return words;
}

/// What people tell two fingers apart by, in the order of kFingerSuffixes.
constexpr std::array<std::array<std::string_view, 2>, 3> kFingerWords = {{{"a", "b"}, {"left", "right"}, {"l", "r"}}};

/// The word that says which finger a name is of, as in "contact_deg_a", "left_skin", "skinL_deg"; the end where none
/// does.
std::vector<std::string>::const_iterator finger_word(const std::vector<std::string>& words) {
  return std::find_if(words.begin(), words.end(), [&](const std::string& word) {
    // A name that is nothing but the word is a column's: "a" is no finger's.
    return words.size() > 1 && std::any_of(kFingerWords.begin(), kFingerWords.end(),
                                           [&](const auto& two) { return word == two[0] || word == two[1]; });
  });
}

/// The finger that a name is of: its place in kFingerSuffixes.
std::optional<std::size_t> finger_in(const std::vector<std::string>& words) {
  const auto word = finger_word(words);
  if (word == words.end()) return std::nullopt;
  return std::any_of(kFingerWords.begin(), kFingerWords.end(), [&](const auto& two) { return *word == two[1]; }) ? 1
                                                                                                                 : 0;
}

/// How much a name sounds like a column: 0 not at all.
int likeness(const HeaderName& header, Column column) {
  const auto* const habit =
      std::find_if(kHabits.begin(), kHabits.end(), [&](const Habit& one) { return one.column == column; });
  if (habit == kHabits.end()) return 0;
  int best = 0;
  for (std::size_t k = 0; k < habit->words.size() && !habit->words[k].empty(); ++k) {
    const std::string_view word = habit->words[k];
    // The earlier in the list, the likelier.
    const int worth = static_cast<int>(habit->words.size() - k);
    for (const std::string& said : words_of(header.name)) {
      if (said == word) best = std::max(best, 20 + worth);
      // A part of a word counts less, and not of words as short as "u" or "ts".
      if (word.size() > 2 && said.find(word) != std::string::npos) best = std::max(best, worth);
    }
  }
  return best;
}

/// A header's column that may be one of ours.
struct Guess {
  Column column = Column::u;          // that is missing
  std::size_t cell = Columns::kNone;  // of the header; kNone: nothing sounds like it
  int likeness = 0;                   // 0: nothing does
};

/// Says what the columns might be, each of the header's used once.
class Guesses {
 public:
  /// Cells that were found by name can't be guessed again.
  Guesses(const std::vector<HeaderName>& header, const Columns& found) : header_(header), found_(found) {
    for (const std::size_t cell : found.cell) {
      if (cell != Columns::kNone) taken_.push_back(cell);
    }
  }

  /// Guesses a column that the header does not have; where it has it nothing is done. `is_needed`: it is listed even if
  /// no name sounds like it, as NAME to be filled in.
  void add(Column column, bool is_needed) {
    if (found_.has(column)) return;
    Guess best{column};
    for (std::size_t k = 0; k < header_.size(); ++k) {
      if (std::find(taken_.begin(), taken_.end(), k) != taken_.end()) continue;
      // The likeliest of the cells that are still free; of equal ones the first.
      const int here = likeness(header_[k], column);
      if (here > best.likeness) best = {column, k, here};
    }
    // An optional column that nothing sounds like is not asked for.
    if (best.likeness == 0 && !is_needed) return;
    if (best.likeness > 0) taken_.push_back(best.cell);
    guesses_.push_back(best);
  }

  /// How well all guesses together sound; 100 for each column that has one, so that more columns go before better ones.
  int likeness_of_all() const {
    int sum = 0;
    for (const Guess& guess : guesses_) sum += guess.likeness > 0 ? 100 + guess.likeness : 0;
    return sum;
  }

  /// The guesses as `columns` takes them, "u=contact_deg:deg".
  std::vector<std::string> fields() const {
    std::vector<std::string> fields;
    for (const Guess& guess : guesses_) {
      const std::string column = found_.called(guess.column);
      if (guess.likeness == 0) {
        fields.push_back(fmt::format("{}=NAME", column));
        continue;
      }
      const HeaderName& header = header_[guess.cell];
      const std::string unit = header.unit.empty() ? unit_in_name(header.name, guess.column, "") : "";
      fields.push_back(fmt::format("{}={}{}", column, header.name, unit.empty() ? "" : ":" + unit));
    }
    return fields;
  }

 private:
  const std::vector<HeaderName>& header_;
  const Columns& found_;            // columns that were found by name
  std::vector<std::size_t> taken_;  // cells of the header that are used already
  std::vector<Guess> guesses_;
};

/// The fields of one finger. Of the three pairs the one that the header has half of, or all of, else the one that
/// sounds best.
std::vector<std::string> fields_for(const std::vector<HeaderName>& header, const Columns& found, bool with_time) {
  // One column of it is there, the other one is not.
  const auto half = [&](const ColumnPair& pair) { return found.has(pair.place) != found.has(pair.angle); };
  const bool any_half = std::any_of(kColumnPairs.begin(), kColumnPairs.end(), half);
  const auto whole = [&](const ColumnPair& pair) { return found.has(pair.place) && found.has(pair.angle); };
  const bool any_whole = std::any_of(kColumnPairs.begin(), kColumnPairs.end(), whole);
  std::optional<Guesses> best;
  for (const ColumnPair& pair : kColumnPairs) {
    // A pair of which one column is there is meant, and so is one that is whole.
    if (any_half ? !half(pair) : any_whole && !whole(pair)) continue;
    Guesses guesses(header, found);
    guesses.add(pair.place, true);
    guesses.add(pair.angle, true);
    // Of equal ones the first, which is u and psi.
    if (!best || guesses.likeness_of_all() > best->likeness_of_all()) best.emplace(guesses);
  }
  if (with_time) best->add(Column::time, false);
  // x and y go together: one is needed where the other is there.
  best->add(Column::x, found.has(Column::y));
  best->add(Column::y, found.has(Column::x));
  return best->fields();
}

/// Those of one finger and what is of no finger; the others' places stay, without names.
std::vector<HeaderName> of_finger(const std::vector<HeaderName>& header, std::size_t finger) {
  std::vector<HeaderName> result = header;
  for (HeaderName& one : result) {
    if (finger_in(words_of(one.name)).value_or(finger) != finger) one = {};
  }
  return result;
}

/// Whether the names are of two fingers, in ways of their own.
bool names_two_fingers(const std::vector<HeaderName>& header) {
  std::array<int, 2> count{};
  for (const HeaderName& one : header) {
    if (const auto finger = finger_in(words_of(one.name))) ++count[*finger];
  }
  return count[0] >= 2 && count[1] >= 2;
}

}  // namespace

/// Only a guess, for messages and to refuse a column whose unit is in doubt: it never converts a number by itself.
std::string unit_in_name(std::string_view name, Column column, const std::string& part_unit) {
  std::vector<std::string> words = words_of(name);
  // "contact_deg_a": the unit may stand before the finger.
  if (const auto word = finger_word(words); word != words.end()) words.erase(word);
  if (words.size() < 2) return "";
  const std::optional<Unit> unit = unit_named(words.back());
  if (!unit || !takes(column, unit->dimension)) return "";
  // A unit that changes nothing, as rad, need not be said.
  const bool changes =
      unit->dimension == Dimension::length ? unit->name != part_unit : !conversion_to_plain(*unit).is_identity();
  return changes ? std::string(unit->name) : "";
}

/// A header may have left_skin and right_skin: a log of one finger says what it does not look at.
std::string other_finger_note(const std::vector<HeaderName>& header, const Columns& found) {
  const ColumnPair& pair = kColumnPairs[static_cast<std::size_t>(found.kind)];
  const auto is_taken = [&](std::size_t k) {
    return std::find(found.cell.begin(), found.cell.end(), k) != found.cell.end();
  };
  // The finger whose columns were taken, where their name says it.
  const std::optional<std::size_t> own = finger_in(words_of(header[found[pair.place]].name));
  std::vector<std::string_view> others;
  for (std::size_t k = 0; k < header.size(); ++k) {
    const std::optional<std::size_t> finger = finger_in(words_of(header[k].name));
    // Columns that are taken, of no finger, or of the same one are not of another.
    if (is_taken(k) || !finger || finger == own) continue;
    if (likeness(header[k], pair.place) > 0 || likeness(header[k], pair.angle) > 0) others.push_back(header[k].name);
  }
  if (others.empty()) return "";
  const std::string cure =
      names_two_fingers(header) ? fmt::format("; both are taken with `columns` {}", suggested_columns(header, {})) : "";
  return fmt::format("this is about one finger: the columns of another, {}, are not looked at{}",
                     fmt::join(others, ", "), cure);
}

bool holds_columns_of(const std::vector<HeaderName>& header, std::size_t finger) {
  return std::any_of(header.begin(), header.end(), [&](const HeaderName& one) {
    // A name that says another finger.
    if (finger_in(words_of(one.name)).value_or(finger) != finger) return false;
    return std::any_of(kColumnPairs.begin(), kColumnPairs.end(), [&](const ColumnPair& pair) {
      return likeness(one, pair.place) > 0 || likeness(one, pair.angle) > 0;
    });
  });
}

std::string suggested_columns(const std::vector<HeaderName>& header, const Columns& found) {
  std::vector<std::string> fields;
  // Two fingers by names of other kinds, as left and right: fields for both.
  const bool is_of_two = found.suffix.empty() && names_two_fingers(header);
  for (std::size_t finger = 0; finger < (is_of_two ? 2U : 1U); ++finger) {
    Columns own = found;
    if (is_of_two) own.suffix = kFingerSuffixes[finger];
    // Fields of the finger that the columns are of, with what is of no finger.
    const std::size_t whose = own.suffix == kFingerSuffixes[1] ? 1 : 0;
    const std::vector<std::string> more =
        fields_for(own.suffix.empty() ? header : of_finger(header, whose), own, finger == 0);
    fields.insert(fields.end(), more.begin(), more.end());
  }
  return quoted_for_shell(fmt::format("{}", fmt::join(fields, ",")));
}

std::string written(const std::vector<ColumnSource>& columns) {
  std::vector<std::string> fields;
  for (const ColumnSource& one : columns) {
    fields.push_back(fmt::format("{}={}{}{}", one.column, one.name, one.unit.empty() ? "" : ":", one.unit));
  }
  return quoted_for_shell(fmt::format("{}", fmt::join(fields, ",")));
}

}  // namespace rollfix
