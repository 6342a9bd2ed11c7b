// Which of 1,800 wing sections is it, and where on it? What an answer costs, by what is known of the roll.

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "child.hpp"
#include "outlines.hpp"
#include "program.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/rolling.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kRolls = 10;
constexpr std::size_t kFewRolls = 2;
constexpr int kRepetitions = 3;
constexpr double kRolled = 0.3;  // of the perimeter
constexpr std::size_t kReadings = 10;
constexpr std::size_t kRows = 200;
constexpr double kRadiusShare = 0.025;  // of the finger, by the perimeter

/// NACA's sections of four digits: camber 1 to 9 %, its place at 20 to 60 %, thickness 6 to 45 %.
std::vector<CatalogSource> sections(bool is_quick) {
  std::vector<CatalogSource> sources;
  for (int camber = 1; camber <= (is_quick ? 1 : 9); ++camber) {
    for (int place = 2; place <= 6; ++place) {
      for (int thickness = 6; thickness <= 45; ++thickness) {
        const std::string digits = fmt::format("{}{}{:02}", camber, place, thickness);
        sources.push_back({"gallery:naca,digits=" + digits, digits});
      }
    }
  }
  return sources;
}

/// What is known of a roll: readings with a tolerance, or a log with noise.
struct Knowledge {
  std::string name;
  double tolerance = 0;  // of readings, radians
  double contact = 0;    // noise of a log, as a share of the perimeter; 0: readings
  double angle = 0;      // likewise, radians
};
const std::vector<Knowledge> kKnowledge = {{"10 readings, exact", 1e-9},
                                           {"10 readings within 0.005 rad", 0.005},
                                           {"200 rows, contact 1e-4 P, angle 0.005 rad", 0, 1e-4, 0.005}};

Problem problem_on(const Part& part, const Knowledge& knowledge, double s, std::uint64_t seed) {
  const double P = part.perimeter();
  Problem problem{part, std::vector<Reading>{}};
  if (knowledge.contact > 0) {
    problem.fingers = {DiskFinger{kRadiusShare * P}};
    problem.noise = Noise{knowledge.contact * P, knowledge.angle};
    RollPlan plan;
    plan.start = s;
    plan.distance = kRolled * P;
    plan.rows = kRows;
    problem.measured.log = noisy_roll(part, problem.fingers[0], plan, *problem.noise, seed).log;
    return problem;
  }
  for (std::size_t k = 1; k <= kReadings; ++k) {
    const double length = kRolled * P * static_cast<double>(k) / kReadings;
    problem.measured.readings.emplace_back(length, part.turning().angle(s + length) - part.turning().angle(s));
  }
  problem.tolerance = knowledge.tolerance;
  return problem;
}

struct Asked {
  Problem problem;
  std::size_t part = 0;  // that it really was
};

struct Row {
  Knowledge knowledge;
  std::vector<Asked> questions;
  double searched = 0;    // parts that bounds leave
  double listed = 0;      // that fit
  std::size_t found = 0;  // the true part among them
  bench::Program::Job job = 0;
};

Identified ask(const Catalog& catalog, const Asked& question) {
  IdentifyOptions options;
  options.threads = 1;
  return identify(catalog, question.problem, options);
}

Row row_of(const Catalog& catalog, const Knowledge& knowledge, std::size_t rolls) {
  Row row{knowledge, {}};
  std::mt19937_64 random(7);
  while (row.questions.size() < rolls) {
    const std::size_t number = random() % catalog.size();
    const Part part = catalog.part(number);
    const double s = std::uniform_real_distribution<double>(0, part.perimeter())(random);
    try {
      row.questions.push_back({problem_on(part, knowledge, s, random()), number});
    } catch (const InputError&) {  // the finger does not fit in there
    }
  }
  for (const Asked& question : row.questions) {
    const Identified found = ask(catalog, question);
    row.searched += static_cast<double>(found.searched + found.searched_widely) / static_cast<double>(rolls);
    row.listed += static_cast<double>(found.parts.size()) / static_cast<double>(rolls);
    row.found += std::any_of(found.parts.begin(), found.parts.end(),
                             [&](const PartFound& one) { return one.weight.part == question.part; })
                     ? 1
                     : 0;
  }
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  const bench::ScratchFolder folder;
  const std::vector<CatalogSource> sources = sections(program.is_quick());
  const std::string file = folder.path("sections.db");
  build_catalog(file, sources);
  const Catalog catalog(file);
  std::vector<Row> rows;
  for (const Knowledge& knowledge : kKnowledge) {
    rows.push_back(row_of(catalog, knowledge, program.effort(kRolls, kFewRolls)));
  }
  for (Row& row : rows) {
    const auto ask_all = [&] {
      for (const Asked& question : row.questions) bench::keep(ask(catalog, question));
    };
    row.job = program.add(row.knowledge.name, ask_all, row.questions.size(), kRepetitions);
  }
  program.run();

  bench::Table table({"what is known of the roll", "[ms]", "bounds leave", "listed", "true part among them"});
  for (const Row& row : rows) {
    table.add({row.knowledge.name, bench::cell(1e3 * program.of(row.job), 2), bench::cell(row.searched, 1),
               bench::cell(row.listed, 1), fmt::format("{} of {}", row.found, row.questions.size())});
  }
  fmt::print("{} parts\n", catalog.size());
  table.print();
  program.write_figures();
}
