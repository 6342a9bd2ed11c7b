#include "rollfix/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "rollfix/dropped.hpp"
#include "rollfix/table.hpp"
#include "rollfix/typed_number.hpp"

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
  return fmt::format("rolled from s = {} over length {}; the tangent turned by {} deg", fixed(s.front(), decimals),
                     fixed(s.back() - s.front(), decimals), degrees(angle.back() - angle.front()));
}

std::string beyond_reach_note(const Part& part, const DiskFinger& disk, const std::vector<double>& s,
                              const std::string& finger) {
  const auto [least, most] = std::minmax_element(s.begin(), s.end());
  const auto obstruction =
      obstruction_of(part, reach_of_disk(part, disk.radius), s.front(), {*least - s.front(), *most - s.front()});
  return obstruction ? fmt::format("{}can't do this roll: {}", finger, about(*obstruction, part)) : "";
}

void add_reach_note(Report& report, const std::string& note) {
  if (!note.empty()) report.notes.push_back(note);
}

void require_writable_log(const std::string& file, bool force) {
  if (!is_stdout(file)) require_writable(file, force);
}

void add_log(Report& report, const std::string& file, const std::string& text) {
  if (is_stdout(file)) {
    report.data = text;
    return;
  }
  report.files.push_back({file, text});
  report.notes.push_back(fmt::format("wrote {}", file));
}

}  // namespace rollfix::app
