#include "rollfix/locate/batch.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <optional>
#include <ostream>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "files/documents/documents.hpp"
#include "files/json/fields.hpp"
#include "rollfix/answer/many.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/option_names.hpp"
#include "rollfix/usage.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

// Problems that are held at once: enough for all cores, and little memory.
constexpr std::size_t kAtOnce = 1024;

/// A number as it is written, or what a user would type.
std::string typed(const Json& value, const std::string& field) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  throw InputError(fmt::format("\"{}\": expected a number or a text, found {}", field, value.dump()));
}

/// [1, 2] as "1,2".
std::string typed_list(const Json& value, const std::string& field) {
  if (!value.is_array()) return typed(value, field);
  std::string text;
  for (const Json& entry : value) text += (text.empty() ? "" : ",") + typed(entry, field);
  return text;
}

/// One or several.
std::vector<std::string> typed_each(const Json& value, const std::string& field) {
  if (!value.is_array()) return {typed(value, field)};
  std::vector<std::string> texts;
  for (const Json& entry : value) texts.push_back(typed(entry, field));
  return texts;
}

/// [L, theta], {"length": [L], "turn": theta} as in the answer, or "L,THETA" as typed.
std::string typed_reading(const Json& value) {
  if (!value.is_object()) return typed_list(value, "readings");
  if (!value.contains("length") || !value.contains("turn")) {
    throw InputError(fmt::format("\"readings\": expected \"length\" and \"turn\", found {}", value.dump()));
  }
  return typed_list(value["length"], "readings") + "," + typed(value["turn"], "readings");
}

/// [[L, theta], ...].
std::vector<std::string> typed_readings(const Json& value) {
  if (!value.is_array()) throw InputError("\"readings\": expected a list of them, found " + value.dump());
  std::vector<std::string> texts;
  for (const Json& entry : value) texts.push_back(typed_reading(entry));
  return texts;
}

/// {"contact": 0.1, "angle": 0.01}.
std::string typed_noise(const Json& value) {
  if (!value.is_object()) return typed(value, "noise");
  std::string text;
  for (const auto& [name, sd] : value.items()) {
    if (sd.is_number() && sd.get<double>() == 0) continue;  // as an answer lists them
    text += (text.empty() ? "" : ",") + name + "=" + typed(sd, "noise");
  }
  return text;
}

bool typed_switch(const Json& value, const std::string& field) {
  if (value.is_boolean()) return value.get<bool>();
  throw InputError(fmt::format("\"{}\": expected true or false, found {}", field, value.dump()));
}

/// What a field of a problem sets.
struct Field {
  const char* name;
  void (*set)(const Json& value, RollArguments& arguments);
};
constexpr std::array<Field, 19> kFields = {{
    {"readings", [](const Json& value, RollArguments& to) { to.readings = typed_readings(value); }},
    {"log", [](const Json& value, RollArguments& to) { to.logs = typed_each(value, "log"); }},
    {"fingers", [](const Json& value, RollArguments& to) { to.fingers = typed_each(value, "fingers"); }},
    {"roll", [](const Json& value, RollArguments& to) { to.roll = typed(value, "roll"); }},
    {"columns", [](const Json& value, RollArguments& to) { to.reading.columns = typed(value, "columns"); }},
    {"wrapped", [](const Json& value, RollArguments& to) { to.reading.wrapped = typed(value, "wrapped"); }},
    {"skip_bad", [](const Json& value, RollArguments& to) { to.reading.skip_bad = typed_switch(value, "skip_bad"); }},
    {"facing", [](const Json& value, RollArguments& to) { to.facing = typed(value, "facing"); }},
    {"at", [](const Json& value, RollArguments& to) { to.instants = typed_list(value, "at"); }},
    {"tolerance", [](const Json& value, RollArguments& to) { to.tolerance = typed(value, "tolerance"); }},
    {"budget", [](const Json& value, RollArguments& to) { to.budget = typed(value, "budget"); }},
    {"noise", [](const Json& value, RollArguments& to) { to.noise = typed_noise(value); }},
    {"prior", [](const Json& value, RollArguments& to) { to.prior = typed_list(value, "prior"); }},
    {"heading", [](const Json& value, RollArguments& to) { to.pose.heading = typed_list(value, "heading"); }},
    {"pose", [](const Json& value, RollArguments& to) { to.pose.pose = typed_list(value, "pose"); }},
    {"direction", [](const Json& value, RollArguments& to) { to.direction = typed(value, "direction"); }},
    {"mirrored", [](const Json& value, RollArguments& to) { to.mirror = typed_switch(value, "mirrored"); }},
    {"robust", [](const Json& value, RollArguments& to) { to.robust = typed_switch(value, "robust"); }},
    {"may_overlap", [](const Json& value, RollArguments& to) { to.may_overlap = typed_switch(value, "may_overlap"); }},
}};

