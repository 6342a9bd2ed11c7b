#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <string>
#include <vector>

#include "rollfix/program.hpp"

namespace {

/// What was closed by whoever started the program would be the number of the first file that is opened, and what is
/// printed would go there. In its place stands what can't be written to, or read from.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    // The lowest number that is free is this one.
    if (::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

}  // namespace

int main(int argc, char** argv) {
  occupy_standard_streams();
  // That a file would be larger than it may be is an error as that the disk is full, with a message.
  std::signal(SIGXFSZ, SIG_IGN);
  return rollfix::app::run(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc), std::cout, std::cerr);
}
