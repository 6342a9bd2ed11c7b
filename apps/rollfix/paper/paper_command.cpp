#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "rollfix/output/table.hpp"
#include "rollfix/paper/claim.hpp"
#include "rollfix/program.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kPaperExamples = R"(Examples:
  rollfix paper           # the table, in some seconds: everything in it is computed now
  rollfix paper --json    # the same with all numbers
)";

constexpr const char* kNoteOnPairs =
    "An odd number of pairs can't be all: on a closed part without corners the crossings are even in number.\n"
    "docs/two_fingers.md shows why, and docs/march.md which pairs the printed order of moves loses.\n";

/// In the paper's order.
std::vector<Claim> all_claims() {
  std::vector<Claim> claims;
  add_one_finger_claims(claims);
  add_two_finger_claims(claims);
  const auto figure = [](const Claim& claim) { return claim.where.rfind("Figure", 0) == 0; };
  std::stable_sort(claims.begin(), claims.end(), [&](const Claim& one, const Claim& other) {
    if (figure(one) != figure(other)) return !figure(one);
    return figure(one) && one.where < other.where;
  });
  return claims;
}

std::string paper_text(const std::vector<Claim>& claims) {
  Table table;
  for (const char* title : {"", "the paper says", "we get", "agrees"}) table.add_column(title, Table::Align::left);
  for (const Claim& claim : claims) table.add_row({claim.where, claim.says, claim.get, claim.agrees ? "yes" : "no"});
  return table.str() + '\n' + kNoteOnPairs;
}

std::string paper_json(const std::vector<Claim>& claims) {
  Json rows = Json::array();
  for (const Claim& claim : claims) {
    rows.push_back({{"where", claim.where},
                    {"says", claim.says},
                    {"get", claim.get},
                    {"agrees", claim.agrees},
                    {"figures", claim.figures}});
  }
  return json_text({{"schema", "rollfix/paper/1"}, {"claims", rows}});
}

}  // namespace

void add_paper_command(CLI::App& program, Command& chosen) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand(
      "paper", "What the paper says that this program starts from, and what we get: counted steps, rates, figures.");
  command->footer(kPaperExamples);
  add_switch(*command, "--json", *json, "print JSON (rollfix/paper/1)");
  command->callback([json, &chosen] {
    chosen = [json] {
      const std::vector<Claim> claims = all_claims();
      Report report;
      report.data = *json ? paper_json(claims) : paper_text(claims);
      return report;
    };
  });
}

}  // namespace rollfix::app
