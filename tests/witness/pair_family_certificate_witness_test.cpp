// Certificates of equal rolls by the dozen, on splines, plates with corners, lines and arcs: none is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "certificates.hpp"
#include "random.hpp"
#include "random_outlines.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"

namespace pair_family_certificate_witness_test {
namespace {

using certificates::checked;
using certificates::Json;
using certificates::uniform;

rollfix::Part any_part(std::mt19937_64& generator) {
  if (uniform(generator, 0, 1) < 0.4) return certificates::random_spline(generator);
  for (;;) {
    if (const std::optional<rollfix::Part> drawn = random_outlines::outline(generator)) return *drawn;
  }
}

TEST(PairFamilyCertificateWitness, of_equal_rolls_is_not_refused) {
  std::mt19937_64 generator = test_generator();
  const int count = test_count(6);
  int proved = 0;
  int open = 0;
  std::size_t families = 0;
  for (int k = 0; k < count; ++k) {
    const rollfix::Part part = any_part(generator);
    const double most = (part.closed() ? 1.0 : 0.4) * part.perimeter();
    const double a = uniform(generator, -most, most);
    const double b = uniform(generator, -most, most);
    rollfix::LocateOptions options;
    options.tolerance = std::pow(10, uniform(generator, -11, -3));
    std::vector<rollfix::Reading> readings = {{a, a, 0.0}};
    if (uniform(generator, 0, 1) < 0.7) readings.push_back({b, b, 0.0});
    if (readings.size() == 1 || uniform(generator, 0, 1) < 0.2) options.facing = 0.0;
    Json found;
    try {
      found = Json::parse(format_certificate(certify_pair(part, readings, options)));
    } catch (const rollfix::InputError&) {  // a roll as long as an open outline
      continue;
    }
    const certificates::Verdict verdict = checked(found);
    EXPECT_EQ(verdict.refusal, "") << k << ": " << certificates::described(part, readings, options.tolerance);
    if (verdict.open + verdict.unproved > 0) {
      std::printf("%d: %zu cells open, %zu kinds unproved, %zu families: %s\n", k, verdict.open, verdict.unproved,
                  verdict.families, certificates::described(part, readings, options.tolerance).c_str());
    }
    proved += verdict.is_complete() ? 1 : 0;
    open += verdict.refusal.empty() && !verdict.is_complete() ? 1 : 0;
    families += verdict.families;
  }
  std::printf("proved %d, proved but for cells %d, %zu families\n", proved, open, families);
  EXPECT_GE(proved, count / 3);
}

}  // namespace
}  // namespace pair_family_certificate_witness_test
