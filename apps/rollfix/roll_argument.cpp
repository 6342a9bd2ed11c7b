#include "rollfix/roll_argument.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "rollfix/error.hpp"
#include "rollfix/observation.hpp"
#include "rollfix/typed_number.hpp"
#include "text/text.hpp"

namespace rollfix::app {

void add_roll_argument(CLI::App& command, std::string& roll) {
  command
      .add_option("--roll", roll,
                  "which roll of a log in which contact is lost and found again, from 1; default the last")
      ->type_name("N");
}

ChosenRoll read_roll(const std::vector<std::string>& paths, const std::string& roll) {
  const std::size_t number = roll.empty() ? 0 : read_count(roll, "--roll", 1);
  if (paths.size() != 1) {
    if (number > 0) throw InputError("--roll chooses from one log, and --log is given more than once; split the logs");
    return {read_log_argument(paths), ""};
  }
  std::vector<std::vector<Log>> rolls = read_rolls_of_fingers(paths.front());
  const std::size_t count = rolls.size();
  if (number > count) {
    throw InputError(fmt::format("--roll {}: {} holds {}, expected a number from 1 to {}", number, paths.front(),
                                 counted(count, "roll", "rolls"), count));
  }
  const std::size_t chosen = number > 0 ? number : count;
  ChosenRoll result{std::move(rolls[chosen - 1]), ""};
  if (count == 1) return result;
  result.note = fmt::format("{}: roll {} of {}{}", result.logs.front().name, chosen, count,
                            number > 0 ? "" : "; --roll N takes another");
  return result;
}

}  // namespace rollfix::app
