// What script/instructions counts: a fixed set of queries, each by its name. Instructions repeat where clocks do not.
//   instructions         the names
//   instructions NAME    that query, twice: what is counted is the second time, within measured_query

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "logs.hpp"
#include "outlines.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/files.hpp"
#include "rollfix/log.hpp"
#include "rollfix/outline.hpp"

/// By its name valgrind knows what to count.
extern "C" [[gnu::noinline]] void measured_query(const std::function<void()>& query) { query(); }

namespace {

using namespace rollfix;

constexpr std::size_t kReadings = 20;
constexpr std::size_t kPairQuestions = 5;

/// Makes what a query needs, and gives the query.
using Preparation = std::function<std::function<void()>()>;

Outline outline_of(const std::string& name) {
  if (name == "wing") return bench::wing_through_points(160);
  if (name == "egg") return bench::egg_through_points(2000);
  return gallery(name);
}

Preparation one_finger(const std::string& name) {
  return [name] {
    const Part part = bench::trusted_part(outline_of(name));
    return [part, readings = bench::random_readings(part, kReadings)] {
      for (const Reading& reading : readings) bench::keep(locate(part, reading));
    };
  };
}

Preparation two_fingers(const std::string& name, Search (*ask)(const Part&, const bench::PairQuestion&)) {
  return [name, ask] {
    const Part part = bench::trusted_part(outline_of(name));
    return [part, ask, questions = bench::random_pair_questions(part, kPairQuestions)] {
      for (const bench::PairQuestion& question : questions) bench::keep(ask(part, question));
    };
  };
}

Preparation build(const std::string& name) {
  return [name] { return [outline = outline_of(name)] { bench::keep(Part(outline)); }; };
}

std::function<void()> one_roll() {
  const Part part = bench::trusted_part(outline_of("spline"));
  return [part, readings = bench::readings_of_one_roll(part, 64)] { bench::keep(locate(part, readings)); };
}

std::function<void()> load() {
  return [text = format_part(Part(outline_of("spline")))] { bench::keep(parse_part(text, "spline")); };
}

std::function<void()> read_log() {
  std::string text = "time,u,psi\n";
  for (int k = 0; k < 10000; ++k) text += fmt::format("{},{:.17g},{:.17g}\n", 0.01 * k, -0.001 * k, 0.0007 * k);
  return [text] { bench::keep(parse_log(text, "long.csv")); };
}

Preparation posterior(const std::string& name) {
  return [name] {
    const Part part(outline_of(name));
    return [part, log = bench::noisy_logs(part, 1).front()] {
      BeliefOptions options;
      options.noise = bench::log_noise(part);
      Belief belief(part, LogKind::contact, options);
      for (const Sample& sample : log.samples) belief.add(sample);
      bench::keep(belief.modes());
    };
  };
}

struct Query {
  std::string name;
  Preparation prepare;
};

std::vector<Query> queries() {
  std::vector<Query> all;
  for (const char* name : {"ellipse", "spline", "gear", "polygon", "wing", "egg"}) {
    all.push_back({fmt::format("one_finger_{}", name), one_finger(name)});
  }
  all.push_back({"one_finger_64_readings", one_roll});
  for (const char* name : {"ellipse", "spline", "polygon", "wing"}) {
    all.push_back({fmt::format("two_fingers_{}", name), two_fingers(name, bench::find)});
    all.push_back({fmt::format("facing_{}", name), two_fingers(name, bench::find_with_facing)});
  }
  for (const char* name : {"spline", "gear", "wing"}) all.push_back({fmt::format("build_{}", name), build(name)});
  all.push_back({"load_spline", load});
  all.push_back({"read_log", read_log});
  for (const char* name : {"limacon", "spline"}) all.push_back({fmt::format("posterior_{}", name), posterior(name)});
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  for (const Query& query : queries()) {
    if (argc < 2) fmt::print("{}\n", query.name);
    if (argc < 2 || query.name != argv[1]) continue;
    const std::function<void()> ask = query.prepare();
    ask();
    measured_query(ask);
    return 0;
  }
  return argc < 2 ? 0 : 2;
}
