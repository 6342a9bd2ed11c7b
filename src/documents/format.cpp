#include "rollfix/documents.hpp"

#include "documents/documents.hpp"

namespace rollfix {
namespace {

std::string laid_out(const Json& document, Layout layout) {
  return layout == Layout::lines ? json_text(document) : json_line(document);
}

}  // namespace

std::string format_answer(const Answer& answer, Layout layout, bool explain) {
  return laid_out(answer_json(answer, explain), layout);
}

std::string format_inspection(const Inspection& inspection, const LoadedPart& loaded, Layout layout) {
  Json document = inspection_json(inspection);
  document["loops"] = loops_json(loaded);
  return laid_out(document, layout);
}

std::string format_next_roll(const NextRoll& next, Layout layout) { return laid_out(next_roll_json(next), layout); }

std::string format_taught(const Inspection& inspection, const Taught& taught, Layout layout) {
  Json document = inspection_json(inspection);
  document["schema"] = "rollfix/teach/1";
  document["taught"] = taught_json(taught);
  return laid_out(document, layout);
}

}  // namespace rollfix
