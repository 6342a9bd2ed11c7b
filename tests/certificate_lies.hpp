#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <exception>
#include <optional>
#include <random>
#include <vector>

#include "certificates.hpp"
#include "liar.hpp"
#include "pair_liar.hpp"
#include "random.hpp"
#include "random_outlines.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"

// Every kind of lie about random questions.
namespace certificate_lies {

using certificates::Json;

inline bool is_proved(const Json& certificate) {
  try {
    return certificates::checked(certificate).is_complete();
  } catch (const std::exception&) {  // it is no certificate
    return false;
  }
}

/// How often each kind was told; none of them may be proved.
inline std::vector<int> tell(int questions, std::mt19937_64& generator) {
  std::vector<int> told(liar::Liar::all().size(), 0);
  for (int k = 0; k < questions; ++k) {
    const random_outlines::Question drawn = random_outlines::question(generator);
    Json truth;
    try {
      truth = certificates::certificate(drawn.part, drawn.readings, drawn.tolerance);
    } catch (const rollfix::InputError&) {  // a roll as long as an open outline
      continue;
    }
    liar::Liar liar(drawn, truth, generator);
    for (std::size_t i = 0; i < told.size(); ++i) {
      const liar::Liar::Lie& lie = liar::Liar::all()[i];
      const std::optional<Json> document = liar.told(lie);
      if (!document) continue;
      ++told[i];
      EXPECT_FALSE(is_proved(*document)) << k << ": " << lie.name << ", "
                                         << certificates::described(drawn.part, drawn.readings, drawn.tolerance);
    }
  }
  return told;
}

/// The same of two fingers.
inline std::vector<int> tell_of_two(int questions, std::mt19937_64& generator) {
  std::vector<int> told(pair_liar::all().size(), 0);
  for (int k = 0; k < questions; ++k) {
    const random_outlines::Question drawn = random_outlines::question_of_two(generator);
    Json truth;
    try {
      rollfix::LocateOptions options;
      options.tolerance = drawn.tolerance;
      truth = Json::parse(format_certificate(certify_pair(drawn.part, drawn.readings, options)));
    } catch (const rollfix::InputError&) {  // a roll as long as an open outline
      continue;
    }
    for (std::size_t i = 0; i < told.size(); ++i) {
      const pair_liar::Lie& lie = pair_liar::all()[i];
      Json json = truth;
      pair_liar::Document document{drawn.part, json, generator};
      if (!lie.tell(document)) continue;
      ++told[i];
      EXPECT_FALSE(is_proved(json)) << k << ": " << lie.name << ", "
                                    << certificates::described(drawn.part, drawn.readings, drawn.tolerance);
    }
  }
  return told;
}

}  // namespace certificate_lies
