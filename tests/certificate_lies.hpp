#pragma once

#include <gtest/gtest.h>

#include <exception>
#include <random>
#include <string>
#include <vector>

#include "certificates.hpp"
#include "liar.hpp"
#include "pair_liar.hpp"
#include "random.hpp"
#include "random_outlines.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"
#include "told_lies.hpp"

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

/// Of question number k.
inline auto expect_unproved(int k, const random_outlines::Question& drawn) {
  return [k, &drawn](const Json& lie, const std::string& name) {
    EXPECT_FALSE(is_proved(lie)) << k << ": " << name << ", "
                                 << certificates::described(drawn.part, drawn.readings, drawn.tolerance);
  };
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
    told_lies::tell_each(liar::Liar::all(), truth, generator, told, expect_unproved(k, drawn), drawn);
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
    told_lies::tell_each(pair_liar::all(), truth, generator, told, expect_unproved(k, drawn), drawn.part);
  }
  return told;
}

}  // namespace certificate_lies
