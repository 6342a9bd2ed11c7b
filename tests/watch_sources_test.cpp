// Where a growing log can come from: each transport, with what can happen to it.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netdb.h>

#include <csignal>
#include <fstream>
#include <string_view>
#include <thread>

#include "cli.hpp"
#include "rollfix/error.hpp"
#include "watch_helpers.hpp"

namespace watch_sources_test {

constexpr const char* kSlowName = "slow.invalid";
constexpr std::chrono::seconds kSlowness{5};

}  // namespace watch_sources_test

/// In place of the system's: of one name it knows nothing for a long time.
extern "C" int getaddrinfo(const char* host, const char* service, const addrinfo* hints, addrinfo** found) {
  if (host != nullptr && std::string_view(host) == watch_sources_test::kSlowName) {
    std::this_thread::sleep_for(watch_sources_test::kSlowness);
    return EAI_AGAIN;
  }
  static const auto system = reinterpret_cast<decltype(&getaddrinfo)>(::dlsym(RTLD_NEXT, "getaddrinfo"));
  return system(host, service, hints, found);
}

namespace watch_sources_test {

namespace {

using rollfix::InputError;
using rollfix::app::SourceOptions;
using testing::HasSubstr;
using watching::Ear;
using watching::Pipe;
using watching::SerialLine;
using watching::Server;

const SourceOptions kOnce{true, 115200};

void append(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::app) << text; }
void rewrite(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::trunc) << text; }

