#include "documents/documents.hpp"
#include "rollfix/documents.hpp"

namespace rollfix {

Json per_finger_json(const PerFinger<double>& values) {
  return values.size() == 1 ? json_number(values[0]) : json_numbers(values);
}

Json advice_json(const std::string& verdict, const Json& of, const std::optional<Advice>& advice,
                 const std::string& why, const Json& contenders) {
  Json document = {{"schema", "rollfix/advise/1"},
                   {"verdict", verdict},
                   {"helps", advice && advice->helps},
                   {"why", why.empty() ? Json(nullptr) : Json(why)},
                   {"length", nullptr},
                   {"expected_placements", nullptr},
                   {"expected_travel", nullptr},
                   {"bits", nullptr},
                   {"bits_wanted", nullptr},
                   {"contenders", contenders},
                   {"prospects", Json::array()}};
  for (const auto& [field, value] : of.items()) document[field] = value;
  if (!advice) return document;
  if (advice->helps) document["length"] = per_finger_json(advice->lengths());
  document["expected_placements"] = json_number(advice->advised().placements);
  document["expected_travel"] = json_number(advice->advised().travel);
  document["bits"] = json_number(advice->advised().bits);
  document["bits_wanted"] = json_number(advice->bits_wanted);
  for (const Prospect& prospect : advice->prospects) {
    document["prospects"].push_back(Json::array(
        {per_finger_json(advice->lengths(prospect)), json_number(prospect.placements), json_number(prospect.bits)}));
  }
  return document;
}

Json next_roll_json(const NextRoll& next) {
  Json contenders = Json::array();
  for (const Contender& contender : next.contenders) {
    contenders.push_back({{"placement", contender.label},
                          {"contact", per_finger_json(contender.place)},
                          {"sd", per_finger_json(contender.sd)},
                          {"probability", json_number(contender.probability)},
                          {"turn", next.helps() ? json_number(next.turn_ahead(contender)) : Json(nullptr)}});
  }
  return advice_json(next.answer.verdict.text(), {{"part", part_json(next.answer.part)}}, next.advice, next.why,
                     contenders);
}

std::string format_next_pin(const HoldAnswer& held, const NextPin& next, Layout layout) {
  Json contenders = Json::array();
  for (std::size_t k = 0; k < next.contenders.size(); ++k) {
    const Contender& one = next.contenders[k];
    contenders.push_back({{"placement", one.label},
                          {"contact", per_finger_json(one.place)},
                          {"sd", per_finger_json(one.sd)},
                          {"probability", json_number(one.probability)},
                          {"length", next.helps() ? json_number(next.travels[k]) : Json(nullptr)}});
  }
  Json document = advice_json(held.verdict_text(), {{"part", part_json(held.part)}}, next.advice, next.why, contenders);
  document["pin"] = document["length"];
  document["length"] = nullptr;
  return layout == Layout::lines ? json_text(document) : json_line(document);
}

}  // namespace rollfix
