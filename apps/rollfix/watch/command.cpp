#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/program.hpp"
#include "rollfix/touch.hpp"
#include "rollfix/watch/source.hpp"
#include "rollfix/watch/watching.hpp"
#include "rollfix/watch/writer.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kExamples =
    "A finger rolls, or two, the log grows, and this says where it is as soon as that changes. The log is "
    "read from a pipe, "
    "from "
    "a file that is being written, from a serial device, or from a TCP server; Ctrl-C ends it with "
    "a summary. --noise is "
    "needed: how sure an answer is follows from it. Exit code 0: something fits in the end; 1: nothing does.\n"
    R"(
Examples:
  robot-log | rollfix watch part.dxf --finger disk,r=5 --noise contact=0.1,angle=0.5deg
  rollfix watch part.dxf --finger disk,r=5 --noise contact=0.1,angle=0.5deg --log roll.csv
  rollfix watch part.dxf --finger disk,r=5 --noise contact=0.1,angle=0.5deg --log /dev/ttyUSB0 --baud 921600
  rollfix watch track.csv --noise angle=0.2deg,slip=0.002 --log tcp:robot.local:7000 --jsonl | ./drive
  robot-log | rollfix watch part.dxf --finger disk,r=5mm --noise angle=0.5deg --columns u=skin:deg,psi=yaw:deg
  rollfix watch gallery:cam --finger disk,r=0.2 --noise contact=0.002,angle=0.2deg --log roll.csv --once
Two fingers on a part that is free to move, each with a log of its own:
  rollfix watch part.dxf --finger disk,r=5 --noise contact=0.1,angle=0.5deg --log /dev/ttyUSB0 --log /dev/ttyUSB1
A jaw with skin and a wheel without, on a pin: of the wheel x and y of its pin, and psi if it has an encoder:
  rollfix watch part.dxf --finger jaw --finger wheel,r=4 --noise contact=0.1,angle=0.5deg,position=0.1 --log jaw.csv --log pin.csv
Touches without rolling, a row each: where the part lies, and where to touch next:
  probe-log | rollfix watch part.dxf --finger disk,r=3 --noise position=0.02
Which part is it? Of a catalog the parts that remain, fewer and fewer:
  robot-log | rollfix watch --catalog parts.db --finger disk,r=5 --noise contact=0.1,angle=0.5deg
)";

struct WatchArguments {
  PartArgument part;
  std::string catalog;
  std::vector<std::string> logs;
  LogArguments reading;
  std::vector<std::string> fingers;
  std::string squeezed;
  bool may_overlap = false;
  std::string noise;
  std::string prior;
  PoseArguments pose;
  std::string direction;
  bool mirror = false;
  bool robust = false;
  std::string baud;
  std::string every;
  std::string idle_timeout;
  bool on_change = false;
  bool once = false;
  bool again = false;
  bool jsonl = false;
};

void read_belief(const WatchArguments& arguments, const std::string& unit, WatchOptions& options) {
  if (const std::optional<Noise> noise = read_noise(arguments.noise, unit)) {
    options.noise = *noise;
    options.prior = read_prior(arguments.prior, unit);
    options.robust = arguments.robust;
    options.pose = read_pose(arguments.pose, unit);
    return;
  }
  throw InputError(
      "watch: expected --noise, as in --noise contact=0.1,angle=0.5deg: how sure an answer is follows from how far the "
      "sensors are off");
}

/// The log, or two of one finger each.
std::vector<std::string> log_names(const WatchArguments& arguments) {
  const std::vector<std::string>& logs = arguments.logs;
  if (logs.size() > 2) {
    throw InputError(fmt::format(
        "watch: --log is given {} times, expected at most twice, one for each finger; three and more fingers "
        "are for rollfix locate, when they have rolled",
        logs.size()));
  }
  if (logs.size() == 2 && logs[0] == logs[1]) {
    throw InputError(fmt::format(
        "watch: --log {} is given twice: expected a log of each finger; one with the columns of both is given once",
        logs[0]));
  }
  if (!logs.empty()) return logs;
  if (::isatty(STDIN_FILENO) == 1) {
    throw InputError(
        "watch: expected --log FILE, --log /dev/ttyUSB0 or --log tcp:HOST:PORT, or a log piped in; to "
        "type one, --log -");
  }
  return {"-"};
}

void require_sensible(const WatchArguments& arguments, const std::vector<std::string>& logs) {
  require_part_or_catalog("watch", arguments.part, arguments.catalog);
  if (!arguments.catalog.empty()) require_no_prior(arguments.prior);
  if (std::find(logs.begin(), logs.end(), "-") != logs.end() && arguments.part.part == "-") {
    throw InputError("the part and the log can't both come from standard input: give one of them as a file");
  }
  if (arguments.on_change && !arguments.every.empty()) {
    throw InputError("--every tells at fixed intervals, --on-change when something is new: give one of them");
  }
  if (arguments.again && !arguments.catalog.empty()) {
    throw InputError("--again is of a known part, --catalog asks which part it is: give one of them");
  }
  if (arguments.again && !arguments.prior.empty()) {
    throw InputError("--prior is of the first start, and --again begins anew anywhere: give one of them");
  }
}

