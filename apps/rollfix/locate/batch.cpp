#include "rollfix/locate/batch.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <ostream>
#include <span>
#include <string_view>
#include <vector>

#include "documents/documents.hpp"
#include "files/json/fields.hpp"
#include "rollfix/documents.hpp"
#include "rollfix/error.hpp"
#include "rollfix/locate/question_json.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/option_names.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

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
    document = Json::parse(format_solution(*outcome.solution, Layout::line, explain));
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
