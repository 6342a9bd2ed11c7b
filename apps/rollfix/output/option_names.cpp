#include "rollfix/output/report.hpp"

#include <array>
#include <boost/algorithm/string/replace.hpp>

namespace rollfix::app {

std::string with_options(std::string text) {
  constexpr std::array kOptionNames = {
      "allow_crossing", "at",       "bridge", "budget",   "clear",     "columns", "corner_angle", "direction",
      "facing",         "finger",   "gap",    "heading",  "layer",     "log",     "loop",         "may_overlap",
      "mirror",         "noise",    "open",   "outer",    "pose",      "prior",   "reading",      "robust",
      "roll",           "skip_bad", "smooth", "squeezed", "tolerance", "touch",   "unit",         "wrapped"};
  boost::replace_all(text, "`at_rest`", "--roll all");
  boost::replace_all(text, "`decimal_comma`", "--decimal ,");
  for (const std::string field : kOptionNames) {
    boost::replace_all(text, "`" + field + "`", "--" + boost::replace_all_copy(field, "_", "-"));
  }
  return text;
}

}  // namespace rollfix::app
