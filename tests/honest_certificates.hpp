#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <random>

#include "certificates.hpp"
#include "random.hpp"
#include "random_outlines.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"

// Certificates that the program writes of random outlines of lines and arcs.
namespace honest_certificates {

using certificates::checked;
using certificates::Json;
using random_outlines::Question;
using rollfix_verify::Verdict;

/// What came of some questions.
struct Tally {
  int proved = 0;
  int open = 0;
  int refused = 0;
  double share = 0;  // open, of all starts of all questions
};

template <class Draw, class Certify>
inline Tally tally(int count, std::uint64_t stream, const Draw& draw, const Certify& certify) {
  std::mt19937_64 generator = test_generator(stream);
  Tally result;
  for (int k = 0; k < count; ++k) {
    const Question drawn = draw(generator);
    Json certificate;
    try {
      certificate = Json::parse(certify(drawn));
    } catch (const rollfix::InputError&) {  // a roll as long as an open outline
      continue;
    }
    const Verdict verdict = checked(certificate);
    if (!verdict.refusal.empty()) {
      ++result.refused;
      ADD_FAILURE() << k << ": " << certificates::described(drawn.part, drawn.readings, drawn.tolerance) << ": "
                    << verdict.refusal;
    }
    if (verdict.refusal.empty() && !verdict.is_complete()) {
      std::printf("%d: %zu cells open, %zu kinds unproved: %s\n", k, verdict.open, verdict.unproved,
                  certificates::described(drawn.part, drawn.readings, drawn.tolerance).c_str());
    }
    result.proved += verdict.is_complete() ? 1 : 0;
    result.open += verdict.refusal.empty() && !verdict.is_complete() ? 1 : 0;
    result.share += verdict.share / count;
  }
  std::printf("proved %d, proved but for cells %d, refused %d; open %.3g %% of all starts\n", result.proved,
              result.open, result.refused, 100 * result.share);
  return result;
}

inline rollfix::LocateOptions options_of(const Question& question) {
  rollfix::LocateOptions options;
  options.tolerance = question.tolerance;
  return options;
}

inline Tally of_one_finger(int count, std::uint64_t stream) {
  return tally(count, stream, random_outlines::question, [](const Question& question) {
    return format_certificate(certify(question.part, question.readings, options_of(question)));
  });
}

inline Tally of_two_fingers(int count, std::uint64_t stream) {
  return tally(count, stream, random_outlines::question_of_two, [](const Question& question) {
    return format_certificate(certify_pair(question.part, question.readings, options_of(question)));
  });
}

}  // namespace honest_certificates