/// Fingers with skin, or one and behind it a wheel without.
void read_fingers_and_wheel(const WatchArguments& arguments, std::size_t logs, const std::string& unit,
                            WatchOptions& options) {
  std::vector<std::string> with_skin = arguments.fingers;
  const auto wheel = std::find_if(with_skin.begin(), with_skin.end(), names_wheel);
  if (wheel == with_skin.end()) {
    options.fingers = read_fingers(with_skin, 2, unit);
    if (!arguments.squeezed.empty()) {
      throw InputError(
          "--squeezed: it is about a finger with skin and a wheel without that squeeze a part, such as a jaw and "
          "wheel,r=0.4; leave it out");
    }
    return;
  }
  if (with_skin.size() != 2 || wheel == with_skin.begin() || logs != 2) {
    throw InputError(fmt::format(
        "--finger {}: watch takes one finger with skin and behind it one wheel, with a log of each in the same order, "
        "as in --finger jaw --finger wheel,r=0.4 --log jaw.csv --log pin.csv; more of them are for rollfix locate, "
        "when they have rolled",
        *wheel));
  }
  if (!arguments.catalog.empty()) {
    throw InputError(fmt::format(
        "--catalog: a wheel without skin is taken beside a known part; give PART, or leave --finger {} out and ask "
        "with fingers that have skin",
        *wheel));
  }
  options.wheel = read_wheel(*wheel, unit);
  if (!arguments.squeezed.empty()) options.squeezed = written_angle(arguments.squeezed, "--squeezed");
  with_skin.erase(wheel);
  options.fingers = read_fingers(with_skin, 1, unit);
}

WatchOptions watch_options(const WatchArguments& arguments, const std::vector<std::string>& logs,
                           const std::string& unit) {
  const auto name_of = [](const std::string& log) { return log == "-" ? "standard input" : log; };
  WatchOptions options;
  options.name = name_of(logs[0]);
  if (logs.size() == 2) options.name_b = name_of(logs[1]);
  read_fingers_and_wheel(arguments, logs.size(), unit, options);
  read_belief(arguments, unit, options);
  options.may_overlap = arguments.may_overlap;
  LogArguments reading = arguments.reading;
  if (names_touch_columns(reading.columns)) reading.columns.clear();  // of a table of touches
  options.log = read_log_options(reading, unit);
  if (!options.log.decimal_comma) options.log.decimal_comma = has_decimal_comma(arguments.part.decimal);
  options.mirrored = arguments.mirror;
  options.log.clockwise = counts_clockwise(arguments.direction);
  options.live = !arguments.once;
  options.again = arguments.again;
  options.midway = std::any_of(logs.begin(), logs.end(), may_begin_midway);
  options.log.any_part = !arguments.catalog.empty();
  if (!arguments.every.empty()) options.every = read_count(arguments.every, "--every", 1);
  return options;
}

/// What a table of touches is read with; none: the log can't be one.
std::optional<TouchWatchOptions> touch_options(const WatchArguments& arguments, const Part& part,
                                               const WatchOptions& watch) {
  if (watch.catalog || watch.name_b || watch.fingers.size() > 1) return std::nullopt;
  TouchWatchOptions options{watch.name, {part, {}}};
  try {
    if (!arguments.reading.columns.empty()) options.table.columns = parse_touch_columns(arguments.reading.columns);
  } catch (const InputError&) {
    return std::nullopt;  // the columns are of a roll
  }
  const auto refuse = [&](bool given, const char* option) {
    if (given) options.no_use_for.emplace_back(option);
  };
  refuse(!arguments.prior.empty(), "--prior");
  refuse(arguments.again, "--again");
  refuse(!arguments.direction.empty(), "--direction");
  refuse(!arguments.reading.wrapped.empty(), "--wrapped");
  options.table.unit = part.unit();
  options.table.decimal_comma = watch.log.decimal_comma;
  options.every = watch.every;
  options.problem.noise = watch.noise;
  options.problem.pose = watch.pose;
  options.problem.mirrored = arguments.mirror;
  options.problem.robust = arguments.robust;
  if (!watch.fingers.empty()) options.problem.finger = watch.fingers.front();
  return options;
}

SourceOptions source_options(const WatchArguments& arguments, const Watching& watcher, std::size_t which) {
  SourceOptions options;
  options.once = arguments.once;
  if (arguments.logs.size() == 2) {
    options.waits = [&watcher, which] { return watcher.is_ahead(which); };
    options.has_waiting = [&watcher, which] { return watcher.has_waiting(which); };
  }
  if (!arguments.baud.empty()) options.baud = static_cast<unsigned>(read_count(arguments.baud, "--baud", 1));
  return options;
}

std::optional<Seconds> idle_timeout_of(const WatchArguments& arguments) {
  if (arguments.idle_timeout.empty()) return std::nullopt;
  constexpr double kLongest = 1e6;  // seconds, eleven days: within what clocks can add
  const double seconds = read_number(arguments.idle_timeout, "--idle-timeout");
  if (seconds > 0 && seconds <= kLongest) return Seconds(seconds);
  throw InputError(fmt::format("--idle-timeout {}: expected seconds above 0, at most {}", seconds, kLongest));
}

