// What a watch prints for people, and what all that it prints goes through.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <utility>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/report.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/watch/writer.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr double kDoubtful = 0.25;  // a place with less: what is said is not more than a third as likely as what else
constexpr std::size_t kMostOthers = 3;  // places behind the most probable one

// In the order of RollEnd and of WatchEnd.
constexpr std::array kRollIsOver = {"contact lost", "the contact jumped", "the log began anew", "the log ended",
                                    "it is elsewhere now"};
constexpr std::array kWatchIsOver = {"end of input", "stopped", "nothing more came"};

std::string percent(double probability) { return fixed(100 * probability, 1) + " %"; }

class TextWriter : public WatchWriter {
 public:
  TextWriter(const Part& part, std::ostream& out, std::ostream& err, std::function<bool()> is_ready)
      : WatchWriter(out, err, std::move(is_ready)),
        decimals_(std::max(0, decimals_for(part.perimeter()) - 2)),
        unit_(plain(part.unit())) {}

  void begin(const Part& part, const WatchOptions& options) override {
    const int decimals = decimals_for(part.perimeter());
    const std::string unit = unit_.empty() ? "" : fmt::format(" {}; all lengths are in {}", unit_, unit_);
    fingers_ = options.fingers;
    noise_ = options.noise;
    catalog_ = options.catalog;
    has_wheel_ = options.wheel.has_value();
    if (catalog_) return announce_catalog(options);
    about_ = fmt::format("part  {}, {}, perimeter {}{}\nlog   {}\n\n", plain(part.name()),
                         part.closed() ? "closed" : "open", fixed(part.perimeter(), decimals), unit, names_of(options));
    announce(about_ + titles(options.name_b ? 2 : 1));
  }

  void knows_fingers(std::size_t count) override {
    if (count == 1 || has_titles_of_two_) return;
    announce((has_shown() ? "\n" : about_) + titles(count));
  }

  void announce_catalog(const WatchOptions& options) {
    const std::string unit = unit_.empty() ? "" : fmt::format("; all lengths are in {}", unit_);
    about_ = fmt::format("catalog  {}, {}{}\nlog      {}\n\n", plain(catalog_->path()),
                         counted(catalog_->size(), "part", "parts"), unit, names_of(options));
    announce(about_ + titles(options.name_b ? 2 : 1));
  }

  void begin_touches() override {
    announce((has_shown() ? "\n" : about_) + touch_row("line", "touches", "verdict", "x", "y", "heading [deg]", "p",
                                                       "next touch: from x, y, direction [deg]"));
  }

  void touched(const TouchNews& news) override {
    const TouchAnswer& answer = news.answer;
    std::vector<std::string> pose(4);
    if (!answer.poses.empty()) {
      const TouchPose& best = answer.poses.front();
      pose = {fixed(best.pose.x, decimals_), fixed(best.pose.y, decimals_),
              best.any_heading ? "any" : degrees(best.pose.heading), percent(best.probability)};
    }
    std::string next;
    if (news.next && news.next->helps) {
      const Approach& approach = news.next->advised().approach;
      next = fmt::format("{}, {}, {}", fixed(approach.from.x(), decimals_), fixed(approach.from.y(), decimals_),
                         degrees(std::remainder(approach.direction, kFullTurn)));
    } else if (news.next) {
      next = "none helps: " + news.next->why;
    }
    write(touch_row(std::to_string(news.line), std::to_string(answer.touches.size()), answer.verdict_text(), pose[0],
                    pose[1], pose[2], pose[3], next));
    touch_line_shown_ = news.line;
  }

  void no_more_touches(const TouchNews& news, RollEnd why) override {
    if (news.line != touch_line_shown_) touched(news);
    if (why != RollEnd::ended) write("the table began anew\n");
  }

  void end_touches(WatchEnd why, const std::optional<TouchNews>& last, const WatchCounts& counts) override {
    write(fmt::format("\n{}: {}{} in {}, {}\n", kWatchIsOver.at(static_cast<std::size_t>(why)),
                      last ? touches_text(last->answer, false) : "no touch came\n",
                      counted(counts.samples, "touch", "touches"), counted(counts.lines, "line", "lines"),
                      counted(counts.malformed, "malformed line", "malformed lines")));
  }

  void found(const Tracked& answer) override {
    write(row(answer, fmt::format("contact: roll {} begins", answer.roll), ""));
  }

  void changed(const Tracked& answer) override {
    write(row_of(answer));
    roll_shown_ = answer.roll;
    shown_ = row_of(answer);
  }

  void over(const Tracked& answer, RollEnd why) override {
    if (answer.roll != roll_shown_ || row_of(answer) != shown_) changed(answer);
    if (why == RollEnd::ended) return;
    write(row("", "", "", "",
              fmt::format("{}: roll {} is over", kRollIsOver.at(static_cast<std::size_t>(why)), answer.roll), ""));
  }

  void resumed(const WatchCounts& /*counts*/) override {}  // stderr said so

