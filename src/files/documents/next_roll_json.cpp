#include "documents.hpp"

namespace rollfix {

Json next_roll_json(const NextRoll& next) {
  Json contenders = Json::array();
  for (const Contender& contender : next.contenders) {
    contenders.push_back({{"placement", contender.label},
                          {"contact", json_number(contender.place)},
                          {"sd", json_number(contender.sd)},
                          {"probability", json_number(contender.probability)},
                          {"turn", next.helps() ? json_number(next.turn_ahead(contender)) : Json(nullptr)}});
  }
  Json document = {{"schema", "rollfix/advise/1"},
                   {"verdict", next.answer.verdict.text()},
                   {"part", part_json(next.answer.part)},
                   {"helps", next.helps()},
                   {"why", next.why.empty() ? Json(nullptr) : Json(next.why)},
                   {"length", nullptr},
                   {"expected_placements", nullptr},
                   {"bits", nullptr},
                   {"bits_wanted", nullptr},
                   {"contenders", contenders},
                   {"prospects", Json::array()}};
  if (!next.advice) return document;
  const Advice& advice = *next.advice;
  if (advice.helps) document["length"] = json_number(advice.advised().length);
  document["expected_placements"] = json_number(advice.advised().placements);
  document["bits"] = json_number(advice.advised().bits);
  document["bits_wanted"] = json_number(advice.bits_wanted);
  for (const Prospect& prospect : advice.prospects) {
    document["prospects"].push_back(
        Json::array({json_number(prospect.length), json_number(prospect.placements), json_number(prospect.bits)}));
  }
  return document;
}

}  // namespace rollfix