/// Whether standard output takes a line without waiting for whoever reads it.
bool standard_output_is_ready() {
  pollfd output = {STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&output, 1, 0) != 0;  // errors are for the one who writes
}

/// Throws InputError: the log ended and there was nothing in it.
void require_rows(WatchEnd why, const Watching& watcher, const std::string& name) {
  if (watcher.has_found() || why == WatchEnd::signal) return;
  throw InputError(fmt::format("{}: expected rows with contact, found none in {} lines", name, watcher.counts().lines));
}

Report watch(const WatchArguments& arguments, std::ostream& out, std::ostream& err) {
  const std::vector<std::string> logs = log_names(arguments);
  require_sensible(arguments, logs);
  const std::optional<Seconds> idle_timeout = idle_timeout_of(arguments);
  std::vector<std::string> notes;
  const std::shared_ptr<const Catalog> catalog =
      arguments.catalog.empty() ? nullptr : std::make_shared<const Catalog>(arguments.catalog);
  const Part part = catalog ? any_part_of(*catalog) : load_part(arguments.part, notes);
  WatchOptions options = watch_options(arguments, logs, part.unit());
  options.catalog = catalog;
  if (!catalog && part.reversed()) notes.push_back(reversed_note(part));

  const auto io = std::make_shared<asio::io_context>();
  StopSignals signals(*io);
  const std::function<bool()> is_ready = &out == &std::cout ? standard_output_is_ready : [] { return true; };
  const std::unique_ptr<WatchWriter> writer =
      arguments.jsonl ? watch_jsonl(part, out, err, is_ready) : watch_text(part, out, err, is_ready);
  std::optional<TouchWatchOptions> of_touches = touch_options(arguments, part, options);
  if (of_touches) of_touches->is_stopped = [&signals] { return signals.has_come(); };
  Watching watcher(part, options, std::move(of_touches), *writer);
  Hearing hearing(*io, watcher, *writer, err, idle_timeout, logs.size());
  std::vector<std::unique_ptr<Source>> sources;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    sources.push_back(open_source(io, logs[k], source_options(arguments, watcher, k),
                                  [&hearing, k](Heard what, std::string_view text) { hearing.hear(what, text, k); }));
  }
  for (const std::string& note : notes) err << "rollfix: " << plain(note) << '\n';
  writer->begin(part, options);
  const WatchEnd why = hearing.run();
  signals.has_come();  // one that ended the hearing leaves time for the last answer
  watcher.finish();
  require_rows(why, watcher, options.name);
  watcher.end(why);
  Report report;
  report.exit_code = watcher.exit_code();
  return report;
}

}  // namespace

void add_watch_command(CLI::App& program, Command& chosen, std::ostream& out, std::ostream& err) {
  const auto arguments = std::make_shared<WatchArguments>();
  CLI::App* command = program.add_subcommand("watch", "Where the finger is, live, from a log that grows.");
  command->footer(kExamples);
  add_part_argument(*command, arguments->part);
  add_catalog_argument(*command, arguments->catalog);
  command
      ->add_option("--log", arguments->logs,
                   "the growing log: a file, which is followed as tail -F does; a serial device; tcp:HOST:PORT or "
                   "tcp:PORT, a server to connect to; - for stdin, the default; twice: a log of each of two fingers")
      ->type_name("SOURCE")
      ->allow_extra_args(false);
  add_reading_arguments(*command, arguments->reading);
  add_finger_argument(*command, arguments->fingers);
  add_switch(*command, "--may-overlap", arguments->may_overlap,
             "two fingers at different heights: places where their disks would overlap are kept");
  add_squeezed_argument(*command, arguments->squeezed);
  add_noise_arguments(*command, arguments->noise, arguments->prior, arguments->robust);
  add_pose_arguments(*command, arguments->pose);
  add_side_arguments(*command, arguments->mirror, arguments->direction);
  add_switch(*command, "--again", arguments->again,
             "where the rows contradict the roll so far, as when it was carried to another place, begin anew");
  add_switch(*command, "--on-change", arguments->on_change,
             "print when the verdict, the number of places or the most probable one changes: the default");
  command->add_option("--every", arguments->every, "print after every N samples instead")->type_name("N");
  add_switch(*command, "--jsonl", arguments->jsonl, "print a JSON object per line (rollfix/watch/1)");
  add_switch(*command, "--once", arguments->once,
             "stop at the end of the file, or when the connection closes, instead of waiting for more");
  command->add_option("--idle-timeout", arguments->idle_timeout, "stop when no line came for so long; default never")
      ->type_name("SECONDS");
  command->add_option("--baud", arguments->baud, "speed of a serial device; default 115200")->type_name("N");
  command->callback(
      [arguments, &chosen, &out, &err] { chosen = [arguments, &out, &err] { return watch(*arguments, out, err); }; });
}

}  // namespace rollfix::app
