#include "documents/documents.hpp"
#include "rollfix/files.hpp"
#include "rollfix/plan.hpp"

namespace rollfix {
namespace {

const char* name_of_path(PlanPath path) {
  switch (path) {
    case PlanPath::even:
      return "even";
    case PlanPath::searched:
      return "searched";
    case PlanPath::squeezed:
      return "squeezed";
  }
  return "";
}

Json margin_json(const PlanMargin& margin) {
  return {{"condition", name_of(margin.condition)},
          {"finger", margin.finger},
          {"value", json_number(margin.value)},
          {"allowed", json_number(margin.allowed)},
          {"time", json_number(margin.time)},
          {"row", margin.row},
          {"contacts", json_numbers(margin.place)},
          {"fails", margin.fails},
          {"proved", margin.proved}};
}

Json pose_of_plan(const Plan& plan, const PlanProblem& problem, bool last) {
  return pose_json(plan.roll.pose.empty() ? problem.pose : last ? plan.roll.pose.back() : plan.roll.pose.front());
}

}  // namespace

Json per_finger_json(const PerFinger<double>& values) {
  return values.size() == 1 ? json_number(values[0]) : json_numbers(values);
}

Json advice_json(const std::string& verdict, const Json& of, const std::optional<Advice>& advice,
                 const std::string& why, const Json& hypotheses) {
  Json document = {{"schema", "rollfix/advise/1"},
                   {"verdict", verdict},
                   {"helps", advice && advice->helps},
                   {"why", why.empty() ? Json(nullptr) : Json(why)},
                   {"length", nullptr},
                   {"expected_placements", nullptr},
                   {"expected_travel", nullptr},
                   {"bits", nullptr},
                   {"bits_wanted", nullptr},
                   {"contenders", hypotheses},
                   {"prospects", Json::array()}};
  for (const auto& [field, value] : of.items()) document[field] = value;
  if (!advice) return document;
  if (advice->helps) document["length"] = per_finger_json(advice->lengths());
  document["expected_placements"] = json_number(advice->advised().placements);
  document["expected_travel"] = json_number(advice->advised().travel);
  document["bits"] = json_number(advice->advised().bits);
  document["bits_wanted"] = json_number(advice->bits_wanted);
  for (const ExpectedGain& gain : advice->gains) {
    document["prospects"].push_back(
        Json::array({per_finger_json(advice->lengths(gain)), json_number(gain.placements), json_number(gain.bits)}));
  }
  return document;
}

std::string format_next_roll(const NextRoll& next, Layout layout) {
  Json hypotheses = Json::array();
  for (const Hypothesis& hypothesis : next.hypotheses) {
    hypotheses.push_back({{"placement", hypothesis.label},
                          {"contact", per_finger_json(hypothesis.place)},
                          {"sd", per_finger_json(hypothesis.sd)},
                          {"probability", json_number(hypothesis.probability)},
                          {"turn", next.helps() ? json_number(next.turn_ahead(hypothesis)) : Json(nullptr)}});
  }
  const Json document = advice_json(next.answer.verdict.text(), {{"part", part_json(next.answer.part)}}, next.advice,
                                    next.why, hypotheses);
  return formatted(document, layout);
}

std::string format_next_pin(const HoldAnswer& held, const NextPin& next, Layout layout) {
  Json hypotheses = Json::array();
  for (std::size_t k = 0; k < next.hypotheses.size(); ++k) {
    const Hypothesis& one = next.hypotheses[k];
    hypotheses.push_back({{"placement", one.label},
                          {"contact", per_finger_json(one.place)},
                          {"sd", per_finger_json(one.sd)},
                          {"probability", json_number(one.probability)},
                          {"length", next.helps() ? json_number(next.travels[k]) : Json(nullptr)}});
  }
  Json document = advice_json(held.verdict_text(), {{"part", part_json(held.part)}}, next.advice, next.why, hypotheses);
  document["pin"] = document["length"];
  document["length"] = nullptr;
  return formatted(document, layout);
}

std::string format_plan_document(const Plan& plan, const PlanProblem& problem, Layout layout) {
  const std::size_t fingers = plan.length.size();
  const Json document = {
      {"schema", "rollfix/plan/1"},
      {"status", plan.decided || plan.failure ? "complete" : "incomplete"},
      {"verdict", verdict_text(plan, problem)},
      {"feasible", plan.feasible()},
      {"failure", plan.failure ? Json(*plan.failure) : Json(nullptr)},
      {"fingers", fingers},
      {"path", name_of_path(plan.path)},
      {"press", fingers == 1 ? Json(nullptr) : Json(plan.expanding ? "apart" : "together")},
      {"duration", json_number(plan.duration)},
      {"start", json_list(plan.roll.s, [](const std::vector<double>& s) { return json_number(s.front()); })},
      {"length", json_numbers(plan.length)},
      {"rotation", json_list(plan.roll.log.fingers,
                             [](const FingerRows& rows) { return json_number(rows.psi.back() - rows.psi.front()); })},
      {"friction_needed", json_numbers(plan.friction_needed)},
      {"pose", Json::array({pose_of_plan(plan, problem, false), pose_of_plan(plan, problem, true)})},
      {"margins", json_list(plan.margins, margin_json)},
      {"unchecked", plan.unchecked}};
  return formatted(document, layout);
}

}  // namespace rollfix
