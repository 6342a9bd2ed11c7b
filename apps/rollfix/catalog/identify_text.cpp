#include "rollfix/catalog/identify_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/output/table.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

std::string places(const Json& numbers) {
  std::vector<std::string> all;
  for (const Json& number : numbers) all.push_back(fixed(number.get<double>(), decimals_for(number.get<double>())));
  return fmt::format("{}", fmt::join(all, ", "));
}

std::string probability(const Json& number) {
  constexpr double kLeast = 0.00005;
  if (number.is_null()) return "-";
  return number.get<double>() < kLeast ? "<0.0001" : fmt::format("{:.4f}", number.get<double>());
}

/// A row for each placement, the part's name and probability in its first.
std::string parts_table(const Json& document, const std::string& unit) {
  const bool has_noise = !document["noise"].is_null();
  Table table;
  table.add_column("part", Table::Align::left);
  if (has_noise) table.add_column("probability");
  table.add_column("there", Table::Align::left);
  if (has_noise) table.add_column("place's");
  for (const char* title : {"start", "end"}) table.add_column(title_in(title, unit));
  std::size_t rows = 0;
  std::size_t left_out = 0;
  for (const Json& part : document["parts"]) {
    bool is_first = true;
    for (const Json& placement : part["placements"]) {
      if (++rows > kMostRows) {
        ++left_out;
        continue;
      }
      std::vector<std::string> cells{is_first ? part["name"].get<std::string>() : ""};
      if (has_noise) cells.push_back(is_first ? probability(part["probability"]) : "");
      std::string kind = placement["kind"].get<std::string>();
      if (placement.contains("direction")) kind += " " + placement["direction"].get<std::string>();
      cells.push_back(kind);
      if (has_noise) cells.push_back(probability(placement["probability"]));
      cells.push_back(places(placement["start"]));
      cells.push_back(places(placement["end"]));
      table.add_row(std::move(cells));
      is_first = false;
    }
  }
  const std::string more =
      left_out == 0 ? ""
                    : fmt::format("... and {} more; --json lists them all\n", counted(left_out, "place", "places"));
  return table.str() + more;
}

// Of a part with a symmetry, or of a continuum, no more poses are shown.
constexpr std::size_t kMostPoses = 4;

Table table_of_poses(bool has_noise, const std::string& unit) {
  Table table;
  table.add_column("part", Table::Align::left);
  if (has_noise) table.add_column("probability");
  if (has_noise) table.add_column("pose's");
  for (const std::string& title : {title_in("x", unit), title_in("y", unit), std::string("heading [deg]")}) {
    table.add_column(title);
    if (has_noise) table.add_column("±");
  }
  table.add_column("", Table::Align::left);
  return table;
}

/// x, y and heading of a pose, with noise each with its standard deviation; null: of any pose, of rolls without x and y
/// of any place.
void add_pose_cells(const Json& pose, bool has_noise, std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double factor = i < 2 ? 1 : 1 / kDegree;
    const bool is_any = pose.is_null() || pose["pose"][0][i].is_null() || (i == 2 && pose["any_heading"].get<bool>());
    const double value = is_any ? 0 : factor * pose["pose"][0][i].get<double>();
    cells.push_back(is_any ? "any" : fixed(value, i < 2 ? decimals_for(value) : 3));
    if (!has_noise) continue;
    const double variance = is_any ? 0 : pose["pose_covariance"][i][i].get<double>();
    cells.push_back(is_any ? "-" : rough(factor * std::sqrt(std::max(0.0, variance))));
  }
}

