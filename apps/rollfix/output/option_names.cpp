#include "rollfix/output/option_names.hpp"

#include <array>
#include <boost/algorithm/string/replace.hpp>

namespace rollfix::app {

std::string with_options(std::string text) {
  constexpr std::array kFields = {"allow_crossing", "at",       "bridge", "clear",     "columns", "corner_angle",
                                  "facing",         "finger",   "gap",    "layer",     "loop",    "mirror",
                                  "noise",          "open",     "outer",  "pose",      "prior",   "robust",
                                  "roll",           "skip_bad", "smooth", "tolerance", "unit",    "wrapped"};
  boost::replace_all(text, "`decimal_comma`", "--decimal ,");
  for (const std::string field : kFields) {
    boost::replace_all(text, "`" + field + "`", "--" + boost::replace_all_copy(field, "_", "-"));
  }
  return text;
}

}  // namespace rollfix::app
