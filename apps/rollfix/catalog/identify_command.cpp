#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/arguments/catalog_argument.hpp"
#include "rollfix/arguments/output_argument.hpp"
#include "rollfix/arguments/roll_arguments.hpp"
#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/catalog/catalog.hpp"
#include "rollfix/catalog/documents.hpp"
#include "rollfix/catalog/identify.hpp"
#include "rollfix/catalog/identify_text.hpp"
#include "rollfix/commands.hpp"
#include "rollfix/draw/parts_figure.hpp"
#include "rollfix/error.hpp"
#include "rollfix/usage.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kIdentifyExamples = R"(Examples:
  rollfix catalog build sections/ -o parts.db
  rollfix identify parts.db --log roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg
  rollfix identify parts.db --reading 60.1,5.12deg --reading 120,18.39deg --json
  rollfix identify parts.db --log roll.csv --finger disk,r=10 --noise contact=0.05,angle=0.2deg -o which.svg
On several machines, each with a copy of the catalog, and then on one:
  rollfix identify parts.db --log roll.csv --finger disk,r=10 --shard 1/2 > 1.jsonl
  rollfix identify parts.db --log roll.csv --finger disk,r=10 --shard 2/2 > 2.jsonl
  rollfix identify parts.db --merge 1.jsonl --merge 2.jsonl
)";

struct IdentifyArguments {
  std::string catalog;
  RollArguments roll;
  std::string shard;
  std::vector<std::string> merge;
  std::string jobs;
  bool without_index = false;
  bool json = false;
  OutputArgument output;
};

/// "2/7".
void read_shard(const std::string& text, IdentifyOptions& options) {
  if (text.empty()) return;
  const std::vector<std::string_view> fields = split(text, '/');
  const std::string what = "--shard " + text;
  if (fields.size() != 2) throw InputError(what + ": expected which shard of how many, as in 1/4");
  options.shard = read_count(std::string(fields[0]), what, 1);
  options.shards = read_count(std::string(fields[1]), what, 1);
  if (options.shard > options.shards) throw InputError(what + ": expected a number of one of them, from 1 on");
}

/// What is asked of every part.
Problem read_question(const IdentifyArguments& arguments, const Catalog& catalog, std::vector<std::string>& notes) {
  const RollArguments& roll = arguments.roll;
  if (roll.readings.empty() && roll.logs.empty()) {
    throw InputError("identify: expected --reading LENGTH,TURN or --log FILE, found neither");
  }
  if (!roll.readings.empty() && !roll.logs.empty()) {
    throw InputError("identify: expected --reading or --log, found both: they can't be of the same roll");
  }
  require_no_prior(roll.prior);
  return read_problem(roll, any_part_of(catalog), notes);
}

Report of_document(const std::string& text, const IdentifyArguments& arguments, const Catalog& catalog, Report report) {
  const Json document = Json::parse(text);
  report.exit_code = exit_code_of(document);
  report.data = arguments.json ? text : identify_text(document, catalog.unit());
  return report;
}

Report merged(const IdentifyArguments& arguments, const Catalog& catalog) {
  if (!arguments.roll.readings.empty() || !arguments.roll.logs.empty() || !arguments.shard.empty()) {
    throw InputError("--merge joins what was found: leave --reading, --log and --shard out");
  }
  std::vector<std::string> texts;
  for (const std::string& file : arguments.merge) texts.push_back(read_text(file));
  return of_document(merge_shards(catalog, texts, arguments.merge), arguments, catalog, {});
}

/// A figure shows what the search itself found: a file of a shard has no outlines.
void require_no_shards(const IdentifyArguments& arguments) {
  if (arguments.output.file.empty()) return;
  const char* other = !arguments.merge.empty() ? "--merge" : !arguments.shard.empty() ? "--shard" : nullptr;
  if (other == nullptr) return;
  throw InputError(fmt::format("-o: a figure needs the whole search, which {} is not: leave one out", other));
}

Svg figure_of(const Identified& found, const Catalog& catalog) {
  PartsFigure figure;
  figure.verdict = found.verdict;
  figure.of = found.asked;
  figure.rest = found.rest;
  for (const PartFound& part : found.parts) {
    PartsFigure::Entry entry{catalog.entry(part.weight.part).name, part.probability, &part.answer};
    for (const std::size_t other : part.congruent) entry.congruent.push_back(catalog.entry(other).name);
    figure.parts.push_back(std::move(entry));
  }
  return draw_parts(figure);
}

Report identify_report(const IdentifyArguments& arguments) {
  if (arguments.catalog.empty()) throw InputError("identify: expected a CATALOG: rollfix catalog build makes one");
  require_no_shards(arguments);
  require_figure_output(arguments.output, arguments.json);
  const Catalog catalog(arguments.catalog);
  if (!arguments.merge.empty()) return merged(arguments, catalog);
  IdentifyOptions options;
  read_shard(arguments.shard, options);
  options.use_index = !arguments.without_index;
  if (!arguments.jobs.empty()) options.threads = static_cast<unsigned>(read_count(arguments.jobs, "--jobs", 1));
  Report report;
  const Problem question = read_question(arguments, catalog, report.notes);
  const Identified found = identify(catalog, question, options);
  if (!arguments.shard.empty()) {
    report.data = format_shard(catalog, found, options);
    return report;
  }
  report = of_document(format_identified(catalog, found), arguments, catalog, std::move(report));
  if (!arguments.output.file.empty()) add_figure(arguments.output, figure_of(found, catalog), report);
  return report;
}

}  // namespace

void add_identify_command(CLI::App& program, Command& chosen) {
  const auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command = program.add_subcommand(
      "identify", "Which parts of a catalog a roll fits, and where on each it can have started.");
  command->footer(kIdentifyExamples);
  command->add_option("CATALOG", arguments->catalog, "as catalog build makes it");
  add_felt_arguments(*command, arguments->roll, true);
  command
      ->add_option("--at", arguments->roll.instants,
                   "instants of the log to use, seconds; default all rows, as far as their digits or the noise tell")
      ->type_name("T1,T2,...");
  command
      ->add_option(
          "--facing", arguments->roll.facing,
          "how far finger a's contact normal is turned from finger b's at the first contacts; then one reading "
          "of two fingers suffices")
      ->type_name("ANGLE");
  command->add_option("--budget", arguments->roll.budget, "intervals to look at on a part before giving up")
      ->type_name("N");
  command
      ->add_option("--shard", arguments->shard,
                   "search only one of so many shares of the parts and print JSON lines, for --merge")
      ->type_name("K/N");
  command->add_option("--merge", arguments->merge, "join what was found in shards, a file of each; again and again")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--jobs", arguments->jobs, "threads; default as many as there are processors")->type_name("N");
  add_switch(*command, "--without-index", arguments->without_index,
             "search every part: slow, and for whoever doubts that the bounds lose nothing");
  add_output_argument(*command, arguments->output,
                      "a figure of the parts that remain: .svg, .png or .pdf, - for SVG on stdout");
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/identify/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return identify_report(*arguments); }; });
}

}  // namespace rollfix::app
