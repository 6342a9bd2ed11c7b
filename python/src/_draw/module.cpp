#include "handles.hpp"
#include "rollfix/draw.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::python {

template <>
inline constexpr bool kIsPythonClass<Svg> = true;

namespace {

Svg answer_figure(const AnswerHandle& handle, const std::optional<LogHandle>& log,
                  const std::optional<std::size_t>& highlight, const std::string& title, double width) {
  AnswerFigure figure{handle.answer.get()};
  figure.highlight = highlight;
  figure.title = title;
  figure.width = width;
  if (log && !handle.answer->mirrored) figure.log = log->log.get();
  return draw_answer(figure);
}

Svg part_figure(const PartHandle& handle, const py::object& reach, const std::string& title, double width) {
  const Part part = handle.part();
  PartFigure figure{&part, title, width};
  if (!reach.is_none()) figure.reach = reach.cast<Reach>();
  return draw_part(figure);
}

Svg next_roll_figure(const NextRollHandle& handle) {
  const NextRoll& next = *handle.next;
  if (!next.advice) throw InputError("advice: nothing is drawn: " + next.why);
  return draw_advice({*next.advice, next.answer.part.name(), next.answer.verdict.text()});
}

Svg touch_figure(const TouchAnswerHandle& handle, const std::string& title, double width) {
  TouchFigure figure{handle.answer.get()};
  figure.title = title;
  if (width > 0) figure.width = width;
  return draw_touches(figure);
}

Svg hold_figure(const HoldAnswerHandle& handle, const std::string& title, double width) {
  HoldFigure figure{handle.answer.get()};
  figure.title = title;
  if (width > 0) figure.width = width;
  return draw_hold(figure);
}

Svg plan_figure(const PlanHandle& handle, const std::string& title, double width) {
  PlanFigure figure{handle.plan.get(), handle.problem.get()};
  figure.title = title;
  if (width > 0) figure.width = width;
  return draw_plan(figure);
}

}  // namespace
}  // namespace rollfix::python

PYBIND11_MODULE(_draw, module) {
  using namespace rollfix::python;
  using rollfix::Svg;
  module.doc() = "The figures of rollfix. Use `save` and `to_svg` of what is to be drawn.";
  py::module_::import("rollfix._core");
  py::class_<Svg>(module, "Figure")
      .def("svg", &Svg::str)
      .def(
          "save",
          [](const Svg& figure, const std::string& file, const std::string& besides) {
            rollfix::figure_format(file, besides);  // refuses other endings, in words that say what else there is
            rollfix::save_figure(figure, file);
          },
          py::arg("file"), py::arg("besides") = "");
  module.def("answer_figure", &answer_figure);
  module.def("part_figure", &part_figure);
  module.def("next_roll_figure", &next_roll_figure);
  module.def("touch_figure", &touch_figure);
  module.def("hold_figure", &hold_figure);
  module.def("plan_figure", &plan_figure);
  let_be_pickled(module);
}
