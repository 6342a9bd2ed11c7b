#include "rollfix/arguments/travel_argument.hpp"

#include <string_view>
#include <vector>

#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix::app {

Interval read_travel(const std::string& text, const std::string& unit) {
  const std::vector<std::string_view> fields = split(text, ',');
  const std::string what = "--travel " + text;
  if (fields.size() == 1) {
    const double most = read_length(fields[0], what, unit);
    if (!(most > 0)) throw InputError(what + ": expected a length above 0, or BACK,FORWARD as in -0.5,1.2");
    return {-most, most};
  }
  if (fields.size() != 2) {
    throw InputError(what + ": expected one length, or BACK,FORWARD as in -0.5,1.2; are there decimal commas in it?");
  }
  const Interval travel{read_length(fields[0], what, unit), read_length(fields[1], what, unit)};
  if (!(travel.lo <= 0 && travel.hi >= 0 && travel.width() > 0)) {
    throw InputError(what + ": expected a length of at most 0, backwards, and one of at least 0, forwards, not both 0");
  }
  return travel;
}

}  // namespace rollfix::app
