#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/commands.hpp"
#include "rollfix/error.hpp"
#include "rollfix/finger_argument.hpp"
#include "rollfix/part_argument.hpp"
#include "rollfix/typed_number.hpp"
#include "rollfix/usage.hpp"
#include "rollfix/watch_loop.hpp"
#include "rollfix/weighing.hpp"

namespace rollfix::app {
namespace {

constexpr const char* kExamples =
    R"(A finger rolls, its log grows, and this says where it is as soon as that changes. The log is read from a pipe, from a
file that is being written, from a serial device, or from a TCP server; Ctrl-C ends it with a summary. --noise is
needed: how sure an answer is follows from it. Exit code 0: something fits in the end; 1: nothing does.

Examples:
  robot-log | rollfix watch part.dxf --finger disk,r=5 --noise contact=0.1,angle=0.5deg
  rollfix watch part.dxf --finger disk,r=5 --noise contact=0.1,angle=0.5deg --log roll.csv
  rollfix watch part.dxf --finger disk,r=5 --noise contact=0.1,angle=0.5deg --log /dev/ttyUSB0 --baud 921600
  rollfix watch track.csv --noise angle=0.2deg,slip=0.002 --log tcp:robot.local:7000 --jsonl | ./drive
  rollfix watch gallery:cam --finger disk,r=0.2 --noise contact=0.002,angle=0.2deg --log roll.csv --once
)";

struct WatchArguments {
  PartArgument part;
  std::string log;
  std::vector<std::string> fingers;
  NoiseArguments noise;
  std::string baud;
  std::string every;
  std::string idle_timeout;
  bool on_change = false;
  bool once = false;
  bool jsonl = false;
};

BeliefOptions required_noise(const NoiseArguments& arguments) {
  const std::optional<BeliefOptions> options = read_belief_options(arguments);
  if (options) return *options;
  throw InputError(
      "watch: expected --noise, as in --noise contact=0.1,angle=0.5deg: how sure an answer is follows from how far the "
      "sensors are off");
}

std::string log_name(const WatchArguments& arguments) {
  if (!arguments.log.empty()) return arguments.log;
  if (::isatty(STDIN_FILENO) == 1) {
    throw InputError(
        "watch: expected --log FILE, --log /dev/ttyUSB0 or --log tcp:HOST:PORT, or a log piped in; to type one, --log "
        "-");
  }
  return "-";
}

void require_sensible(const WatchArguments& arguments, const std::string& log) {
  if (log == "-" && arguments.part.part == "-") {
    throw InputError("the part and the log can't both come from standard input: give one of them as a file");
  }
  if (arguments.on_change && !arguments.every.empty()) {
    throw InputError("--every tells at fixed intervals, --on-change when something is new: give one of them");
  }
}

WatchOptions watch_options(const WatchArguments& arguments, const std::string& log) {
  WatchOptions options;
  options.name = log == "-" ? "standard input" : log;
  options.finger = read_finger(arguments.fingers);
  options.belief = required_noise(arguments.noise);
  options.live = !arguments.once;
  if (!arguments.every.empty()) options.every = read_count(arguments.every, "--every", 1);
  return options;
}

SourceOptions source_options(const WatchArguments& arguments) {
  SourceOptions options;
  options.once = arguments.once;
  if (!arguments.baud.empty()) options.baud = static_cast<unsigned>(read_count(arguments.baud, "--baud", 1));
  return options;
}

std::optional<std::chrono::duration<double>> idle_timeout_of(const WatchArguments& arguments) {
  if (arguments.idle_timeout.empty()) return std::nullopt;
  constexpr double kLongest = 1e6;  // seconds, eleven days: within what clocks can add
  const double seconds = read_number(arguments.idle_timeout, "--idle-timeout");
  if (seconds > 0 && seconds <= kLongest) return std::chrono::duration<double>(seconds);
  throw InputError(fmt::format("--idle-timeout {}: expected seconds above 0, at most {}", seconds, kLongest));
}

/// Throws InputError: the log ended and there was nothing in it.
void require_rows(WatchEnd why, const Watcher& watcher, const std::string& name) {
  if (watcher.last_answer().roll > 0 || why == WatchEnd::signal) return;
  throw InputError(fmt::format("{}: expected rows with contact, found none in {} lines", name, watcher.counts().lines));
}

Report watch(const WatchArguments& arguments, std::ostream& out, std::ostream& err) {
  const std::string log = log_name(arguments);
  require_sensible(arguments, log);
  const WatchOptions options = watch_options(arguments, log);
  const auto idle_timeout = idle_timeout_of(arguments);
  std::vector<std::string> notes;
  const Part part = load_part(arguments.part, notes);
  if (part.reversed()) notes.push_back(reversed_note(part));

  const StopSignal stop;
  const std::function<bool()> is_ready = &out == &std::cout ? standard_output_is_ready : [] { return true; };
  const std::unique_ptr<WatchWriter> writer =
      arguments.jsonl ? watch_jsonl(part, out, err, is_ready) : watch_text(part, out, err, is_ready);
  Watcher watcher(part, options, *writer);
  const std::unique_ptr<ByteSource> bytes = open_source(log, source_options(arguments), stop);
  for (const std::string& note : notes) err << "rollfix: " << note << '\n';
  writer->begin(part, options);
  LineSource lines(*bytes);
  const WatchEnd why = watch_lines(lines, watcher, *writer, stop, idle_timeout, err);
  require_rows(why, watcher, options.name);
  watcher.finish();
  writer->end(why, watcher.last_answer(), watcher.counts());
  Report report;
  if (watcher.last_answer().verdict == kInconsistent) report.exit_code = ExitCode::nothing_fits;
  return report;
}

}  // namespace

void add_watch_command(CLI::App& program, Command& chosen, std::ostream& out, std::ostream& err) {
  const auto arguments = std::make_shared<WatchArguments>();
  CLI::App* command = program.add_subcommand("watch", "Where the finger is, live, from a log that grows.");
  command->footer(kExamples);
  add_part_argument(*command, arguments->part);
  command
      ->add_option("--log", arguments->log,
                   "the growing log: a file, which is followed as tail -F does; a serial device; tcp:HOST:PORT or "
                   "tcp:PORT, a server to connect to; - for stdin, the default")
      ->type_name("SOURCE");
  add_finger_argument(*command, arguments->fingers);
  add_noise_arguments(*command, arguments->noise);
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
