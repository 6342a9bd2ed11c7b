#include "rollfix/tracker.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "log/mirrored.hpp"
#include "rollfix/error.hpp"
#include "rollfix/turning_function.hpp"
#include "watch/rolls.hpp"

// The door: numbers and lines to the rolls that they are rows of, and what is worth telling of an answer to somebody
// who knows the one before.
namespace rollfix {
namespace {

constexpr double kOtherProbability = 0.1;  // a smaller change of a probability is no news
constexpr double kTwiceAsSure = 0.5;       // the new standard deviation, as a share of the old one

/// How far two places are apart along the boundary, the shorter way round a closed one.
double distance_on(const Part& part, double a, double b) {
  return part.closed() ? periodic_distance(a, b, part.perimeter()) : std::abs(a - b);
}

/// The same of each finger; that of the one that is farther off.
double distance_on(const Part& part, const PerFinger<double>& a, const PerFinger<double>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, distance_on(part, a[k], b[k]));
  return most;
}

/// Of several places that were known the one that this is, or is nearest to: so that two places which change ranks are
/// no news. REQUIRES that there is one.
const Mode& nearest_to(const Mode& mode, const std::vector<Mode>& known, const Part& part) {
  return *std::min_element(known.begin(), known.end(), [&](const Mode& a, const Mode& b) {
    return distance_on(part, a.mean, mode.mean) < distance_on(part, b.mean, mode.mean);
  });
}

/// Another probability, another place by more than its standard deviation, or one that is known twice as well.
bool is_news_of_a_place(const Mode& said, const Mode& now, const Part& part) {
  if (std::abs(now.probability - said.probability) > kOtherProbability) return true;
  // Of either finger.
  for (std::size_t k = 0; k < now.mean.size(); ++k) {
    if (distance_on(part, said.mean[k], now.mean[k]) > said.sd[k] || now.sd[k] < kTwiceAsSure * said.sd[k]) return true;
  }
  return false;
}

/// Throws InputError: what is not taken of a finger beside a wheel, before any row comes.
void require_of_wheel(const Followed& followed) {
  const TrackOptions& options = followed.options;
  // Without noise of its place a pin's rows would have no weight.
  if (!(followed.noise.position > 0)) {
    throw InputError(
        "`noise`: expected position=SD beside a wheel, found none: all that a wheel says is where its pin was");
  }
  const auto refuse = [](bool given, const char* name) {
    if (given) throw InputError(fmt::format("`{}` is not taken beside a wheel; leave it out", name));
  };
  refuse(options.prior.has_value(), "prior");
  refuse(options.pose.has_value(), "pose");
  refuse(options.robust, "robust");
}

/// Beside a wheel there are two logs: the second one gets a name.
Followed with_names(Followed followed) {
  TrackOptions& options = followed.options;
  if (options.wheel && !options.name_b) options.name_b = "the pin's log";
  return followed;
}

/// What makes the meaning of each roll: beside a wheel, or on the part.
MakeMeaning meaning_of(const Followed& followed) {
  if (followed.options.wheel) return [followed](LogKind /*kind*/) { return meaning_beside_wheel(followed); };
  return [followed](LogKind kind) { return meaning_on_part(followed, kind); };
}

/// Throws InputError: this finger is not taken of a part that lies face down.
void require_mirrored(const Finger& finger, const Followed& followed) {
  if (finger.outline() != nullptr && !finger.outline()->closed()) {
    throw InputError(
        fmt::format("`mirror`: the outline of the finger {} is open, which watch does not turn over: expected a closed "
                    "one, a disk or a jaw; locate takes it",
                    finger.name()));
  }
  if (finger.is_jaw() && (followed.options.pose || followed.noise.position > 0)) {
    throw InputError(
        "`mirror`: watch does not ask where a jaw has a part that lies face down: leave out `heading`, `pose` and "
        "`noise` position, or ask locate");
  }
}

}  // namespace

bool is_news(const Tracked& said, const Tracked& now, const Part& part) {
  // Another verdict, or places where there were none before, or none any more.
  if (now.verdict != said.verdict || now.modes.empty() != said.modes.empty()) return true;
  if (now.modes.empty() || now.verdict.name == Verdict::inconsistent) return false;  // no place that is worth telling
  // Only the most probable place is compared, with the one nearest to it that was known.
  const Mode& best = now.modes.front();
  return is_news_of_a_place(nearest_to(best, said.modes, part), best, part);
}

