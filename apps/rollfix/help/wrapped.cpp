#include "rollfix/help/wrapped.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <vector>

#include "text/text.hpp"

namespace rollfix::app {
namespace {

// Narrower no table of options can be read, wider no paragraph.
constexpr std::size_t kLeastWidth = 40;
constexpr std::size_t kMostWidth = 120;
constexpr std::size_t kUsualWidth = 80;

/// Pieces joined by blanks, and by `turn` where the line is full, which leaves room for its first line.
std::string joined(const std::vector<std::string>& pieces, std::size_t width, std::size_t used,
                   const std::string& turn) {
  const std::size_t room = turn.find('\n');
  const std::size_t indent = turn.size() - room - 1;
  std::string result;
  for (const std::string& piece : pieces) {
    const bool is_first = result.empty();
    if (!is_first && used + 1 + piece.size() + room > width) {
      result += turn;
      used = indent;
    } else if (!is_first) {
      result += ' ';
      ++used;
    }
    result += piece;
    used += piece.size();
  }
  return result;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (const std::string_view word : split(text, ' ')) {
    if (!word.empty()) words.emplace_back(word);
  }
  return words;
}

/// A command's words, an option with its value one piece, and what a shell does next another.
std::vector<std::string> pieces_of_command(std::string_view line) {
  std::vector<std::string> pieces;
  for (const std::string& word : words_of(line)) {
    const bool is_option = word.size() > 1 && word.front() == '-' &&
                           std::isalpha(static_cast<unsigned char>(word[word.size() > 2 ? 2 : 1])) != 0;
    const bool is_next = word == "&&" || word == "|" || word == ">";
    if (pieces.empty() || is_option || is_next) {
      pieces.push_back(word);
    } else {
      pieces.back() += ' ' + word;
    }
  }
  return pieces;
}

std::string wrapped_command(std::string_view line, std::size_t width) {
  constexpr std::string_view kRemark = "  # ";
  const std::size_t remark = line.find(kRemark, 2);
  if (line.size() <= width) return std::string(line);
  if (remark != std::string_view::npos) {
    return "  # " + wrapped(line.substr(remark + kRemark.size()), width, 4) + "\n" +
           wrapped_command("  " + std::string(trimmed(line.substr(0, remark))), width);
  }
  return "  " + joined(pieces_of_command(line), width, 2, " \\\n      ");
}

}  // namespace

std::size_t terminal_width() {
  std::size_t width = 0;
  if (const char* const columns = std::getenv("COLUMNS")) {
    const std::string_view digits = columns;
    std::from_chars(digits.data(), digits.data() + digits.size(), width);
  }
  winsize size = {};
  if (width == 0 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0) width = size.ws_col;
  return width == 0 ? kUsualWidth : std::clamp(width, kLeastWidth, kMostWidth);
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  return joined(words_of(text), width, indent, "\n" + std::string(indent, ' '));
}

std::string wrapped_examples(std::string_view text, std::size_t width) {
  std::string result;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    result += line.substr(0, 2) == "  " ? wrapped_command(line, width) : wrapped(line, width, 0);
    result += '\n';
  }
  return result;
}

}  // namespace rollfix::app
