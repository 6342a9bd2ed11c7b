// From touches without rolling: every pose of the part, and beside it least squares, ICP and particles from random
// starts. How much of all poses does each find, is the true one among them, and what does it cost?

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "peers/touch_poses.hpp"
#include "program.hpp"
#include "rollfix/outline.hpp"
#include "table.hpp"
#include "touch/touch_cases.hpp"

namespace {

using namespace rollfix;

constexpr std::size_t kCases = 12;  // of a part
constexpr std::size_t kFewCases = 2;
constexpr double kPlaceShare = 1e-3;                  // of the diagonal: standard deviation of a place ...
constexpr double kNormalSd = std::numbers::pi / 180;  // ... and of a normal
constexpr double kSamePose = 2 * kPossibleSigmas;     // standard deviations: poses that move no touch by more are one

/// What is touched how often.
struct Touching {
  std::string name;
  std::size_t touches = 0;
  std::size_t normals = 0;
};

struct Question {
  Part part;
  bench::NearestPoints outline;
  std::vector<MeasuredTouch> touches;
  Pose truth;
  double place_sd = 0;

  bench::TouchQuestion asked() const { return {outline, touches, place_sd, kNormalSd}; }
  TouchProblem problem() const {
    TouchProblem problem{part, touches};
    problem.tolerance = TouchTolerance{kPossibleSigmas * place_sd, kPossibleSigmas * kNormalSd};
    problem.diagnose = false;
    return problem;
  }
};

std::vector<Part> parts() {
  std::mt19937_64 generator(7);
  return {Part(gallery("spline,n=9,seed=1,wobble=0.25")), Part(gallery("spline,n=30,seed=1,wobble=0.12")),
          Part(gallery("naca,digits=2412")), touch_cases::random_polygon(generator), touch_cases::bracket()};
}

std::vector<Question> questions(const Part& part, const Touching& mode, std::size_t count) {
  const bench::NearestPoints outline(part);
  std::mt19937_64 generator(11);
  std::vector<Question> all;
  for (std::size_t k = 0; k < count; ++k) {
    touch_cases::Making making{mode.touches, mode.normals, 0, kPlaceShare * outline.diagonal(), kNormalSd};
    const touch_cases::Case made = touch_cases::random_case(part, making, generator);
    all.push_back({part, outline, made.problem.touches, made.truth, making.place_sd});
  }
  return all;
}

using Poses = std::vector<Pose>;
using Method = std::function<Poses(const Question&)>;

std::vector<std::pair<std::string, Method>> peers() {
  const auto least_squares = [](int starts) {
    return [starts](const Question& question) { return bench::poses_by_least_squares(question.asked(), starts); };
  };
  const auto icp = [](int starts) {
    return [starts](const Question& question) { return bench::poses_by_icp(question.asked(), starts); };
  };
  const auto particles = [](int count) {
    return [count](const Question& question) { return bench::poses_by_particles(question.asked(), count); };
  };
  return {{"LSQ 10", least_squares(10)},
          {"LSQ 100", least_squares(100)},
          {"LSQ 1000", least_squares(1000)},
          {"ICP 100", icp(100)},
          {"ICP 1000", icp(1000)},
          {"particles 1e3", particles(1000)},
          {"particles 1e4", particles(10000)}};
}

/// How far a pose moves the touches from where another one has them on the part, at the most.
double apart(const Question& question, const Pose& one, const Pose& other) {
  double most = 0;
  for (const MeasuredTouch& touch : question.touches) {
    const auto seen = [&](const Pose& pose) {
      return Pose{0, 0, -pose.heading}.turned(touch.at - Vec2(pose.x, pose.y));
    };
    most = std::max(most, (seen(one) - seen(other)).norm());
  }
  return most;
}

bool is_one_of(const Question& question, const Pose& pose, const Poses& found) {
  return std::any_of(found.begin(), found.end(),
                     [&](const Pose& one) { return apart(question, pose, one) <= kSamePose * question.place_sd; });
}

/// What a method makes of all questions.
struct Record {
  std::size_t found = 0;
  std::size_t true_ones = 0;
};

/// The questions of one part and mode, and what each method found.
struct Row {
  std::string name;
  std::vector<Question> questions;
  std::vector<std::optional<TouchAnswer>> answers{};
  std::vector<std::vector<Poses>> by_peers{};  // of each method, each question's
  bench::Program::Job ours = 0;
  std::vector<bench::Program::Job> jobs{};
};

/// All poses that any method has of a question: those listed, and what is in none of their sets.
struct Union {
  std::vector<TouchPose> listed;
  Poses lost;

