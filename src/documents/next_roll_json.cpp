#include "documents/documents.hpp"
#include "rollfix/documents.hpp"

namespace rollfix {

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

Json next_roll_json(const NextRoll& next) {
  Json hypotheses = Json::array();
  for (const Hypothesis& hypothesis : next.hypotheses) {
    hypotheses.push_back({{"placement", hypothesis.label},
                          {"contact", per_finger_json(hypothesis.place)},
                          {"sd", per_finger_json(hypothesis.sd)},
                          {"probability", json_number(hypothesis.probability)},
                          {"turn", next.helps() ? json_number(next.turn_ahead(hypothesis)) : Json(nullptr)}});
  }
  return advice_json(next.answer.verdict.text(), {{"part", part_json(next.answer.part)}}, next.advice, next.why,
                     hypotheses);
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
  return layout == Layout::lines ? json_text(document) : json_line(document);
}

}  // namespace rollfix
