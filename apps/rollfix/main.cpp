#include <iostream>
#include <string>
#include <vector>

#include "rollfix/program.hpp"

int main(int argc, char** argv) {
  return rollfix::app::run(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc), std::cout, std::cerr);
}