  Union(const Question& question, const TouchAnswer& answer, const std::vector<const Poses*>& others)
      : listed(answer.poses) {
    for (const Poses* poses : others) {
      for (const Pose& pose : *poses) {
        if (!is_listed(question, pose) && !is_one_of(question, pose, lost)) lost.push_back(pose);
      }
    }
  }

  bool is_listed(const Question& question, const Pose& pose) const {
    return std::any_of(listed.begin(), listed.end(), [&](const TouchPose& one) { return is_of(question, pose, one); });
  }
  static bool is_of(const Question& question, const Pose& pose, const TouchPose& set) {
    return touch_cases::in_extent(set, pose) || apart(question, pose, set.pose) <= kSamePose * question.place_sd;
  }
  std::size_t found_in(const Question& question, const Poses& found) const {
    std::size_t count = 0;
    for (const TouchPose& set : listed) {
      count += std::any_of(found.begin(), found.end(), [&](const Pose& pose) { return is_of(question, pose, set); });
    }
    for (const Pose& one : lost) count += is_one_of(question, one, found);
    return count;
  }
};

void add_jobs(bench::Program& program, const std::vector<std::pair<std::string, Method>>& methods, Row& row) {
  row.answers.resize(row.questions.size());
  row.by_peers.assign(methods.size(), std::vector<Poses>(row.questions.size()));
  row.ours = program.add(
      row.name,
      [&row] {
        for (std::size_t k = 0; k < row.questions.size(); ++k) row.answers[k] = solve(row.questions[k].problem());
      },
      row.questions.size());
  for (std::size_t method = 0; method < methods.size(); ++method) {
    const auto ask_all = [&row, &methods, method] {
      for (std::size_t k = 0; k < row.questions.size(); ++k) {
        row.by_peers[method][k] = methods[method].second(row.questions[k]);
      }
    };
    row.jobs.push_back(program.add(row.name + ", " + methods[method].first, ask_all, row.questions.size(), 3));
  }
}

std::string beside(const bench::Timing& time, std::size_t found, std::size_t all) {
  return fmt::format("{} ({})", bench::cell(time.median, time.median < 10 ? 1 : 0),
                     bench::share(static_cast<double>(found) / static_cast<double>(std::max<std::size_t>(all, 1))));
}

std::vector<std::string> cells(const bench::Program& program, const Row& row) {
  std::size_t all = 0;
  std::size_t lost = 0;
  std::size_t true_ones = 0;
  std::vector<std::size_t> found(row.jobs.size());
  for (std::size_t k = 0; k < row.questions.size(); ++k) {
    const Question& question = row.questions[k];
    std::vector<const Poses*> others;
    for (const std::vector<Poses>& poses : row.by_peers) others.push_back(&poses[k]);
    const Union together(question, *row.answers[k], others);
    all += together.listed.size() + together.lost.size();
    lost += together.lost.size();
    true_ones += together.is_listed(question, question.truth);
    for (std::size_t method = 0; method < found.size(); ++method) {
      found[method] += together.found_in(question, *others[method]);
    }
  }
  const bench::Timing ours = program.of(row.ours);
  std::vector<std::string> line = {row.name, std::to_string(all), bench::cell(1e3 * ours, 2)};
  for (std::size_t method = 0; method < found.size(); ++method) {
    line.push_back(beside(program.of(row.jobs[method]) / ours, found[method], all));
  }
  line.push_back(std::to_string(lost));
  line.push_back(fmt::format("{} of {}", true_ones, row.questions.size()));
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  bench::Program program(argc, argv);
  const auto methods = peers();
  std::vector<Row> rows;
  for (const Touching& mode :
       {Touching{"2 normals", 2, 2}, {"3 normals", 3, 3}, {"3 places", 3, 0}, {"4 places", 4, 0}}) {
    for (const Part& part : parts()) {
      const std::string name = part.name().substr(part.name().find(':') + 1);
      rows.push_back({fmt::format("{}, {}", name.substr(0, name.find(",seed")), mode.name),
                      questions(part, mode, program.effort(kCases, kFewCases))});
    }
  }
  for (Row& row : rows) add_jobs(program, methods, row);
  program.run();

  std::vector<std::string> header = {"touched", "poses", "solve [ms]"};
  for (const auto& [name, method] : methods) header.push_back(name);
  header.insert(header.end(), {"solve lost", "true one listed"});
  bench::Table table(header);
  for (const Row& row : rows) table.add(cells(program, row));
  table.print();
  program.write_figures();
}
