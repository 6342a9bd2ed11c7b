// What do other methods cost where two fingers' placements are asked for, and how many of them do they find? Least
// squares from many starts, and the intersection of fitted curves.

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "outlines.hpp"
#include "pair_oracle.hpp"
#include "peers/fitted_curves.hpp"
#include "peers/least_squares.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "same_pair.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;
using bench::PairQuestion;
using bench::Pairs;

constexpr std::size_t kQuestions = 10;
constexpr std::size_t kFewQuestions = 1;
constexpr int kRepetitions = 3;
constexpr double kSamePair = 1e-6;     // of the perimeter
constexpr std::size_t kPieces = 1000;  // of each fitted curve
constexpr std::size_t kFewPieces = 250;

struct Method {
  std::string name;
  std::function<Pairs(const Part& part, const std::vector<Reading>& readings)> pairs;
};

/// One that the programs may have been built without.
struct Optional {
  const char* name;
  const char* package;
  std::optional<Pairs> (*pairs)(const Part& part, const std::vector<Reading>& readings, std::size_t pieces);
};

std::vector<Method> methods(bool is_quick) {
  std::vector<Method> all;
  for (const int starts : {10, 100, 1000}) {
    all.push_back({fmt::format("LSQ {}/W", starts), [starts](const Part& part, const std::vector<Reading>& readings) {
                     return bench::locate_by_least_squares(part, readings, starts);
                   }});
  }
  const std::size_t pieces = is_quick ? kFewPieces : kPieces;
  all.push_back(
      {fmt::format("lib2geom {}/W", pieces), [pieces](const Part& part, const std::vector<Reading>& readings) {
         return bench::locate_by_lib2geom(part, readings, pieces);
       }});
  for (const Optional& optional : {Optional{"SISL", "libsisl-dev", bench::locate_by_sisl},
                                   Optional{"OCCT", "libocct-modeling-algorithms-dev", bench::locate_by_occt}}) {
    if (!optional.pairs(bench::trusted_part(bench::families().front().outline), {{0, 0, 0}, {0, 0, 0}}, 1)) {
      fmt::print(stderr, "{} was left out: the programs were built without {}\n", optional.name, optional.package);
      continue;
    }
    all.push_back({fmt::format("{} {}/W", optional.name, pieces),
                   [pieces, optional](const Part& part, const std::vector<Reading>& readings) {
                     return optional.pairs(part, readings, pieces).value();
                   }});
  }
  return all;
}

struct Row {
  bench::Family family;
  Part part;
  std::vector<PairQuestion> questions;
  std::vector<double> recalls{};  // of each method
  std::size_t lost = 0;           // placements that only others know
  double placements = 0;
  bench::Program::Job unit = 0;
  bench::Program::Job locate = 0;
  std::vector<bench::Program::Job> jobs{};  // of each method
};

/// Whether this pair is the placement's start, or one of the others that the tolerance does not tell from it.
bool answers(const Part& part, const Placement& placement, const PerFinger<double>& pair) {
  if (bench::same_pair(part, pair, placement.start, kSamePair)) return true;
  const auto inside = [&](std::size_t finger) {
    return placement.whole_loop[finger] || part.boundary().contains(placement.extent[finger], pair[finger]);
  };
  return inside(0) && inside(1);
}

bool is_isolated(const Placement& placement) {
  return placement.kind != Kind::stretch && placement.kind != Kind::corner;
}

/// All isolated placements: the search's, and those that only the others know.
std::vector<Placement> known_placements(const Part& part, const PairQuestion& question, const Pairs& others,
                                        std::size_t& lost) {
  std::vector<Placement> all = bench::find(part, question).placements;
  for (const PerFinger<double>& pair : others) {
    const auto known = [&](const Placement& placement) { return answers(part, placement, pair); };
    if (std::any_of(all.begin(), all.end(), known)) continue;
    Placement placement;
    placement.start = pair;
    placement.extent = {Interval{pair[0], pair[0]}, Interval{pair[1], pair[1]}};
    all.push_back(placement);
    ++lost;
  }
  all.erase(std::remove_if(all.begin(), all.end(), [](const Placement& p) { return !is_isolated(p); }), all.end());
  return all;
}