void set_field(const std::string& name, const Json& value, RollArguments& arguments) {
  if (value.is_null()) return;  // not given
  for (const Field& field : kFields) {
    if (name != field.name) continue;
    field.set(value, arguments);
    return;
  }
  std::vector<std::string> names = {"part", "id"};
  for (const Field& field : kFields) names.emplace_back(field.name);
  throw InputError(fmt::format("there is no field \"{}\"; {}", name, known_names(name, names)));
}

/// Parts by what a line calls them, each loaded once.
class Parts {
 public:
  explicit Parts(const PartArgument& like) : like_(like) {}

  const Part& of(const std::string& name) {
    const auto known = loaded_.find(name);
    if (known != loaded_.end()) return known->second;
    PartArgument argument = like_;
    argument.part = name;
    return loaded_.emplace(name, load(argument).part).first->second;
  }

 private:
  PartArgument like_;
  std::map<std::string, Part> loaded_;
};

/// A line, and what became of it.
struct BatchLine {
  Json id;  // null: it has none
  std::optional<Problem> problem{};
  std::vector<std::string> notes{};
  std::string error{};
};

BatchLine read_line(const std::string& text, const std::string& where, const RollArguments& like, Parts& parts) {
  BatchLine line;
  try {
    const auto watch = [](int depth, Json::parse_event_t /*event*/, const Json& /*value*/) {
      if (depth <= kMostNesting) return true;
      throw InputError(fmt::format("expected a problem, found values nested more than {} deep", kMostNesting));
    };
    const Json object = Json::parse(text, watch);
    if (!object.is_object()) throw InputError("expected a problem, a JSON object, found " + shown(text));
    if (object.contains("id")) line.id = object["id"];
    RollArguments arguments = like;
    for (const auto& [name, value] : object.items()) {
      if (name == "id") continue;
      if (name == "part") {
        arguments.part.part = typed(value, name);
      } else {
        set_field(name, value, arguments);
      }
    }
    if (arguments.readings.empty() == arguments.logs.empty()) {
      throw InputError("expected either \"readings\" or \"log\"");
    }
    line.problem = read_problem(arguments, parts.of(arguments.part.part), line.notes);
  } catch (const Json::parse_error& error) {
    line.error = fmt::format("{}: not a JSON object in one line, from its character {} on", where, error.byte);
  } catch (const Json::exception&) {
    line.error = where + ": holds a number that is out of range";
  } catch (const InputError& error) {
    line.error = fmt::format("{}: {}", where, with_options(error.what()));
  }
  return line;
}

/// Errors weigh most, then what is not decided, then what fits nothing.
ExitCode worse_of(ExitCode one, ExitCode other) {
  const auto weight = [](ExitCode code) {
    return code == ExitCode::bad_input ? 3 : code == ExitCode::incomplete ? 2 : code == ExitCode::nothing_fits ? 1 : 0;
  };
  return weight(one) >= weight(other) ? one : other;
}

/// Writes the answers; the exit code of the worst.
ExitCode answer_lines(const std::vector<BatchLine>& lines, const std::string& name, std::size_t first, bool explain,
                      std::ostream& out) {
  std::vector<Problem> problems;
  for (const BatchLine& line : lines) {
    if (line.problem) problems.push_back(*line.problem);
  }
  const std::vector<Solved> solved = solve(std::span<const Problem>(problems));
  ExitCode worst = ExitCode::fits;
  std::size_t next = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const BatchLine& line = lines[k];
    const Solved* const found = line.problem ? &solved[next++] : nullptr;
    std::string error = line.error;
    if (found != nullptr && !found->answer)
      error = fmt::format("{}:{}: {}", name, first + k, with_options(found->error));
    Json document;
    if (error.empty()) {
      document = answer_json(*found->answer, explain);
    } else {
      document = {{"schema", "rollfix/locate/1"}, {"error", error}};
    }
    if (!line.id.is_null()) document["id"] = line.id;
    for (const std::string& note : line.notes) document["notes"].push_back(with_options(note));
    out << json_line(document);
    worst = worse_of(worst, error.empty() ? exit_code_of(*found->answer) : ExitCode::bad_input);
  }
  out << std::flush;
  if (!out) throw InputError("standard output can't be written to");
  return worst;
}

}  // namespace

Report locate_batch(const RollArguments& like, const std::string& file, bool explain, std::ostream& out) {
  Parts parts(like.part);
  if (!like.part.part.empty()) parts.of(like.part.part);  // what is wrong with it is no line's error
  const std::string text = read_text(file);
  const std::string name = file == "-" ? "standard input" : file;
  Report report;
  std::vector<BatchLine> lines;
  std::size_t number = 0;
  const auto answer_all = [&] {
    const std::size_t first = number - lines.size() + 1;
    report.exit_code = worse_of(report.exit_code, answer_lines(lines, name, first, explain, out));
    lines.clear();
  };
  for (std::string_view rest = without_mark(text); !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++number;
    lines.push_back(read_line(std::string(line), fmt::format("{}:{}", name, number), like, parts));
    if (lines.size() == kAtOnce) answer_all();
  }
  if (!lines.empty()) answer_all();
  return report;
}

}  // namespace rollfix::app
