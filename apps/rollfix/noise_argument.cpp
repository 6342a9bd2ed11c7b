#include "rollfix/noise_argument.hpp"

#include <fmt/format.h>

#include <set>
#include <string_view>

#include "rollfix/error.hpp"
#include "rollfix/typed_number.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

double* place_for(Noise& noise, std::string_view name) {
  if (name == "contact") return &noise.contact;
  if (name == "angle") return &noise.angle;
  if (name == "slip") return &noise.slip;
  if (name == "radius") return &noise.radius;
  return nullptr;
}

}  // namespace

void add_noise_argument(CLI::App& command, std::string& noise) {
  command
      .add_option("--noise", noise,
                  "how far the sensors are off, as standard deviations: contact=LENGTH,angle=ANGLE,slip=PER_LENGTH,"
                  "radius=LENGTH, any of them")
      ->type_name("NOISE");
}

std::optional<Noise> read_noise(const std::string& text) {
  if (text.empty()) return std::nullopt;
  Noise noise;
  std::set<std::string, std::less<>> seen;
  for (const std::string_view field : split(text, ',')) {
    const std::size_t mark = field.find('=');
    const std::string name(field.substr(0, mark));
    double* const place = place_for(noise, name);
    if (place == nullptr || mark == std::string_view::npos) {
      throw InputError(fmt::format("--noise {}: '{}' is not NAME=SD; {}", text, field,
                                   known_names(name, {"contact", "angle", "slip", "radius"})));
    }
    if (!seen.insert(name).second) throw InputError(fmt::format("--noise {}: {} is given twice", text, name));
    const std::string what = fmt::format("--noise {}", text);
    const std::string_view value = field.substr(mark + 1);
    *place = name == "angle" ? read_angle(value, what) : read_number(value, what);
    if (*place < 0)
      throw InputError(fmt::format("--noise {}: {} is below 0, expected a standard deviation", text, name));
  }
  return noise;
}

}  // namespace rollfix::app
