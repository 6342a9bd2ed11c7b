#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "documents/json_output.hpp"
#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/program.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kCatalogExamples = R"(Examples:
  rollfix catalog build sections/ -o parts.db --unit mm   # every outline in a folder and the folders in it
  rollfix catalog build more.txt -o parts.db              # add those that a list names, a file in each line
  rollfix catalog list parts.db
  rollfix catalog remove parts.db naca2412.dat
)";

struct BuildArguments {
  std::vector<std::string> sources;
  std::string catalog;
  std::string jobs;
  PartArgument part;
  bool json = false;
};

struct ListArguments {
  std::string catalog;
  std::vector<std::string> names;
  bool json = false;
};

/// How far a build is, with a bar.
std::string progress_text(const BuildProgress& progress, double seconds) {
  constexpr std::size_t kBar = 30;
  const double share =
      static_cast<double>(progress.done) / static_cast<double>(std::max<std::size_t>(1, progress.sources));
  const auto filled = static_cast<std::size_t>(share * kBar);
  return fmt::format("[{:#<{}}{:.<{}}] {} of {} files, {} parts, {:.0f} s", "", filled, "", kBar - filled,
                     progress.done, progress.sources, progress.parts, seconds);
}

std::string left_out_table(const std::vector<LeftOut>& all) {
  if (all.empty()) return "";
  Table table;
  table.add_column("left out", Table::Align::left);
  table.add_column("why", Table::Align::left);
  for (const LeftOut& one : all) table.add_row({one.source, with_options(one.why)});
  return "\n" + table.str();
}

Json left_out_json(const std::vector<LeftOut>& all) {
  Json list = Json::array();
  for (const LeftOut& one : all) list.push_back({{"name", one.source}, {"why", with_options(one.why)}});
  return list;
}

/// "a.dat: TEXT", or where several say the same of their files "1,129 files: TEXT".
std::vector<std::string> gathered(const std::vector<std::string>& notes) {
  std::vector<std::string> texts;  // in the order in which they come first
  std::map<std::string, std::vector<std::string>> notes_of;
  for (const std::string& note : notes) {
    const std::size_t colon = note.find(": ");
    const std::string text = colon == std::string::npos ? note : note.substr(colon + 2);
    if (notes_of[text].empty()) texts.push_back(text);
    notes_of[text].push_back(note);
  }
  std::vector<std::string> lines;
  for (const std::string& text : texts) {
    const std::vector<std::string>& same = notes_of[text];
    lines.push_back(same.size() == 1 ? same.front() : fmt::format("{} files: {}", same.size(), text));
  }
  return lines;
}

BuildOptions read_options(const BuildArguments& arguments) {
  BuildOptions options;
  options.load = read_load_options(arguments.part);
  if (!arguments.jobs.empty()) options.jobs = static_cast<unsigned>(read_count(arguments.jobs, "--jobs", 1));
  return options;
}

Report build_report(const BuildArguments& arguments) {
  if (arguments.sources.empty()) {
    throw InputError("catalog build: expected a folder of outlines, or a list of them, found nothing");
  }
  if (arguments.catalog.empty()) throw InputError("catalog build: expected the catalog's file: -o parts.db");
  std::vector<CatalogSource> sources;
  for (const std::string& argument : arguments.sources) {
    for (CatalogSource& source : catalog_sources(argument)) sources.push_back(std::move(source));
  }
  BuildOptions options = read_options(arguments);
  BuildReport built;
  {
    ProgressLine line;
    options.go_on = [&](const BuildProgress& progress) {
      if (line.is_shown()) line.show(progress_text(progress, line.seconds()));
      return true;
    };
    built = build_catalog(arguments.catalog, sources, options);
  }
  const Catalog catalog(arguments.catalog);
  const std::vector<LeftOut> left_out = catalog.left_out();
  Report report;
  report.notes = gathered(built.notes);
  report.notes_first = true;
  if (arguments.json) {
    report.data = json_text({{"schema", "rollfix/catalog/1"},
                             {"file", arguments.catalog},
                             {"unit", catalog.unit().empty() ? Json(nullptr) : Json(catalog.unit())},
                             {"parts", catalog.size()},
                             {"added", built.added},
                             {"unchanged", built.unchanged},
                             {"replaced", built.replaced},
                             {"left_out", left_out_json(left_out)}});
  } else {
    report.data =
        fmt::format("{}: {}; {} added from {}, {} unchanged, {} read again, {} left out\n", plain(arguments.catalog),
                    counted(catalog.size(), "part", "parts"), built.added, counted(sources.size(), "file", "files"),
                    built.unchanged, built.replaced, left_out.size()) +
        left_out_table(left_out);
  }
  if (catalog.size() == 0) report.exit_code = ExitCode::bad_input;
  return report;
}

