#include "contact/log_writer.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "contact/unwrap.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/error.hpp"

namespace rollfix {

std::vector<NamedColumn> columns_of(const Log& log, const std::string& suffix) {
  const std::vector<NamedColumn> all = {{"time", &log.time},          {"u" + suffix, &log.u},
                                        {"psi" + suffix, &log.psi},   {"length" + suffix, &log.length},
                                        {"turn" + suffix, &log.turn}, {"x" + suffix, &log.x},
                                        {"y" + suffix, &log.y}};
  std::vector<NamedColumn> present;
  for (const NamedColumn& column : all) {
    if (column.second->empty()) continue;
    if (column.second->size() != log.rows()) {
      throw InputError(fmt::format("{}: expected {} values in column '{}', found {}", log.name, log.rows(),
                                   column.first, column.second->size()));
    }
    present.push_back(column);
  }
  return present;
}

std::string format_table(const std::vector<NamedColumn>& columns, std::size_t rows) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (std::size_t k = 0; k < columns.size(); ++k) fmt::format_to(out, "{}{}", k == 0 ? "" : ",", columns[k].first);
  text.push_back('\n');
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      // With trailing zeros: they say how precise the number is.
      fmt::format_to(out, "{}{:#.17g}", k == 0 ? "" : ",", (*columns[k].second)[row]);
    }
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

void write_text(const std::string& path, const std::string& text) {
  if (path == "-") {
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
    throw InputError(fmt::format("standard output: can't be written: {}", std::strerror(errno)));
  }
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), &std::fclose);
  const bool is_written = file && std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  const bool is_closed = file && std::fclose(file.release()) == 0;
  if (!is_written || !is_closed) throw InputError(fmt::format("{}: can't be written: {}", path, std::strerror(errno)));
}

std::string format_log(const Log& log) {
  require_readable(log);
  return format_table(columns_of(log), log.rows());
}

void write_log(const std::string& path, const Log& log) { write_text(path, format_log(log)); }

}  // namespace rollfix
