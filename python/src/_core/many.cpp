#include "rollfix/solve.hpp"

#include <ctime>

#include "bindings.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

/// Problem k of an (n, m, 2) or (n, m, 3) array.
class ManyReadings {
 public:
  ManyReadings(const Numbers& rows, const std::optional<Numbers>& facing, bool clockwise)
      : first_(rows.data()),
        readings_(static_cast<std::size_t>(rows.shape(1))),
        numbers_(static_cast<std::size_t>(rows.shape(2))),
        facing_(facing ? facing->data() : nullptr),
        sign_(clockwise ? -1 : 1) {}

  void make(std::size_t k, Problem& problem) const {
    std::vector<Reading>& readings = problem.measured.readings;
    readings.resize(readings_);
    const double* row = first_ + k * readings_ * numbers_;
    for (Reading& reading : readings) {
      reading = numbers_ == 3 ? Reading(sign_ * row[0], sign_ * row[1], row[2]) : Reading(sign_ * row[0], row[1]);
      row += numbers_;
    }
    if (facing_ != nullptr) problem.facing = facing_[k];
  }
  std::size_t fingers() const { return numbers_ - 1; }

 private:
  const double* first_;
  std::size_t readings_;
  std::size_t numbers_;
  const double* facing_;
  double sign_;
};

ManyOptions many_options(unsigned threads, const py::object& progress) {
  ManyOptions options;
  options.threads = threads;
  options.go_on = [progress](std::size_t done) { return goes_on(progress, done); };
  return options;
}

template <class T>
py::array_t<T> rows(std::vector<T>& values, std::vector<py::ssize_t> shape) {
  return array_of(std::move(values), std::move(shape));
}

py::dict dict_of(AnswerTable table) {
  const auto placements = static_cast<py::ssize_t>(table.kind.size());
  const auto fingers = static_cast<py::ssize_t>(table.fingers);
  py::dict errors;
  for (const auto& [k, message] : table.errors) errors[py::int_(k)] = message;
  py::dict result;
  result["fingers"] = table.fingers;
  result["errors"] = errors;
  result["offsets"] = array_of(std::move(table.offsets));
  result["status"] = array_of(std::move(table.status));
  result["verdict"] = array_of(std::move(table.verdict));
  result["tolerance"] = array_of(std::move(table.tolerance));
  result["kind"] = array_of(std::move(table.kind));
  result["start"] = rows(table.start, {placements, fingers});
  result["end"] = rows(table.end, {placements, fingers});
  result["extent"] = rows(table.extent, {placements, fingers, 2});
  result["point"] = rows(table.point, {placements, fingers, 2});
  result["tangent"] = rows(table.tangent, {placements, fingers});
  result["error"] = array_of(std::move(table.error));
  result["residual"] = array_of(std::move(table.residual));
  result["probability"] = array_of(std::move(table.probability));
  result["whole_loop"] = array_of(std::move(table.whole_loop));
  return result;
}

/// `like`: with any readings, as many as each problem has.
py::dict solve_many(const Question& like, const Numbers& rows, const std::optional<Numbers>& facing, unsigned threads,
                    const py::object& progress) {
  const ManyReadings readings(rows, facing, like.direction == Direction::clockwise);
  const auto count = static_cast<std::size_t>(rows.shape(0));
  const ManyOptions options = many_options(threads, progress);
  AnswerTable table;
  {
    const Unlocked others_may_run;
    table = solve_table(
        roll_problem(like), count, [&](std::size_t k, Problem& problem) { readings.make(k, problem); },
        readings.fingers(), options);
  }
  return dict_of(std::move(table));
}

/// Questions that differ in more than their readings: logs, noise, fingers. Each answer whole, or its error.
py::list solve_questions(const std::vector<Question>& questions, unsigned threads, const py::object& progress) {
  const ManyOptions options = many_options(threads, progress);
  std::vector<Outcome> outcomes;
  {
    const Unlocked others_may_run;
    outcomes = solve(questions, options);
  }
  py::list result;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    if (outcomes[k].solution) {
      result.append(handle_of(std::move(*outcomes[k].solution), questions[k]));
    } else {
      result.append(outcomes[k].error);
    }
  }
  return result;
}

/// Seconds of processor time that C++ takes for the same: one problem of each row after the other, or all as a table.
double seconds_of_rows(const PartHandle& handle, const Numbers& rows, bool as_table) {
  const Part part = handle.part();
  const auto count = static_cast<std::size_t>(rows.shape(0));
  const auto reading = [&](std::size_t k) { return Reading(rows.data()[2 * k], rows.data()[2 * k + 1]); };
  const Unlocked others_may_run;
  const std::clock_t start = std::clock();
  if (as_table) {
    ManyOptions options;
    options.threads = 1;
    solve_table(
        {part, Reading()}, count, [&](std::size_t k, Problem& problem) { problem.measured.readings[0] = reading(k); },
        1, options);
  } else {
    for (std::size_t k = 0; k < count; ++k) solve({part, reading(k)});
  }
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace

void bind_many(py::module_& module) {
  module.def("solve_many", &solve_many);
  module.def("seconds_of_rows", &seconds_of_rows);  // for bench/python.py
  module.def("solve_questions", &solve_questions);
}

}  // namespace rollfix::python
