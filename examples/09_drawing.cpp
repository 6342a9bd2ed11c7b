// A drawing in, a figure out: my part is a DXF, and I want a picture of the answer.
//
//   c++ -std=c++20 examples/09_drawing.cpp $(pkg-config --cflags --libs rollfix-files rollfix-draw) -o draw && ./draw
#include <cstdio>
#include <rollfix/draw.hpp>
#include <rollfix/files.hpp>
#include <rollfix/rollfix.hpp>
#include <string>

using namespace rollfix;

int main() {
  LoadOptions options;
  options.loop = 1;  // the largest; without it a note says what else there is
  const LoadedPart loaded = load_part("examples/bracket.dxf", options);
  for (const std::string& note : loaded.notes) std::printf("%s\n", note.c_str());
  for (std::size_t k = 0; k < loaded.loops.size(); ++k) {
    const Loop& loop = loaded.loops[k];
    std::printf("loop %zu: %s, %.2f %s long%s\n", k + 1, loop.outline.hole ? "hole" : "outer", loop.length,
                loaded.unit.c_str(), k + 1 == loaded.loop ? "  <- taken" : "");
  }

  Problem problem{loaded.part, Reading(30, 1.0)};  // 30 mm over a bend
  problem.tolerance = 1e-3;
  const Answer answer = solve(problem);
  std::printf("%s\n", answer.verdict.text().c_str());
  save_figure(draw_answer(answer), "bracket.svg");
  std::printf("wrote bracket.svg\n");
}
