#include "rollfix/simulate/simulation.hpp"
#include "log/mirrored.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>

#include "rollfix/arguments/finger_argument.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/solve.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

bool is_stdout(const std::string& file) { return file == "-"; }

}  // namespace

double orientation_at(const Part& part, double s, const SimulateArguments& arguments, std::size_t finger) {
  const std::vector<std::string>& typed = arguments.contact_angles;  // one may speak for both fingers
  const double contact_angle =
      typed.empty() ? 0 : read_angle(typed[std::min(finger, typed.size() - 1)], "--contact-angle");
  // Off an open part there is no tangent; the roll will say so.
  if (!part.closed() && !(s >= 0 && s <= part.perimeter())) return 0;
  // u + psi is the direction from the finger's centre to the contact: a right angle left of the tangent.
  return part.tangent(s) + std::numbers::pi / 2 - contact_angle;
}

std::string roll_text(const Part& part, const std::vector<double>& s, const std::vector<double>& angle) {
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("rolled from s = {} over length {}{}; the tangent turned by {} deg", fixed(s.front(), decimals),
                     fixed(s.back() - s.front(), decimals), behind(part.unit()), degrees(angle.back() - angle.front()));
}

std::optional<SimulatedNoise> read_simulated_noise(const SimulateArguments& arguments, const std::string& unit) {
  const std::optional<Noise> noise = read_noise(arguments.noise, unit);
  if (!noise && !arguments.seed.empty()) throw InputError("--seed is of --noise: give that as well");
  if (!noise) return std::nullopt;
  return SimulatedNoise{*noise, arguments.seed.empty() ? 0 : read_count(arguments.seed, "--seed", 0)};
}

std::string roll_error_text(const Finger& finger, const RollError& error) {
  std::string text =
      fmt::format("the contact went {:.6g} % farther than the finger was rolled", 100 * error.slip + 0.0);  // no -0
  if (error.radius != 0) text += fmt::format("; its radius really is {:.9g}", finger.length_per_u() + error.radius);
  return text;
}

std::string beyond_reach_note(const Part& part, const Finger& finger, const std::vector<double>& s,
                              const std::string& name) {
  if (!has_reach(finger)) return no_reach_note(finger);
  const auto [least, most] = std::minmax_element(s.begin(), s.end());
  const auto obstruction =
      obstruction_of(part, reach_of(part, finger), s.front(), {*least - s.front(), *most - s.front()});
  return obstruction ? fmt::format("{}can't do this roll: {}", name, about(*obstruction, part)) : "";
}

void add_reach_note(Report& report, const std::string& note) {
  if (!note.empty()) report.notes.push_back(note);
}

Log in_mirror(Log log, const std::vector<Finger>& seen) {
  for (std::size_t k = 0; k < log.fingers.size(); ++k) {
    FingerRows& rows = log.fingers[k];
    const Finger& finger = *finger_of(seen, k);
    for (double& u : rows.u) u = mirrored_u(finger, u);
    for (double& x : rows.x) x = 0.0 - x;  // no -0
    for (double& psi : rows.psi) psi = mirrored_psi(&finger, psi);
  }
  return log;
}

void require_writable_log(const std::string& file, bool force) {
  if (is_stdout(file)) return;
  constexpr std::array<std::string_view, 6> kOthers = {".json", ".svg", ".png", ".pdf", ".dxf", ".db"};
  const std::string ending = ending_of(file);
  if (std::find(kOthers.begin(), kOthers.end(), ending) != kOthers.end()) {
    throw InputError(fmt::format("-o {0}: a log is a table, expected a name as in {1}.csv, found the ending {2}", file,
                                 file.substr(0, file.size() - ending.size()), ending));
  }
  require_writable(file, force);
}

void add_log(Report& report, const std::string& file, const std::string& text, bool force) {
  if (is_stdout(file)) {
    report.data = text;
    return;
  }
  report.files.push_back({file, text, force});
  report.notes.push_back(fmt::format("wrote {}", file));
}

}  // namespace rollfix::app
