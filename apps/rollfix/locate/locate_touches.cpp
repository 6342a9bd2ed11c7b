#include "rollfix/locate/locate_touches.hpp"

#include <utility>

#include "rollfix/draw/touch_figure.hpp"
#include "rollfix/files/touch_document.hpp"
#include "rollfix/locate/certificate.hpp"
#include "rollfix/locate/touch_arguments.hpp"
#include "rollfix/output/touch_text.hpp"

namespace rollfix::app {

void require_outputs(const TouchOutput& output) {
  require_figure_output(output.figure, output.json);
  require_certificate(output.certificate, output.figure.force, output.json, output.figure.file);
}

Report report_of(const TouchProblem& problem, std::vector<Outline> others, const TouchOutput& output, Report report) {
  const TouchAnswer answer = solve(problem);
  report.exit_code = exit_code_of(answer);
  report.data = output.json ? format_touches(answer) : touches_text(answer, output.verbose);
  if (!output.figure.file.empty()) {
    TouchFigure figure{&answer};
    figure.others = std::move(others);
    add_figure(output.figure, draw_touches(figure), report);
  }
  if (!output.certificate.empty()) {
    add_certificate(output.certificate, output.figure.force, problem, answer, report);
  }
  return report;
}

Report locate_touches(const std::vector<std::string>& touches, const RollArguments& arguments,
                      const TouchOutput& output) {
  require_outputs(output);
  Report report;
  std::vector<Outline> others;
  const TouchProblem problem = read_touch_problem(touches, arguments, report.notes, &others);
  return report_of(problem, std::move(others), output, std::move(report));
}

}  // namespace rollfix::app
