// What do all placements of two fingers cost, of two readings and of one with the facing, in units of W: one
// integration of the same outline's perimeter? And on lines and arcs, of a smooth outline's with as many placements?

#include <cmath>
#include <string>
#include <vector>

#include "outlines.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "table.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kQuestions = 50;
constexpr int kFewRepetitions = 5;  // a go at all questions of a hard outline takes a third of a second

struct Row {
  bench::Family family;
  Part part;
  std::vector<bench::PairQuestion> questions;
  bench::Program::Job unit = 0;
  bench::Program::Job locate = 0;
  bench::Program::Job facing = 0;
  double placements = 0;  // per question
  double boxes = 0;       // per question
  int incomplete = 0;     // questions
};

Row row_of(const bench::Family& family) {
  const Part part = bench::trusted_part(family.outline);
  Row row{family, part, bench::random_pair_questions(part, kQuestions)};
  for (const bench::PairQuestion& question : row.questions) {
    const Search search = bench::find(part, question);
    row.placements += static_cast<double>(search.placements.size()) / kQuestions;
    row.boxes += static_cast<double>(search.counts.intervals) / kQuestions;
    row.incomplete += search.status == Status::complete ? 0 : 1;
  }
  return row;
}

template <class Question>
bench::Program::Job add_job(bench::Program& program, const std::string& name, const Row& row, const Question& ask) {
  const auto ask_all = [&row, ask] {
    for (const bench::PairQuestion& question : row.questions) bench::keep(ask(row.part, question));
  };
  return program.add(name + " " + row.family.name, ask_all, kQuestions, kFewRepetitions);
}

/// The smooth outline with about as many placements.
const Row& smooth_like(const std::vector<Row>& rows, const Row& straight) {
  const Row* best = nullptr;
  double least = 0;
  for (const Row& row : rows) {
    const double apart = std::abs(std::log(row.placements / straight.placements));
    if (bench::is_trivial(row.part) || (best != nullptr && apart >= least)) continue;
    best = &row;
    least = apart;
  }
  return *best;
}

/// Of lines and arcs W says nothing: they are compared with smooth outlines.
void compare_with_smooth(bench::Program& program, const std::vector<Row>& rows) {
  bench::Table table({"lines and arcs", "placements", "smooth", "placements of it", "locate of its"});
  bench::Timing most;
  for (const Row& row : rows) {
    if (!bench::is_trivial(row.part)) continue;
    const Row& smooth = smooth_like(rows, row);
    const bench::Timing times = program.of(row.locate) / program.of(smooth.locate);
    if (!(times.median <= most.median)) most = times;  // the first one, too
    table.add({row.family.name, bench::cell(row.placements, 1), smooth.family.name, bench::cell(smooth.placements, 1),
               bench::cell(times, 2)});
  }
  table.print();
  program.figure("lines_and_arcs_times", most);
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  std::vector<Row> rows;
  for (const bench::Family& family : bench::families()) rows.push_back(row_of(family));
  for (Row& row : rows) {
    row.unit = program.add("W " + row.family.name,
                           [&row] { bench::keep(bench::perimeter_by_quadrature(row.family.outline)); });
    row.locate = add_job(program, "locate", row, bench::find);
    row.facing = add_job(program, "facing", row, bench::find_with_facing);
  }
  program.run();

  bench::Mean found;
  bench::Mean facing;
  bench::Table table({"outline", "W [us]", "locate/W", "each/W", "facing/W", "placements", "boxes"});
  const auto add = [&](const Row& row) {
    const bench::Timing unit = program.of(row.unit);
    const bench::Timing in_locate = program.of(row.locate) / unit;
    const bench::Timing in_facing = program.of(row.facing) / unit;
    table.add({row.family.name, bench::cell(1e6 * unit, 2), bench::cell(in_locate, 1),
               bench::cell(in_locate.median / row.placements, 2), bench::cell(in_facing, 1),
               bench::cell(row.placements, 1), bench::cell(row.boxes, 0)});
    if (row.incomplete > 0) table.add({"incomplete: " + std::to_string(row.incomplete)});
    if (row.family.name == "polygon") program.figure("hexagon_ms", 1e3 * program.of(row.locate));
    if (!row.family.is_gallery || bench::is_trivial(row.part)) return;
    found.add(in_locate);
    facing.add(in_facing);
  };
  for (const Row& row : rows) {
    if (!bench::is_trivial(row.part)) add(row);
  }
  table.add({"gallery, mean", "-", bench::cell(found.value(), 1), "-", bench::cell(facing.value(), 1)});
  table.add({"lines and arcs alone, whose W is next to nothing; the polygon is a regular hexagon:"});
  for (const Row& row : rows) {
    if (bench::is_trivial(row.part)) add(row);
  }
  table.print();
  compare_with_smooth(program, rows);
  program.figure("two_fingers_W", found.value());
  program.figure("facing_W", facing.value());
  program.write_figures();
}