Report list_report(const ListArguments& arguments) {
  const Catalog catalog(arguments.catalog);
  const std::vector<LeftOut> left_out = catalog.left_out();
  Report report;
  if (arguments.json) {
    Json parts = Json::array();
    for (std::size_t k = 0; k < catalog.size(); ++k) {
      const CatalogEntry& entry = catalog.entry(k);
      parts.push_back({{"name", entry.name},
                       {"id", entry.id},
                       {"source", catalog.source_of(k)},
                       {"perimeter", json_number(entry.perimeter)},
                       {"closed", entry.closed},
                       {"reversed", entry.reversed},
                       {"symmetry", entry.symmetry},
                       {"count", json_number(entry.count)}});
    }
    report.data = json_text({{"schema", "rollfix/catalog/1"},
                             {"file", arguments.catalog},
                             {"unit", catalog.unit().empty() ? Json(nullptr) : Json(catalog.unit())},
                             {"parts", parts},
                             {"left_out", left_out_json(left_out)}});
    return report;
  }
  Table table;
  table.add_column("part", Table::Align::left);
  table.add_column(title_in("perimeter", catalog.unit()));
  table.add_column("symmetry");
  table.add_column("count");
  for (std::size_t k = 0; k < catalog.size(); ++k) {
    const CatalogEntry& entry = catalog.entry(k);
    table.add_row({entry.name, fixed(entry.perimeter, decimals_for(entry.perimeter)),
                   entry.symmetry == 0 ? "circle" : fmt::format("{}", entry.symmetry),
                   fmt::format("{:g}", entry.count)});
  }
  report.data = fmt::format("{}: {}\n\n", plain(arguments.catalog), counted(catalog.size(), "part", "parts")) +
                table.str() + left_out_table(left_out);
  return report;
}

Report remove_report(const ListArguments& arguments) {
  if (arguments.names.empty()) throw InputError("catalog remove: expected the names of parts, found none");
  const std::size_t removed = remove_from_catalog(arguments.catalog, arguments.names);
  Report report;
  report.data = fmt::format("{}: {} taken out\n", plain(arguments.catalog), counted(removed, "part", "parts"));
  return report;
}

void add_build(CLI::App& catalog, Command& chosen) {
  const auto arguments = std::make_shared<BuildArguments>();
  CLI::App* command = catalog.add_subcommand(
      "build",
      "Makes a catalog of outlines, or adds to one; what is there already and has not changed is not read again.");
  command->add_option("DIR|LIST", arguments->sources,
                      "a folder of outlines; a text file with one of them in each line, behind a tabulator how many of "
                      "it there are; or an outline");
  command->add_option("-o", arguments->catalog, "the catalog, an SQLite file")->type_name("FILE");
  command->add_option("--jobs", arguments->jobs, "threads; default as many as there are processors")->type_name("N");
  add_load_arguments(*command, arguments->part);
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/catalog/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return build_report(*arguments); }; });
}

void add_list(CLI::App& catalog, Command& chosen) {
  const auto arguments = std::make_shared<ListArguments>();
  CLI::App* command = catalog.add_subcommand("list", "The parts of a catalog, and what was left out of it.");
  command->add_option("CATALOG", arguments->catalog, "the catalog")->required();
  add_switch(*command, "--json", arguments->json, "print JSON (rollfix/catalog/1)");
  command->callback([arguments, &chosen] { chosen = [arguments] { return list_report(*arguments); }; });
}

void add_remove(CLI::App& catalog, Command& chosen) {
  const auto arguments = std::make_shared<ListArguments>();
  CLI::App* command = catalog.add_subcommand("remove", "Takes parts out of a catalog, by name.");
  command->add_option("CATALOG", arguments->catalog, "the catalog")->required();
  command->add_option("NAME", arguments->names, "parts, as list names them");
  command->callback([arguments, &chosen] { chosen = [arguments] { return remove_report(*arguments); }; });
}

}  // namespace

void add_catalog_command(CLI::App& program, Command& chosen) {
  CLI::App* command = program.add_subcommand("catalog", "Many parts in one file, for identify: build, list, remove.");
  command->footer(kCatalogExamples);
  command->require_subcommand(0, 1);
  add_build(*command, chosen);
  add_list(*command, chosen);
  add_remove(*command, chosen);
  command->callback([command] {
    if (command->get_subcommands().empty())
      throw InputError("catalog: expected build, list or remove; see rollfix catalog --help");
  });
}

}  // namespace rollfix::app
