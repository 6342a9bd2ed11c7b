// A stranger's program: one part, one reading, every placement.
#include <cstdio>
#include <string>

#include "rollfix/locate.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/version.hpp"

int main() {
  const rollfix::Part part(rollfix::gallery("ellipse,a=2,b=1"));
  const rollfix::Reading reading{0.1 * part.perimeter(), 0.7};
  const rollfix::Search found = rollfix::locate(part, reading);
  std::printf("rollfix %s: %s\n", rollfix::kVersion, found.verdict().text().c_str());
  // An ellipse looks the same after half a turn: whatever fits, fits twice.
  const bool even = !found.placements.empty() && found.placements.size() % 2 == 0;
  return found.status == rollfix::Status::complete && even ? 0 : 1;
}