  void end(WatchEnd why, const Tracked& last, const WatchCounts& counts) override {
    const bool fits = last.roll > 0 && last.verdict.name != Verdict::inconsistent;
    write(fmt::format("\n{}: {}\n{}{} in {}, {}, {}; {} us per sample\n",
                      kWatchIsOver.at(static_cast<std::size_t>(why)), conclusion(last),
                      fits && !last.held ? scale_lines(last.fit, 1) : "", counted(counts.samples, "sample", "samples"),
                      counted(counts.rolls, "roll", "rolls"),
                      counted(counts.malformed, "malformed line", "malformed lines"),
                      counted(counts.reconnects, "reconnect", "reconnects"), rough(1e6 * counts.seconds_per_sample())));
  }

 private:
  static std::string touch_row(const std::string& line, const std::string& touches, const std::string& verdict,
                               const std::string& x, const std::string& y, const std::string& heading,
                               const std::string& p, const std::string& next) {
    std::string all = fmt::format("{:>7}  {:>7}  {:<34}  {:>10}  {:>10}  {:>13}  {:>7}  {}", line, touches, verdict, x,
                                  y, heading, p, next);
    all.erase(all.find_last_not_of(' ') + 1);
    return all + "\n";
  }

  static std::string row(const std::string& line, const std::string& time, const std::string& length,
                         const std::string& turn, const std::string& verdict, const std::string& text) {
    std::string all = fmt::format("{:>7}  {:>9}  {:>10}  {:>10}  {:<21}  {}", line, time, length, turn, verdict, text);
    all.erase(all.find_last_not_of(' ') + 1);
    return all + "\n";
  }

  std::string row(const Tracked& answer, const std::string& verdict, const std::string& text) const {
    const Sample& sample = answer.sample;
    return row(std::to_string(sample.line), sample.time ? fixed(*sample.time, 3) : "-",
               columns_of(sample.reading.length, 10), sample.reading.is_exact() ? degrees(sample.reading.turn) : "-",
               verdict, text);
  }

  static std::string names_of(const WatchOptions& options) {
    return plain(options.name) + (options.name_b ? " and " + plain(*options.name_b) : "");
  }

  /// What stands above the columns, of one finger or of two.
  std::string titles(std::size_t fingers) {
    const auto each = [](std::size_t count, const char* title, std::size_t width) {
      if (count == 1) return fmt::format("{:>{}}", title, width);
      return fmt::format("{:>{}}  {:>{}}", fmt::format("{} a", title), width, fmt::format("{} b", title), width);
    };
    has_titles_of_two_ = fingers == 2;
    const std::string text = catalog_ ? fmt::format("     {}  {:>8}  {}", each(fingers, "start", 10), "p", "part")
                                      : fmt::format("{}  {}  {}  {:>7}", each(fingers, "start", 10),
                                                    each(fingers, "now", 10), each(fingers, "sd", 8), "p");
    const std::size_t with_skin = has_wheel_ ? 1 : fingers;
    return row("line", "time [s]", each(with_skin, "length", 10), "turn [deg]", "verdict", text);
  }

  /// A column for each finger.
  std::string columns_of(const PerFinger<double>& lengths, std::size_t width) const {
    std::string text;
    for (const double length : lengths) {
      text += fmt::format("{}{:>{}}", text.empty() ? "" : "  ", fixed(length, decimals_), width);
    }
    return text;
  }

  /// In running text.
  std::string pair_of(const PerFinger<double>& lengths) const {
    std::string text;
    for (const double length : lengths) text += (text.empty() ? "" : " and ") + fixed(length, decimals_);
    return text;
  }

  std::string row_of(const Tracked& answer) const {
    return row(answer, verdict_of(answer), answer.parts ? parts(*answer.parts) : places(answer));
  }

  std::string places(const Tracked& answer) const {
    if (answer.modes.empty() || answer.verdict.name == Verdict::inconsistent) return "";
    const Mode& best = answer.modes.front();
    std::string sds;
    for (const double sd : best.sd) sds += fmt::format("{:>8}  ", rough(sd));
    std::string text = fmt::format("{}  {}  {}{:>7}", columns_of(best.start, 10), columns_of(best.end, 10), sds,
                                   percent(best.probability));
    const std::size_t shown = std::min(answer.modes.size(), kMostOthers + 1);
    for (std::size_t i = 1; i < shown; ++i) {
      text += fmt::format("{}{} ({})", i == 1 ? "  or " : ", ", pair_of(answer.modes[i].start),
                          percent(answer.modes[i].probability));
    }
    if (answer.modes.size() > shown) text += fmt::format(" and {} more", answer.modes.size() - shown);
    return text;
  }

  /// The likeliest part with its likeliest place, and others.
  std::string parts(const Identified& found) const {
    std::string text;
    for (std::size_t k = 0; k < std::min(found.parts.size(), kMostOthers + 1); ++k) {
      const PartFound& one = found.parts[k];
      const std::string name = plain(catalog_->entry(one.weight.part).name);
      text += k > 0 ? fmt::format("{}{} ({})", k == 1 ? " or " : ", ", name, percent(one.probability))
                    : fmt::format("     {}  {:>8}  {}", columns_of(one.answer.placements.front().start, 10),
                                  percent(one.probability), name);
    }
    if (found.parts.size() > kMostOthers + 1) text += fmt::format(" and {} more", found.parts.size() - kMostOthers - 1);
    return text;
  }

