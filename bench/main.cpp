// What one finger and two fingers cost, in units of W: one integration of the same outline's perimeter, timed in the
// same process. And what saved parts and reach cost, in microseconds.
//   rollfix_bench [ROUNDS]     rounds of measurement (default 15)

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tables.hpp"

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 15;
  std::puts("one finger");
  bench::one_finger(rounds);
  std::puts("\ntwo fingers");
  bench::two_fingers(rounds);
  std::puts("\nsaved parts and reach");
  bench::files(rounds);
  return 0;
}
