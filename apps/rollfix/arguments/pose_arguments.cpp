#include "rollfix/arguments/pose_arguments.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

// Who knows a heading no better than that in radians does not write it so.
constexpr double kMostBareSd = 1.6;

/// A number without a unit that is beyond what anyone means in radians. Throws InputError.
void require_no_bare_degrees(const std::string& what, std::string_view typed, double angle, double most) {
  const bool says_unit = take_degrees(typed);
  if (says_unit || std::abs(angle) <= most) return;
  throw InputError(
      fmt::format("{}: {} rad is {:.3g} deg, expected an angle of at most {:.3g} rad where no unit is typed; "
                  "degrees are written {}deg",
                  what, angle, angle / kDegree, most, typed));
}

}  // namespace

void add_pose_arguments(CLI::App& command, PoseArguments& arguments) {
  command
      .add_option(
          "--heading", arguments.heading,
          "with --noise, and touches or a log of u and psi: what is known of the part's heading in the world at "
          "the first contact, and its standard deviation")
      ->type_name("ANGLE,SD");
  command
      .add_option("--pose", arguments.pose,
                  "the same with the part's position, for touches or a log with x and y: X,Y,HEADING, and the standard "
                  "deviations of x and y and of the heading")
      ->type_name("X,Y,HEADING,SD,SD_HEADING");
}

std::optional<PosePrior> read_pose(const PoseArguments& arguments, const std::string& unit) {
  if (arguments.heading.empty() && arguments.pose.empty()) return std::nullopt;
  if (!arguments.heading.empty() && !arguments.pose.empty()) {
    throw InputError("--heading and --pose both say how the part is turned: leave one out");
  }
  const bool is_pose = !arguments.pose.empty();
  const std::string what = is_pose ? "--pose " + arguments.pose : "--heading " + arguments.heading;
  const std::vector<std::string_view> fields = split(is_pose ? arguments.pose : arguments.heading, ',');
  if (fields.size() != (is_pose ? 5U : 2U)) {
    throw InputError(what + (is_pose
                                 ? ": expected X,Y,HEADING,SD,SD_HEADING as in 100,40,12deg,0.5,2deg: where the part "
                                   "lies in the world at the first contact, and the standard deviations of x and y "
                                   "and of the heading"
                                 : ": expected ANGLE,SD as in 12deg,2deg: how the part is turned in the world at the "
                                   "first contact, and its standard deviation"));
  }
  PosePrior prior;
  const std::string_view heading = fields[is_pose ? 2 : 0];
  prior.mean.heading = read_angle(heading, what);
  prior.heading_sd = read_angle(fields.back(), what);
  require_no_bare_degrees(what, heading, prior.mean.heading, kFullTurn);
  require_no_bare_degrees(what, fields.back(), prior.heading_sd, kMostBareSd);
  if (is_pose) {
    prior.mean.x = read_length(fields[0], what, unit);
    prior.mean.y = read_length(fields[1], what, unit);
    prior.place_sd = read_length(fields[3], what, unit);
  }
  if (!(prior.heading_sd > 0) || !(prior.place_sd > 0)) {
    throw InputError(what + ": expected standard deviations above 0");
  }
  return prior;
}

}  // namespace rollfix::app
