#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rollfix/table.hpp"
#include "rollfix/watch_writer.hpp"
#include "rollfix/weighing.hpp"

namespace rollfix::app {
namespace {

constexpr std::size_t kMostOthers = 3;  // places behind the most probable one

std::string percent(double probability) { return fixed(100 * probability, 1) + " %"; }

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

class TextWriter : public WatchWriter {
 public:
  TextWriter(const Part& part, std::ostream& out, std::ostream& err, std::function<bool()> is_ready)
      : WatchWriter(out, err, std::move(is_ready)), decimals_(std::max(0, decimals_for(part.perimeter()) - 2)) {}

  void begin(const Part& part, const WatchOptions& options) override {
    const int decimals = decimals_for(part.perimeter());
    announce(fmt::format("part  {}, {}, perimeter {}\nlog   {}\n\n", part.name(), part.closed() ? "closed" : "open",
                         fixed(part.perimeter(), decimals), options.name) +
             row("line", "time [s]", "length", "turn [deg]", "verdict",
                 fmt::format("{:>10}  {:>10}  {:>8}  {:>7}", "start", "now", "sd", "p")));
  }

  void found(const WatchAnswer& answer) override {
    write(row(answer, fmt::format("contact: roll {} begins", answer.roll), ""));
  }

  void changed(const WatchAnswer& answer) override {
    write(row(answer, answer.verdict, places(answer)));
    roll_shown_ = answer.roll;
    samples_shown_ = answer.samples;
  }

  void over(const WatchAnswer& answer, RollEnd why) override {
    if (answer.roll != roll_shown_ || answer.samples != samples_shown_) changed(answer);
    if (why == RollEnd::ended) return;
    write(row("", "", "", "", fmt::format("{}: roll {} is over", reason(why), answer.roll), ""));
  }

  void resumed(const WatchCounts& /*counts*/) override {}  // stderr said so

  void end(WatchEnd why, const WatchAnswer& last, const WatchCounts& counts) override {
    write(fmt::format("\n{}: {}\n{} in {}, {}, {}; {} us per sample\n", name_of(why), conclusion(last),
                      counted(counts.samples, "sample", "samples"), counted(counts.rolls, "roll", "rolls"),
                      counted(counts.malformed, "malformed line", "malformed lines"),
                      counted(counts.reconnects, "reconnect", "reconnects"), rough(1e6 * counts.seconds_per_sample())));
  }

 private:
  static std::string reason(RollEnd why) {
    switch (why) {
      case RollEnd::lost:
        return "contact lost";
      case RollEnd::jump:
        return "the contact jumped";
      case RollEnd::restarted:
        return "the log began anew";
      case RollEnd::ended:
        break;
    }
    return "the log ended";
  }

  static std::string row(const std::string& line, const std::string& time, const std::string& length,
                         const std::string& turn, const std::string& verdict, const std::string& text) {
    std::string all = fmt::format("{:>7}  {:>9}  {:>10}  {:>10}  {:<21}  {}", line, time, length, turn, verdict, text);
    all.erase(all.find_last_not_of(' ') + 1);
    return all + "\n";
  }

  std::string row(const WatchAnswer& answer, const std::string& verdict, const std::string& text) const {
    const Sample& sample = answer.sample;
    return row(std::to_string(sample.line), sample.time ? fixed(*sample.time, 3) : "-",
               fixed(sample.reading.length, decimals_), degrees(sample.reading.turn), verdict, text);
  }

  std::string places(const WatchAnswer& answer) const {
    if (answer.modes.empty() || answer.verdict == kInconsistent) return "";
    const Mode& best = answer.modes.front();
    std::string text = fmt::format("{:>10}  {:>10}  {:>8}  {:>7}", fixed(best.mean, decimals_),
                                   fixed(best.end_mean, decimals_), rough(best.sd), percent(best.probability));
    const std::size_t shown = std::min(answer.modes.size(), kMostOthers + 1);
    for (std::size_t i = 1; i < shown; ++i) {
      text += fmt::format("{}{} ({})", i == 1 ? "  or " : ", ", fixed(answer.modes[i].mean, decimals_),
                          percent(answer.modes[i].probability));
    }
    if (answer.modes.size() > shown) text += fmt::format(" and {} more", answer.modes.size() - shown);
    return text;
  }

  std::string conclusion(const WatchAnswer& last) const {
    if (last.roll == 0) return "no contact came";
    if (last.verdict == kInconsistent) {
      const std::string why = about(last.diagnosis);
      return last.verdict + ": nothing fits" + (why.empty() ? "" : "; " + why);
    }
    if (last.verdict != kUnique) return last.verdict;
    const Mode& only = last.modes.front();
    return fmt::format("{}: roll {} started at s = {} +- {}", last.verdict, last.roll, fixed(only.mean, decimals_),
                       rough(only.sd));
  }

  int decimals_;
  std::size_t roll_shown_ = 0;  // the last row was of this answer
  std::size_t samples_shown_ = 0;
};

}  // namespace

std::unique_ptr<WatchWriter> watch_text(const Part& part, std::ostream& out, std::ostream& err,
                                        std::function<bool()> is_ready) {
  return std::make_unique<TextWriter>(part, out, err, std::move(is_ready));
}

}  // namespace rollfix::app