std::string refusal(const std::string& name) {
  try {
    const Ear ear(name);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(WatchPipe, gives_lines_as_they_are_written_and_the_last_one_without_a_line_end) {
  Pipe pipe;
  Ear ear(pipe.out.number());
  watching::write_all(pipe.in, "time,u,psi\n0,0,");
  EXPECT_EQ(ear.next(), "time,u,psi");
  EXPECT_EQ(ear.now(), "(nothing)");
  watching::write_all(pipe.in, "0\r\n1,2,3");
  EXPECT_EQ(ear.next(), "0,0,0");
  pipe.in.close();
  EXPECT_EQ(ear.next(), "1,2,3");
  EXPECT_EQ(ear.next(), "(ended)");
  EXPECT_EQ(ear.next(), "(ended)");
}

TEST(WatchPipe, is_not_made_non_blocking_for_others_who_have_it) {
  Pipe pipe;
  Ear ear(pipe.out.number());
  EXPECT_EQ(ear.now(), "(nothing)");
  EXPECT_EQ(::fcntl(pipe.out.number(), F_GETFL) & O_NONBLOCK, 0);
}

TEST(WatchFile, is_followed_while_it_grows) {
  const cli::Folder folder;
  folder.write("roll.csv", "a\nb");
  Ear ear("roll.csv");
  EXPECT_EQ(ear.next(), "a");
  EXPECT_EQ(ear.now(), "(nothing)");
  append("roll.csv", "c\nd\n");
  EXPECT_EQ(ear.next(), "bc");
  EXPECT_EQ(ear.next(), "d");
  EXPECT_EQ(ear.now(), "(nothing)");
}

TEST(WatchFile, that_is_read_once_ends_with_its_last_line) {
  const cli::Folder folder;
  folder.write("roll.csv", "a\nb");
  Ear ear("roll.csv", kOnce);
  EXPECT_EQ(ear.next(), "a");
  EXPECT_EQ(ear.next(), "b");
  EXPECT_EQ(ear.next(), "(ended)");
}

TEST(WatchFile, that_is_cut_back_starts_again) {
  const cli::Folder folder;
  folder.write("roll.csv", "a\nb\nhalf a li");
  Ear ear("roll.csv");
  EXPECT_EQ(ear.next(), "a");
  EXPECT_EQ(ear.next(), "b");
  EXPECT_EQ(ear.now(), "(nothing)");
  rewrite("roll.csv", "c\n");
  EXPECT_EQ(ear.next(), "(restarted)");
  EXPECT_THAT(ear.note(), HasSubstr("roll.csv was cut back"));
  EXPECT_EQ(ear.next(), "c");
}

TEST(WatchFile, that_is_replaced_is_read_to_its_end_and_then_the_new_one) {
  const cli::Folder folder;
  folder.write("roll.csv", "a\n");
  Ear ear("roll.csv");
  EXPECT_EQ(ear.next(), "a");
  append("roll.csv", "b\n");
  folder.write("new.csv", "c\nd\n");
  cli::fs::rename("new.csv", "roll.csv");
  EXPECT_EQ(ear.next(), "b");
  EXPECT_EQ(ear.next(), "(restarted)");
  EXPECT_THAT(ear.note(), HasSubstr("roll.csv was replaced"));
  EXPECT_EQ(ear.next(), "c");
  EXPECT_EQ(ear.next(), "d");
}

TEST(WatchFile, that_is_replaced_again_and_again_is_followed_all_the_same) {
  const cli::Folder folder;
  folder.write("roll.csv", "first\n");
  Ear ear("roll.csv");
  EXPECT_EQ(ear.next(), "first");
  for (const std::string line : {"second", "third", "fourth"}) {
    folder.write("new.csv", line + "\n");
    cli::fs::rename("new.csv", "roll.csv");
    EXPECT_EQ(ear.next(), "(restarted)");
    EXPECT_EQ(ear.next(), line);
  }
}

TEST(WatchFile, that_is_gone_for_a_while_is_awaited) {
  const cli::Folder folder;
  folder.write("roll.csv", "a\n");
  Ear ear("roll.csv");
  EXPECT_EQ(ear.next(), "a");
  cli::fs::rename("roll.csv", "old.csv");
  EXPECT_EQ(ear.now(), "(nothing)");
  append("old.csv", "b\n");
  EXPECT_EQ(ear.next(), "b");
  folder.write("roll.csv", "c\n");
  EXPECT_EQ(ear.next(), "(restarted)");
  EXPECT_EQ(ear.next(), "c");
}

TEST(WatchNamedPipe, goes_on_with_the_next_writer) {
  const cli::Folder folder;
  watching::require(::mkfifo("roll", 0600) == 0, "mkfifo");
  Ear ear("roll");
  EXPECT_EQ(ear.now(), "(nothing)");
  watching::Descriptor writer = watching::writer_of("roll");
  watching::write_all(writer, "a\nhalf a li");
  EXPECT_EQ(ear.next(), "a");
  writer.close();
  EXPECT_EQ(ear.next(), "(dropped)");
  writer = watching::writer_of("roll");
  watching::write_all(writer, "b\n");
  EXPECT_EQ(ear.next(), "(resumed)");
  EXPECT_EQ(ear.next(), "b");
}

TEST(WatchNamedPipe, that_is_read_once_ends_with_its_writer) {
  const cli::Folder folder;
  watching::require(::mkfifo("roll", 0600) == 0, "mkfifo");
  Ear ear("roll", kOnce);
  watching::Descriptor writer = watching::writer_of("roll");
  watching::write_all(writer, "a\n");
  writer.close();
  EXPECT_EQ(ear.next(), "a");
  EXPECT_EQ(ear.next(), "(ended)");
}

TEST(WatchSerial, gives_lines_as_they_come) {
  const SerialLine line;
  Ear ear(line.name());
  line.send("time,u,psi\r\n0,0");
  EXPECT_EQ(ear.next(), "time,u,psi");
  EXPECT_EQ(ear.now(), "(nothing)");
  line.send(",0\n");
  EXPECT_EQ(ear.next(), "0,0,0");
}

TEST(WatchSerial, is_raw_at_the_speed_asked_for) {
  const SerialLine line;
  Ear ear(line.name(), {false, 57600});
  const termios settings = line.settings();
  EXPECT_EQ(::cfgetispeed(&settings), speed_t{B57600});
  EXPECT_EQ(settings.c_lflag & tcflag_t{ICANON | ECHO | ISIG}, 0U);
  line.send("a\x03\x04z\n");  // in a terminal these would be Ctrl-C and Ctrl-D
  EXPECT_EQ(ear.next(), "a\x03\x04z");
  EXPECT_FALSE(line.has_echo());
}

TEST(WatchSerial, that_is_pulled_out_is_awaited) {
  const cli::Folder folder;
  SerialLine first;
  cli::fs::create_symlink(first.name(), "tty");
  Ear ear("tty");
  first.send("a\nhalf a li");
  EXPECT_EQ(ear.next(), "a");
  EXPECT_EQ(ear.now(), "(nothing)");
  cli::fs::remove("tty");
  first.pull_out();
  EXPECT_EQ(ear.next(), "(dropped)");
  EXPECT_EQ(ear.now(), "(nothing)");
  const SerialLine second;
  cli::fs::create_symlink(second.name(), "tty");
  EXPECT_EQ(ear.next(), "(resumed)");
  second.send("b\n");
  EXPECT_EQ(ear.next(), "b");
}

TEST(WatchSerial, speeds_that_do_not_exist_are_refused) {
  const SerialLine line;
  EXPECT_THROW(Ear(line.name(), {false, 57601}), InputError);
}

TEST(WatchTcp, gives_lines_as_they_come) {
  Server server;
  Ear ear(server.name());
  EXPECT_THAT(ear.next_note(), HasSubstr("connected"));
  server.accept();
  server.send("time,u,psi\n0,0");
  EXPECT_EQ(ear.next(), "time,u,psi");
  EXPECT_EQ(ear.now(), "(nothing)");
  server.send(",0\r\n");
  EXPECT_EQ(ear.next(), "0,0,0");
}

TEST(WatchTcp, takes_a_line_in_single_bytes_as_one) {
  Server server;
  Ear ear(server.name());
  EXPECT_THAT(ear.next_note(), HasSubstr("connected"));
  server.accept();
  for (const char byte : std::string("0,0,0\n")) {
    server.send({byte});
    ear.listen();
  }
  EXPECT_EQ(ear.next(), "0,0,0");
}

TEST(WatchTcp, that_floods_without_a_line_end_is_heard_once_and_goes_on_behind_it) {
  Server server;
  Ear ear(server.name());
  EXPECT_THAT(ear.next_note(), HasSubstr("connected"));
  server.accept();
  std::thread flood([&] {
    for (int k = 0; k < 1000; ++k) server.send(std::string(1000, 'x'));
    server.send("\na\n");
  });
  EXPECT_EQ(ear.next(), "(too long)");
  EXPECT_EQ(ear.next(), "a");
  flood.join();
}

TEST(WatchTcp, needs_no_host_for_this_machine) {
  Server server;
  Ear ear("tcp:" + server.port());
  EXPECT_THAT(ear.next_note(), HasSubstr("connected"));
  server.accept();
  server.send("a\n");
  EXPECT_EQ(ear.next(), "a");
}

TEST(WatchTcp, connects_again_when_the_connection_drops) {
  Server server;
  Ear ear(server.name());
  EXPECT_THAT(ear.next_note(), HasSubstr("connected"));
  server.accept();
  server.send("a\nhalf a li");
  EXPECT_EQ(ear.next(), "a");
  server.drop();
  EXPECT_EQ(ear.next(), "(dropped)");
  EXPECT_EQ(ear.next(), "(resumed)");
  server.accept();
  server.send("b\n");
  EXPECT_EQ(ear.next(), "b");
}

TEST(WatchTcp, waits_for_a_server_that_is_not_there_yet) {
  Server gone;
  const std::string name = gone.name();
  gone.close();
  Ear ear(name);
  EXPECT_THAT(ear.next_note(), HasSubstr("can't connect"));
}

TEST(WatchTcp, that_is_read_once_ends_when_it_is_closed) {
  Server server;
  Ear ear(server.name(), kOnce);
  EXPECT_THAT(ear.next_note(), HasSubstr("connected"));
  server.accept();
  server.send("a\n");
  server.drop();
  EXPECT_EQ(ear.next(), "a");
  EXPECT_EQ(ear.next(), "(ended)");
}

TEST(WatchBackOff, doubles_up_to_its_longest_and_starts_small_again) {
  rollfix::app::BackOff wait;
  std::chrono::milliseconds sum{0};
  for (int k = 0; k < 6; ++k) sum += wait.next();
  EXPECT_EQ(sum, (1 + 2 + 4 + 8 + 16 + 32) * wait.kFirst);
  EXPECT_EQ(wait.next(), wait.kLongest);
  EXPECT_EQ(wait.next(), wait.kLongest);
  wait.reset();
  EXPECT_EQ(wait.next(), wait.kFirst);
}

TEST(WatchSource, that_does_not_exist_is_refused_with_the_cure) {
  const cli::Folder folder;
  EXPECT_THAT(refusal("no.csv"), HasSubstr("no.csv: no such file"));
  EXPECT_THAT(refusal("."), HasSubstr("is a folder"));
  EXPECT_THAT(refusal("tcp:robot"), HasSubstr("'robot' is not a whole number"));
  EXPECT_THAT(refusal("tcp:robot:70000"), HasSubstr("70000, expected 1 to 65535"));
}

TEST(WatchTcp, that_has_an_unknown_name_is_refused) {
  Ear ear("tcp:nowhere.invalid:7000");
  EXPECT_THROW(ear.next(), InputError);
}

TEST(WatchTcp, waits_for_no_name_when_it_is_stopped) {
  const auto start = std::chrono::steady_clock::now();
  {
    Ear ear("tcp:" + std::string(kSlowName) + ":7000");
    EXPECT_EQ(ear.now(), "(nothing)");
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, kSlowness);
}

TEST(WatchStop, ends_the_waiting_and_leaves_the_handlers_as_they_were) {
  const cli::Folder folder;
  watching::require(::mkfifo("roll", 0600) == 0, "mkfifo");
  const auto before = std::signal(SIGTERM, SIG_IGN);
  std::thread stopper([] {
    const watching::Descriptor writer = watching::writer_of("roll");  // waits for its reader
    ::kill(::getpid(), SIGTERM);
    std::this_thread::sleep_for(watching::kAWhile);
  });
  const cli::Ran ran = cli::run("watch gallery:cam --finger disk,r=0.2 --noise contact=0.002,angle=0.003 --log roll");
  stopper.join();
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.out, HasSubstr("stopped: no contact came"));
  EXPECT_EQ(std::signal(SIGTERM, before), SIG_IGN);
}

}  // namespace watch_sources_test
