#include "rollfix/locate/locate_command.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "documents/documents.hpp"
#include "files/json/fields.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/program.hpp"
#include "rollfix/question.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

/// The part that a name means.
using PartOf = std::function<Part(const std::string& name)>;

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
  if (value.contains("pivot")) {
    throw InputError(fmt::format(
        "\"readings\": expected a reading whose turn is known, found one on a corner of the finger, {}: give the log",
        value.dump()));
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

/// [x, y], [x, y, normal], {"at": [x, y], "normal": ...} as in the answer, or "X,Y,NORMAL" as typed; null: not
/// measured.
std::string typed_touch(const Json& value) {
  const auto field = [](const Json& one) { return one.is_null() ? "" : typed(one, "touches"); };
  if (value.is_string()) return value.get<std::string>();
  std::string text;
  if (value.is_array()) {
    for (std::size_t k = 0; k < value.size(); ++k) text += (k == 0 ? "" : ",") + field(value[k]);
    return text;
  }
  if (!value.is_object() || !value.contains("at")) {
    throw InputError(fmt::format("\"touches\": expected [x, y] or [x, y, normal] of each, found {}", value.dump()));
  }
  text = value["at"].is_null() ? "," : typed_list(value["at"], "touches");
  for (const char* name : {"normal", "position_sd", "normal_sd"}) {
    text += "," + (value.contains(name) ? field(value[name]) : "");
  }
  return text;
}

/// [[x, y, x, y], ...], or "rows".
std::vector<std::string> typed_clear(const Json& value) {
  if (value.is_string()) return {value.get<std::string>()};
  if (!value.is_array()) throw InputError("\"clear\": expected a list of [x, y, x, y], found " + value.dump());
  std::vector<std::string> texts;
  for (const Json& path : value) texts.push_back(typed_list(path, "clear"));
  return texts;
}

/// [[x, y], ...].
std::vector<std::string> typed_touches(const Json& value) {
  if (!value.is_array()) throw InputError("\"touches\": expected a list of them, found " + value.dump());
  std::vector<std::string> texts;
  for (const Json& touch : value) texts.push_back(typed_touch(touch));
  return texts;
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
constexpr std::array<Field, 20> kFields = {{
    {"readings", [](const Json& value, RollArguments& to) { to.readings = typed_readings(value); }},
    {"log", [](const Json& value, RollArguments& to) { to.logs = typed_each(value, "log"); }},
    {"clear", [](const Json& value, RollArguments& to) { to.clear = typed_clear(value); }},
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
  std::vector<std::string> names = {"part", "id", "touches"};
  for (const Field& field : kFields) names.emplace_back(field.name);
  throw InputError(fmt::format("there is no field \"{}\"; {}", name, known_names(name, names)));
}

/// The question of a JSON object: docs/json.md, "A batch of problems". `like` holds what the object does not say. What
/// the user should know is added to the notes. Throws InputError: a field that is not known, or not what it should be,
/// and what `read_question` throws.
Question question_from_json(const Json& object, const RollArguments& like, const PartOf& part_of,
                            std::vector<std::string>& notes) {
  RollArguments arguments = like;
  std::vector<std::string> touches;
  for (const auto& [name, value] : object.items()) {
    if (name == "id") continue;
    if (name == "part") {
      arguments.part.part = typed(value, name);
    } else if (name == "touches") {
      if (!value.is_null()) touches = typed_touches(value);
    } else {
      set_field(name, value, arguments);
    }
  }
  const bool has_contacts = !arguments.logs.empty() || !touches.empty();
  if (arguments.readings.empty() != has_contacts) {
    throw InputError("expected one of \"readings\", \"log\" and \"touches\"");
  }
  return read_question(touches, arguments, part_of(arguments.part.part), notes);
}

// Problems that are held at once: enough for all cores, and little memory.
constexpr std::size_t kAtOnce = 1024;

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
  std::string where;  // file and line
  Json id{};          // null: it has none
  std::optional<Question> question{};
  std::vector<std::string> notes{};
  std::string error{};
};

BatchLine read_line(const std::string& text, const std::string& where, const RollArguments& like, Parts& parts) {
  BatchLine line{where};
  try {
    const auto watch = [](int depth, Json::parse_event_t /*event*/, const Json& /*value*/) {
      if (depth <= kMostNesting) return true;
      throw InputError(fmt::format("expected a problem, found values nested more than {} deep", kMostNesting));
    };
    const Json object = Json::parse(text, watch);
    if (!object.is_object()) throw InputError("expected a problem, a JSON object, found " + shown(text));
    if (object.contains("id")) line.id = object["id"];
    line.question = question_from_json(
        object, like, [&](const std::string& name) { return parts.of(name); }, line.notes);
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

/// The outcomes of the lines that ask something, in order, on all cores.
std::vector<Outcome> outcomes_of(const std::vector<BatchLine>& lines) {
  std::vector<Question> questions;
  for (const BatchLine& line : lines) {
    if (line.question) questions.push_back(*line.question);
  }
  return solve(std::span<const Question>(questions));
}

/// Of a line's answer, or of why there is none.
Json document_of(const BatchLine& line, const Outcome& outcome, bool explain) {
  Json document;
  if (outcome.solution) {
    document = solution_document(*outcome.solution, explain);
  } else {
    const std::string error =
        line.question ? fmt::format("{}: {}", line.where, with_options(outcome.error)) : line.error;
    document = {{"schema", "rollfix/locate/1"}, {"error", error}};
  }
  if (!line.id.is_null()) document["id"] = line.id;
  for (const std::string& note : line.notes) document["notes"].push_back(with_options(note));
  return document;
}

/// Writes the answers; the exit code of the worst.
ExitCode answer_lines(const std::vector<BatchLine>& lines, bool explain, std::ostream& out) {
  const std::vector<Outcome> outcomes = outcomes_of(lines);
  ExitCode worst = ExitCode::fits;
  std::size_t next = 0;
  for (const BatchLine& line : lines) {
    const Outcome outcome = line.question ? outcomes[next++] : Outcome{};
    out << json_line(document_of(line, outcome, explain));
    worst = worse_of(worst, outcome.solution ? exit_code_of(*outcome.solution) : ExitCode::bad_input);
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
    report.exit_code = worse_of(report.exit_code, answer_lines(lines, explain, out));
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
