#include "plain_rolls.hpp"

#include <numbers>
#include <utility>

#include "rollfix/locate.hpp"

namespace rollfix::touch {
namespace {

/// All that fits the readings.
Answer placed(const Part& part, const RollSearched& roll) {
  Answer alone{part, {}};
  alone.readings.assign(roll.readings.begin(), roll.readings.end());
  alone.tolerance.value = roll.tolerance;
  LocateOptions options;
  options.tolerance = roll.tolerance;
  Search found = locate(part, roll.readings, options);
  alone.status = found.status;
  alone.verdict = found.verdict();
  alone.placements = std::move(found.placements);
  alone.unresolved = std::move(found.unresolved);
  return alone;
}

}  // namespace

std::vector<RollContact> plain_rolls(const Part& part, double radius, const std::vector<RollSearched>& rolls,
                                     const std::vector<TouchTolerance>& tolerance) {
  std::vector<RollContact> contacts;
  for (std::size_t k = 0; k < rolls.size(); ++k) {
    RollContact contact{placed(part, rolls[k]), {}, {}, {}, {}, {}};
    confine_by_readings(contact, part, radius);
    Measured& measured = contact.measured;
    measured.is_roll = true;
    measured.tangent = rolls[k].normal + 0.5 * std::numbers::pi;
    measured.angle_unit = measured.angle_most = tolerance[k].angle;
    measured.has_place = rolls[k].at.has_value();
    measured.at = rolls[k].at.value_or(Vec2::Zero());
    measured.place_unit = measured.place_most = measured.has_place ? tolerance[k].length : part.perimeter();
    measured.tree = contact.tree.get();
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

}  // namespace rollfix::touch
