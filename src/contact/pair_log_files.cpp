#include <fmt/format.h>

#include <string>
#include <vector>

#include "contact/log_columns.hpp"
#include "contact/log_writer.hpp"
#include "contact/unwrap.hpp"
#include "rollfix/contact/pair_log.hpp"
#include "rollfix/error.hpp"
#include "text/text_file.hpp"

namespace rollfix {

PairLog read_pair_log(const std::string& path) {
  return parse_pair_log(read_text(path), path == "-" ? "standard input" : path);
}

PairLog read_pair_log(const std::string& path_a, const std::string& path_b) {
  if (path_a == "-" && path_b == "-") {
    throw InputError("the logs of both fingers can't come from standard input: give one of them as a file");
  }
  return paired(read_log(path_a), read_log(path_b));
}

std::string format_pair_log(const PairLog& log) {
  if (log.a.rows() != log.b.rows() || log.a.time != log.b.time) {
    throw InputError(fmt::format("expected the same rows and times of both fingers, found {} and {} rows{}",
                                 log.a.rows(), log.b.rows(),
                                 log.a.rows() == log.b.rows() ? " with different times" : ""));
  }
  require_readable(log.a);
  require_readable(log.b);
  std::vector<NamedColumn> columns = columns_of(log.a, kFingerSuffixes[0]);
  for (const NamedColumn& column : columns_of(log.b, kFingerSuffixes[1])) {
    if (column.first != name_of(Column::time)) columns.push_back(column);
  }
  return format_table(columns, log.rows());
}

void write_pair_log(const std::string& path, const PairLog& log) { write_text(path, format_pair_log(log)); }

}  // namespace rollfix