/// The share of all placements that each method has. On smooth outlines those count as well that the tests' exhaustive
/// check finds.
void compare(const std::vector<Method>& all_methods, Row& row) {
  std::optional<pair_oracle::Exhaustive> oracle;
  if (row.part.corners().empty()) oracle.emplace(row.part.outline());
  std::vector<double> hits(all_methods.size());
  for (const PairQuestion& question : row.questions) {
    std::vector<Pairs> found;
    Pairs others;
    for (const Method& method : all_methods) {
      found.push_back(method.pairs(row.part, question.readings));
      others.insert(others.end(), found.back().begin(), found.back().end());
    }
    if (oracle) {
      for (const pair_oracle::Root& root : oracle->scan(question.readings).roots) others.push_back({root.s, root.t});
    }
    for (const Placement& placement : known_placements(row.part, question, others, row.lost)) {
      ++row.placements;
      for (std::size_t k = 0; k < found.size(); ++k) {
        const auto is_it = [&](const PerFinger<double>& pair) { return answers(row.part, placement, pair); };
        hits[k] += std::any_of(found[k].begin(), found[k].end(), is_it) ? 1 : 0;
      }
    }
  }
  for (const double hit : hits) row.recalls.push_back(hit / row.placements);
}

void add_jobs(bench::Program& program, const std::vector<Method>& all_methods, Row& row) {
  const std::string& name = row.family.name;
  row.unit = program.add("W " + name, [&row] { bench::keep(bench::perimeter_by_quadrature(row.family.outline)); });
  const auto locate_all = [&row] {
    for (const PairQuestion& question : row.questions) bench::keep(bench::find(row.part, question));
  };
  row.locate = program.add("locate " + name, locate_all, row.questions.size());
  for (const Method& method : all_methods) {
    const auto ask_all = [&row, &method] {
      for (const PairQuestion& question : row.questions) bench::keep(method.pairs(row.part, question.readings));
    };
    row.jobs.push_back(program.add(method.name + name, ask_all, row.questions.size(), kRepetitions));
  }
}

void print(const bench::Program& program, const std::vector<Method>& all_methods, const std::vector<Row>& rows) {
  std::vector<std::string> header = {"outline", "placements", "locate/W"};
  for (const Method& method : all_methods) header.push_back(method.name);
  header.emplace_back("locate lost");
  bench::Table table(header);
  bench::Mean ours;
  std::vector<bench::Mean> means(all_methods.size());
  std::vector<double> shares(all_methods.size());
  for (const Row& row : rows) {
    const bench::Timing unit = program.of(row.unit);
    const bench::Timing found = program.of(row.locate) / unit;
    ours.add(found);
    std::vector<std::string> line = {row.family.name, bench::cell(row.placements, 0), bench::cell(found, 1)};
    for (std::size_t k = 0; k < row.jobs.size(); ++k) {
      const bench::Timing timing = program.of(row.jobs[k]) / unit;
      line.push_back(fmt::format("{} ({})", bench::cell(timing, 0), bench::share(row.recalls[k])));
      means[k].add(timing);
      shares[k] += row.recalls[k] / static_cast<double>(rows.size());
    }
    line.push_back(std::to_string(row.lost));
    table.add(line);
  }
  std::vector<std::string> line = {"mean", "-", bench::cell(ours.value(), 1)};
  for (std::size_t k = 0; k < means.size(); ++k) {
    line.push_back(fmt::format("{} ({})", bench::cell(means[k].value(), 0), bench::share(shares[k])));
  }
  table.add(line);
  table.print();
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  const std::vector<Method> all_methods = methods(program.is_quick());
  std::vector<Row> rows;
  for (const bench::Family& family : bench::families()) {
    const Part part = bench::trusted_part(family.outline);
    if (bench::is_trivial(part)) continue;  // continua of pairs, of which no share can be told
    rows.push_back({family, part, bench::random_pair_questions(part, program.effort(kQuestions, kFewQuestions))});
  }
  for (Row& row : rows) {
    compare(all_methods, row);
    add_jobs(program, all_methods, row);
  }
  program.run();
  print(program, all_methods, rows);
  program.write_figures();
}
