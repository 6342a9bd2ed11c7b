#include "rollfix/identify.hpp"

#include "bindings.hpp"
#include "handles.hpp"
#include "rollfix/question.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

CatalogHandle open(const std::string& path) {
  const Unlocked others_may_run;
  return {std::make_shared<const Catalog>(path)};
}

/// So that what is asked of it, such as a log in millimetres, is taken in the catalog's unit.
Part in_catalogs_unit(const Catalog& catalog, const Part& part) {
  return part.unit() == catalog.unit() ? part : with_unit(part, catalog.unit());
}

PartHandle part_of(const CatalogHandle& handle, std::size_t index) {
  const Catalog& catalog = *handle.catalog;
  if (index >= catalog.size()) throw py::index_error("part");
  const Unlocked others_may_run;
  return PartHandle(in_catalogs_unit(catalog, catalog.part(index)));
}

py::list entries_of(const CatalogHandle& handle) {
  py::list result;
  for (std::size_t k = 0; k < handle.catalog->size(); ++k) {
    const CatalogEntry& one = handle.catalog->entry(k);
    result.append(py::make_tuple(one.name, one.id, one.perimeter, one.symmetry, one.closed, one.reversed, one.count));
  }
  return result;
}

py::list pairs_of(const std::vector<LeftOut>& left_out) {
  py::list result;
  for (const LeftOut& one : left_out) result.append(py::make_tuple(one.source, one.why));
  return result;
}

AnswerHandle handle_of(Answer&& answer) { return {std::make_shared<const Answer>(std::move(answer))}; }
TouchAnswerHandle handle_of(TouchAnswer&& answer) { return {std::make_shared<const TouchAnswer>(std::move(answer))}; }
std::size_t place_of(const PartFound& found) { return found.weight.part; }
std::size_t place_of(const PartTouched& found) { return found.part; }

/// The document, and the answers by the ids of their parts.
template <class Searched>
py::tuple identify_as(const Catalog& catalog, const Searched& like, unsigned threads) {
  const py::object nobody = py::none();
  IdentifyOptions options;
  options.threads = threads;
  options.go_on = [&nobody](std::size_t done) { return goes_on(nobody, done); };
  std::string document;
  decltype(identify(catalog, like, options)) found;
  {
    const Unlocked others_may_run;
    found = identify(catalog, like, options);
    document = format_identified(catalog, found, Layout::line);
    for (auto& part : found.parts) part.answer.part = in_catalogs_unit(catalog, part.answer.part);
  }
  py::list answers;
  for (auto& part : found.parts) {
    answers.append(py::make_tuple(catalog.entry(place_of(part)).id, handle_of(std::move(part.answer))));
  }
  return py::make_tuple(document, answers);
}

py::tuple identify_question(const CatalogHandle& handle, const Question& asked, unsigned threads) {
  const std::shared_ptr<const Catalog> catalog = handle.catalog;
  if (kind_of(asked) == QuestionKind::at_rest) return identify_as(*catalog, rest_problem(asked), threads);
  return identify_as(*catalog, roll_problem(asked), threads);
}

/// The document of what tells apart the parts that remain.
std::string advise_on(const CatalogHandle& handle, const Question& asked,
                      const std::optional<std::pair<double, double>>& travel) {
  const std::shared_ptr<const Catalog> catalog = handle.catalog;
  const Unlocked others_may_run;
  const Identified found = identify(*catalog, roll_problem(asked));
  const std::optional<Interval> range =
      travel ? std::optional<Interval>(Interval{travel->first, travel->second}) : std::nullopt;
  return format_next_roll(*catalog, found, next_roll(found, range), Layout::line);
}

// Argument, name, count, and what is there already.
using SourceTuple = std::tuple<std::string, std::string, double, std::optional<PartHandle>>;

std::vector<SourceTuple> sources_of(const std::string& argument) {
  const Unlocked others_may_run;
  std::vector<SourceTuple> result;
  for (const CatalogSource& one : catalog_sources(argument))
    result.emplace_back(one.argument, one.name, one.count, std::nullopt);
  return result;
}

/// What was left out, and notes.
py::tuple build(const std::string& path, const std::vector<SourceTuple>& given, const std::string& unit,
                unsigned threads, const py::object& progress) {
  std::vector<CatalogSource> sources;
  for (const auto& [argument, name, count, part] : given) {
    sources.push_back({argument, name, count, part ? std::optional<Part>(part->part()) : std::nullopt});
  }
  BuildOptions options;
  options.load.points.unit = unit;
  options.jobs = threads;
  options.go_on = [&progress](const BuildProgress& far) { return goes_on(progress, far.done); };
  BuildReport report;
  {
    const Unlocked others_may_run;
    report = build_catalog(path, sources, options);
  }
  return py::make_tuple(pairs_of(report.left_out), report.notes);
}

std::size_t take_out(const std::string& path, const std::vector<std::string>& names) {
  const Unlocked others_may_run;
  return remove_from_catalog(path, names);
}

}  // namespace

void bind_catalog(py::module_& module) {
  py::class_<CatalogHandle>(module, "Catalog")
      .def(py::init(&open))
      .def("__len__", [](const CatalogHandle& handle) { return handle.catalog->size(); })
      .def_property_readonly("path", [](const CatalogHandle& handle) { return handle.catalog->path(); })
      .def_property_readonly("unit", [](const CatalogHandle& handle) { return handle.catalog->unit(); })
      .def("entries", &entries_of)
      .def("left_out", [](const CatalogHandle& handle) { return pairs_of(handle.catalog->left_out()); })
      .def("part", &part_of)
      .def("identify", &identify_question)
      .def("advise", &advise_on);
  module.def("catalog_sources", &sources_of);
  module.def("build_catalog", &build);
  module.def("remove_from_catalog", &take_out);
}

}  // namespace rollfix::python