Followed as_mirrored(Followed followed) {
  TrackOptions& options = followed.options;
  // Beside a wheel `solve` mirrors the whole problem.
  if (!options.mirrored || options.wheel) return followed;
  // Fingers as the mirror shows them; the part stays as it was drawn.
  for (Finger& finger : followed.fingers) {
    require_mirrored(finger, followed);
    finger = mirrored(finger);
  }
  // Only once: from here on the log is read as the mirror shows it.
  options.mirrored = false;
  options.log.mirrored = true;
  return followed;
}

Tracker::State::State(const Followed& followed, MakeMeaning make)
    : stream(followed.options.name, followed.part, followed.fingers, followed.noise, followed.options.log,
             followed.options.robust),
      rolls(followed, std::move(make)) {
  const auto& [part, fingers, noise, options] = followed;
  if (options.wheel) require_of_wheel(followed);
  if (options.name_b) {
    two.emplace(std::array{options.name, *options.name_b}, part, fingers, noise, options.log, options.robust,
                options.wheel.has_value());
  }
}

/// Why a row was left out is a message; what it means is the rolls' business.
std::vector<Tracked> Tracker::State::take(const LogLine& row, LogKind kind) {
  if (!row.message.empty()) messages.push_back(row.message);
  return rolls.push(row, kind);
}

/// The stream for rows of numbers, with the messages of the push before cleared.
LogStream& Tracker::State::numbers() {
  messages.clear();
  if (!two) return stream;
  throw InputError(fmt::format(
      "{} and {}: expected the lines of two logs, found a row of numbers; of two fingers with skin leave `name_b` out",
      two->name(0), two->name(1)));
}

Tracker::Tracker(std::unique_ptr<State> state) : state_(std::move(state)) {}

/// Mirrored first: streams and meanings all take the mirrored fingers and log.
Tracker::Tracker(const Part& part, std::vector<Finger> fingers, const Noise& noise, TrackOptions options) {
  const Followed followed = with_names(as_mirrored({part, std::move(fingers), noise, std::move(options)}));
  state_ = std::make_unique<State>(followed, meaning_of(followed));
}

Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

std::vector<Tracked> Tracker::push(std::optional<double> time, double u, double psi, std::optional<double> x,
                                   std::optional<double> y) {
  return push(time, Touch{u, psi, x, y});
}

std::vector<Tracked> Tracker::push(std::optional<double> time, const PerFinger<Touch>& fingers) {
  LogStream& stream = state_->numbers();
  return state_->take(stream.push(time, fingers), stream.kind());
}

std::vector<Tracked> Tracker::push_off(std::optional<double> time) {
  LogStream& stream = state_->numbers();
  return state_->take(stream.push_off(time), stream.kind());
}

std::vector<Tracked> Tracker::push(std::string_view line, std::size_t which) {
  // One line of one log is one row.
  if (!state_->two) return push(state_->stream.push(line), state_->stream.kind());
  state_->messages.clear();
  std::vector<Tracked> told;
  // A line can complete several pairs, or none.
  for (const LogLine& row : state_->two->push(which, line)) {
    for (Tracked& now : state_->take(row, state_->two->kind())) told.push_back(std::move(now));
  }
  return told;
}

std::vector<Tracked> Tracker::push(const LogLine& row, LogKind kind) {
  state_->messages.clear();
  return state_->take(row, kind);
}

const std::vector<std::string>& Tracker::messages() const { return state_->messages; }

void Tracker::resume(std::size_t which) { state_->two ? state_->two->resume(which) : state_->stream.resume(); }

bool Tracker::is_ahead(std::size_t which) const { return state_->two && state_->two->is_ahead(which); }

std::vector<Tracked> Tracker::finish(RollEnd why) { return state_->rolls.finish(why); }

const Tracked& Tracker::now() { return state_->rolls.now(); }

const Tracked& Tracker::last() const { return state_->rolls.last(); }

bool Tracker::is_behind() const { return state_->rolls.is_behind(); }

std::vector<Tracked> Tracker::catch_up() { return state_->rolls.catch_up(); }

}  // namespace rollfix