/// Of touches: a row for each pose.
std::string poses_table(const Json& document, const std::string& unit) {
  const bool has_noise = !document["noise"].is_null();
  Table table = table_of_poses(has_noise, unit);
  std::size_t parts = 0;
  for (const Json& part : document["parts"]) {
    if (++parts > kMostRows) break;
    const Json any_pose = Json::array({nullptr});  // one touch
    const Json& poses = part["placements"].empty() ? any_pose : part["placements"];
    for (std::size_t k = 0; k < std::min(poses.size(), kMostPoses); ++k) {
      const Json& pose = poses[k];
      std::string name = k == 0 ? part["name"].get<std::string>() : "";
      if (k + 1 == kMostPoses && poses.size() > kMostPoses) {
        name = fmt::format("  and {} more", counted(poses.size() - kMostPoses, "pose", "poses"));
      }
      std::vector<std::string> cells{name};
      if (has_noise) cells.push_back(k == 0 ? probability(part["probability"]) : "");
      if (has_noise) cells.push_back(pose.is_null() ? "-" : probability(pose["probability"]));
      add_pose_cells(pose, has_noise, cells);
      cells.emplace_back(pose.is_null() || pose["kind"] != "continuum" ? "" : "continuum");
      table.add_row(std::move(cells));
    }
  }
  const std::size_t more = document["parts"].size() - std::min(document["parts"].size(), kMostRows);
  return table.str() +
         (more == 0 ? ""
                    : fmt::format("... and {}; --json lists them all\n", counted(more, "more part", "more parts")));
}

/// Of touches and rolls: what to do next.
std::string advice_of_touches(const Json& document) {
  const bool has_rolls = !document["rolls"].empty();
  const auto is_open = [](const Json& part) {
    return part["verdict"].get<std::string>().rfind("unobservable", 0) == 0;
  };
  if (document["samples"] == 1 && !document["parts"].empty() && is_open(document["parts"][0])) {
    return "one touch fits every part in any pose: touch the part elsewhere as well\n";
  }
  if (!document["undecided"].empty()) {
    return fmt::format("the budget ran out on {}: more {}, or a larger --budget, leave less to look at\n",
                       counted(document["undecided"].size(), "part", "parts"), has_rolls ? "rolls" : "touches");
  }
  if (!document["parts"].empty()) return "";
  if (has_rolls) {
    return "no pose of any part fits all rolls and touches: check the noise, the unit, the finger's radius, and "
           "--mirror, and whether the part was moved in between\n";
  }
  return "no pose of any part fits all touches: check the noise, the unit, the finger's radius, and --mirror\n";
}

std::string congruent_lines(const Json& document) {
  std::string text;
  std::size_t lines = 0;
  for (const Json& part : document["parts"]) {
    if (part["congruent_with"].empty()) continue;
    if (++lines > kMostNotes) continue;
    std::vector<std::string> others;
    for (const Json& name : part["congruent_with"]) others.push_back(name.get<std::string>());
    text += fmt::format("{} can't be told from {}\n", plain(part["name"].get<std::string>()),
                        plain(fmt::format("{}", fmt::join(others, ", "))));
  }
  if (lines > kMostNotes) text += fmt::format("... and {} more such lines\n", lines - kMostNotes);
  return text;
}

std::string refused_lines(const Json& document) {
  std::string text;
  const Json& refused = document["refused"];
  for (std::size_t k = 0; k < std::min(refused.size(), kMostNotes); ++k) {
    text += fmt::format("not on {}: {}\n", plain(refused[k]["name"].get<std::string>()),
                        plain(refused[k]["why"].get<std::string>()));
  }
  if (refused.size() > kMostNotes) text += fmt::format("... and not on {} more\n", refused.size() - kMostNotes);
  return text;
}

}  // namespace

std::string identify_text(const Json& document, const std::string& unit) {
  const Json& catalog = document["catalog"];
  std::string text = fmt::format("{}\n{} of {} were searched, bounds rule the others out",
                                 document["verdict"].get<std::string>(), catalog["searched"].get<std::size_t>(),
                                 counted(catalog["parts"].get<std::size_t>(), "part", "parts"));
  if (!document["rest"].is_null() && !document["parts"].empty())
    text += fmt::format("; probability of all that is not listed {}", rough(document["rest"].get<double>()));
  text += "\n";
  const bool of_touches = document.contains("touches");
  if (of_touches) text += advice_of_touches(document);
  if (!document["parts"].empty())
    text += "\n" + (of_touches ? poses_table(document, unit) : parts_table(document, unit));
  const std::string below = congruent_lines(document) + refused_lines(document);
  if (!below.empty()) text += "\n" + below;
  return text;
}

ExitCode exit_code_of(const Json& identified) {
  if (identified["status"] != "complete") return ExitCode::incomplete;
  return identified["parts"].empty() ? ExitCode::nothing_fits : ExitCode::fits;
}

}  // namespace rollfix::app