  std::string conclusion_of_parts(const Tracked& last) const {
    if (last.parts->parts.empty()) return last.parts->verdict;
    const PartFound& best = last.parts->parts.front();
    return fmt::format("{}: roll {} was on {}, from s = {}{}, with probability {}", last.parts->verdict, last.roll,
                       plain(catalog_->entry(best.weight.part).name), pair_of(best.answer.placements.front().start),
                       behind(unit_), fixed(best.probability, 4));
  }

  std::string conclusion(const Tracked& last) const {
    if (last.roll == 0) return "no contact came";
    if (last.parts) return conclusion_of_parts(last);
    if (last.held) {
      std::string text = hold_text(*last.held);
      text.pop_back();  // its last line's end
      return text;
    }
    if (last.verdict.name == Verdict::inconsistent && last.impossible > 0) {
      return fmt::format("{}: {} would fit, but the finger{} can't be there{}{}", last.verdict.text(),
                         counted(last.impossible, "place", "places"), last.sample.reading.fingers() == 1 ? "" : "s",
                         last.sample.reading.fingers() == 1
                             ? ""
                             : ", or would overlap; of fingers at different heights say --may-overlap",
                         why(last));
    }
    if (last.verdict.name == Verdict::inconsistent) return last.verdict.text() + ": nothing fits" + why(last);
    if (last.verdict.name != Verdict::unique) return last.verdict.text() + why(last);
    if (last.modes.empty()) return last.verdict.text() + ": nothing that fits is within the finger's reach";
    const Mode& only = last.modes.front();
    const bool is_doubted = !last.diagnoses.empty() && only.probability < kDoubtful;
    return fmt::format("{}: {}roll {} started at {}{}{}", last.verdict.text(),
                       is_doubted ? "if all is as stated, " : "", last.roll, place_of(only),
                       is_doubted ? ", but what follows is likelier" : "", why(last));
  }

  std::string place_of(const Mode& mode) const {
    const auto of = [&](std::size_t k) {
      return fmt::format("s = {} ± {}{}", fixed(mode.start[k], decimals_), rough(mode.sd[k]), behind(unit_));
    };
    return mode.start.size() == 1 ? of(0) : fmt::format("{} (finger a) and {} (finger b)", of(0), of(1));
  }

  /// Where its rows fit badly: what explains them, and the cure.
  std::string why(const Tracked& last) const {
    if (last.diagnoses.empty()) return "";
    const Diagnosis& likeliest = last.diagnoses.front();
    return fmt::format("\nlikeliest: {}\n  {}", about(likeliest), cure_of(likeliest, fingers_, noise_));
  }

  int decimals_;
  std::vector<Finger> fingers_;  // and the noise, as given: cures name them
  Noise noise_;
  std::string unit_;  // the part's, or the catalog's
  std::shared_ptr<const Catalog> catalog_;
  std::string about_;  // the part and the log
  bool has_titles_of_two_ = false;
  bool has_wheel_ = false;            // finger b is one without skin
  std::size_t touch_line_shown_ = 0;  // the last row was of this line's touch
  std::size_t roll_shown_ = 0;        // the last row was of this roll
  std::string shown_;                 // that row
};

}  // namespace

std::optional<std::size_t> NoteLimit::allow(std::chrono::steady_clock::time_point now) {
  // Every interval that has passed makes room for one more note.
  while (told_ > 0 && now - last_ >= kOneMoreEvery) {
    --told_;
    last_ += kOneMoreEvery;
  }
  if (told_ >= kAtOnce) {
    ++left_out_;
    return std::nullopt;
  }
  if (told_ == 0) last_ = now;
  ++told_;
  return std::exchange(left_out_, 0);
}

WatchWriter::WatchWriter(std::ostream& out, std::ostream& err, std::function<bool()> is_ready)
    : out_(out), err_(err), is_ready_(std::move(is_ready)) {}

void WatchWriter::note(const std::string& message) {
  const std::optional<std::size_t> left_out = limit_.allow(std::chrono::steady_clock::now());
  if (!left_out) return;
  if (*left_out > 0) err_ << fmt::format("rollfix: ... {} such lines were left out here\n", *left_out);
  err_ << "rollfix: " << plain(with_options(message)) << std::endl;
}

void WatchWriter::write(const std::string& lines) {
  out_ << std::exchange(announced_, "") << lines << std::flush;
  if (!out_) throw InputError("standard output can't be written to");
}

void WatchWriter::show() {
  if (!announced_.empty()) write("");
}

std::unique_ptr<WatchWriter> watch_text(const Part& part, std::ostream& out, std::ostream& err,
                                        std::function<bool()> is_ready) {
  return std::make_unique<TextWriter>(part, out, err, std::move(is_ready));
}

}  // namespace rollfix::app
