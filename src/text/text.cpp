#include "text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

constexpr std::size_t kLeastBeginning = 4;  // of a name: so many letters may stand for it

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

/// Optimal string alignment distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, change});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n\f";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return text.substr(0, 0);
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view without_mark(std::string_view text) {
  return text.substr(text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0);
}

bool has_utf16_mark(std::string_view text) {
  return text.substr(0, 2) == "\xFF\xFE" || text.substr(0, 2) == "\xFE\xFF";
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (std::size_t stop = text.find(separator); stop != std::string_view::npos; stop = text.find(separator)) {
    pieces.push_back(trimmed(text.substr(0, stop)));
    text.remove_prefix(stop + 1);
  }
  pieces.push_back(trimmed(text));
  return pieces;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if ('A' <= c && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string ending_of(const std::string& path) { return lower_case(std::filesystem::path(path).extension().string()); }

bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0) < 0x20 || byte(0) == 0x7F;
  if (character.size() == 2) return (byte(0) == 0xC2 && byte(1) < 0xA0) || character == "\u061C";
  if (character.size() != 3 || byte(0) != 0xE2) return false;
  const bool of_lines_or_direction =
      byte(1) == 0x80 && (byte(2) == 0x8E || byte(2) == 0x8F || (byte(2) >= 0xA8 && byte(2) <= 0xAE));
  const bool of_isolation = byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9;
  return of_lines_or_direction || of_isolation;
}

std::string plain(std::string_view text, char instead) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    if (character == "\t") {
      result += ' ';
    } else if (length == 0 || is_control(character)) {
      result += instead;
    } else {
      result += character;
    }
    text.remove_prefix(character.size());
  }
  return result;
}

std::string quoted_for_shell(std::string_view word) {
  const bool is_safe = std::all_of(word.begin(), word.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_-+.,:=/@%").find(c) != std::string::npos;
  });
  if (is_safe && !word.empty()) return std::string(word);
  std::string result = "'";
  for (const char c : word) c == '\'' ? result += "'\\''" : result += c;
  return result + "'";
}

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 60;
  text = trimmed(text);
  const bool is_long = text.size() > kMost;
  std::size_t length = is_long ? kMost : text.size();
  while (is_long && length > 0 && is_continuation(text[length])) --length;
  const std::string result = plain(text.substr(0, length));
  return is_long ? result + "..." : result;
}

std::string shown_point(double x, double y) {
  constexpr double kRounding = 1e-12;  // of the other coordinate
  const double size = std::max(std::abs(x), std::abs(y));
  const auto clean = [&](double value) { return std::abs(value) <= kRounding * size ? 0 : value; };
  return fmt::format("({:.9g}, {:.9g})", clean(x), clean(y));
}

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string fixed(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  if (is_zero && !text.empty() && text.front() == '-' && std::isfinite(value)) text.erase(0, 1);
  return text;
}

std::string nearest_name(const std::string& typed, const std::vector<std::string>& names) {
  // Beyond a third of the letters it is another word.
  std::size_t least = std::max<std::size_t>(typed.size() / 3, 1) + 1;
  std::string nearest;
  for (const std::string& name : names) {
    // What is so much longer takes as many edits, and may be a file's worth of text.
    if (typed.size() > name.size() + least || name.size() > typed.size() + least) continue;
    const std::size_t distance = edit_distance(typed, name);
    if (distance < least) {
      least = distance;
      nearest = name;
    }
  }
  if (!nearest.empty() || typed.size() < kLeastBeginning) return nearest;
  const auto begun = std::find_if(names.begin(), names.end(),
                                  [&](const std::string& name) { return name.compare(0, typed.size(), typed) == 0; });
  return begun == names.end() ? "" : *begun;
}

std::string known_names(const std::string& typed, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(typed, names);
  const std::string question = nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest);
  return fmt::format("{}Known are: {}", question, fmt::join(names, ", "));
}

