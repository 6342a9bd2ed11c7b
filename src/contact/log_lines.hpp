#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace rollfix {

/// Goes through the lines of a text, or of a file through a buffer that does not grow with the file.
class LogLines {
 public:
  /// `name` is what messages call it. The text, or the file, must stay. Throws InputError when it is not plain text.
  LogLines(std::string_view text, std::string name);
  LogLines(std::FILE* file, std::string name);
  LogLines(const LogLines&) = delete;
  LogLines& operator=(const LogLines&) = delete;

  /// The next line without its end, good until the next call; false behind the last. Throws InputError: can't be read.
  bool next(std::string_view& line);

  const std::string& name() const { return name_; }

 private:
  bool refill();

  std::string name_;
  std::FILE* file_ = nullptr;  // none: a text
  std::string buffer_;         // a piece of the file
  const char* cursor_ = nullptr;
  const char* end_ = nullptr;
};

/// Takes the byte order mark off the beginning of a log. Throws InputError when it does not begin like plain text.
std::string_view plain_beginning(std::string_view text, const std::string& name);

}  // namespace rollfix