std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!is_continuation(text[i])) return 0;
  }
  // Overlong forms, surrogates and what lies beyond Unicode show in the second byte.
  const unsigned char second = byte(1);
  if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second >= 0xa0)) return 0;
  if ((lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second >= 0x90)) return 0;
  // U+FFFE and U+FFFF are no characters, and none that XML allows.
  if (lead == 0xef && second == 0xbf && byte(2) >= 0xbe) return 0;
  return length;
}

void append_utf8(std::string& text, char32_t character) {
  if (character < 0x80) {
    text += static_cast<char>(character);
    return;
  }
  const int rest = character < 0x800 ? 1 : character < 0x10000 ? 2 : 3;  // bytes that follow the first, six bits each
  constexpr unsigned kLeads[] = {0, 0xc0, 0xe0, 0xf0};
  text += static_cast<char>(kLeads[rest] | (character >> (6 * rest)));
  for (int k = rest - 1; k >= 0; --k) text += static_cast<char>(0x80U | ((character >> (6 * k)) & 0x3fU));
}

namespace {

// A pipe or a device that goes on for longer than this, bytes, has no end, and would take all memory there is.
constexpr std::size_t kMostUnexpected = std::size_t{1} << 30;

/// Reads to the end. `expected` is what is known of the size; a file may grow, and of a pipe it is 0.
std::string read_all(std::FILE* file, std::size_t expected, const std::string& name) {
  constexpr std::size_t kLeastRoom = 1 << 16;
  std::string text;
  std::size_t size = 0;
  text.resize(expected + kLeastRoom);
  while (const std::size_t count = std::fread(text.data() + size, 1, text.size() - size, file)) {
    size += count;
    if (size > expected + kMostUnexpected) {
      throw InputError(
          fmt::format("{}: has no end: {} bytes were read, and there are more; expected a text of points, "
                      "readings or curves, or a file, which may be larger",
                      name, size));
    }
    if (text.size() - size < kLeastRoom) text.resize(2 * text.size());
  }
  if (std::ferror(file) != 0) throw InputError(fmt::format("{}: can't be read: {}", name, std::strerror(errno)));
  text.resize(size);
  return text;
}

}  // namespace

OpenFile open_text(const std::string& path) {
  if (path == "-") return {stdin, [](std::FILE* /*file*/) { return 0; }};  // not ours to close
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: there is no such file", path));
  if (std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("{}: is a directory, expected a file", path));
  }
  OpenFile file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError(fmt::format("{}: can't be opened: {}", path, std::strerror(errno)));
  return file;
}

namespace {

/// Of standard input.
std::string& looked_at() {
  static std::string text;
  return text;
}

}  // namespace

std::string beginning_of_text(const std::string& path, std::size_t most) {
  if (path == "-" && !looked_at().empty()) return looked_at();
  std::string text(most, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), open_text(path).get()));
  if (path == "-") looked_at() = text;
  return text;
}

std::string take_looked_at() { return std::exchange(looked_at(), ""); }

std::string read_text(const std::string& path) {
  const OpenFile file = open_text(path);
  if (path == "-") return take_looked_at() + read_all(file.get(), 0, "standard input");
  std::error_code error;
  std::size_t expected = 0;
  if (std::filesystem::is_regular_file(path, error)) {
    expected = static_cast<std::size_t>(std::filesystem::file_size(path, error));
    if (error) expected = 0;
  }
  return read_all(file.get(), expected, path);
}

std::string about_only_returns(const std::string& name) {
  const std::string ending = ending_of(name);
  const std::string other = name.substr(0, name.size() - ending.size()) + "_lf" + ending;
  return fmt::format("{}: has lines that end in a carriage return alone, expected line feeds: tr '\\r' '\\n' < {} > {}",
                     name, quoted_for_shell(name), quoted_for_shell(other));
}

bool has_only_returns(std::string_view text) {
  constexpr std::size_t kBeginning = 4096;
  const std::string_view head = text.substr(0, kBeginning);
  const std::size_t first = head.find('\r');
  // The last character may be the first half of a line's end.
  return first != std::string_view::npos && first + 1 < head.size() && head.find('\n') == std::string_view::npos;
}

}  // namespace rollfix
