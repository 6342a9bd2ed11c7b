// The table of files: what a saved part costs to load, beside building the part anew, and what a part's reach costs.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "outlines.hpp"
#include "rollfix/files/saved_part.hpp"
#include "rollfix/part/reach.hpp"
#include "stopwatch.hpp"
#include "tables.hpp"

namespace bench {

void files(int rounds) {
  fmt::print("outline          spirals  panels    bytes  load [us]  build [us]  reach [us]\n");
  std::vector<Family> all = families();
  all.push_back({"gear, 25 teeth", rollfix::gallery("gear,teeth=25")});
  for (const Family& family : all) {
    const rollfix::Part part(family.outline);
    const std::string text = rollfix::format_part(part);
    const double radius = 0.05 * part.perimeter();
    std::vector<double> load;
    std::vector<double> build;
    std::vector<double> reach;
    for (int round = 0; round < rounds; ++round) {
      load.push_back(seconds_per_call([&] { keep(rollfix::parse_part(text, family.name)); }));
      build.push_back(seconds_per_call([&] { keep(rollfix::Part(family.outline)); }));
      reach.push_back(seconds_per_call([&] { keep(rollfix::reach_of_disk(part, radius)); }));
    }
    fmt::print("{:<16} {:7} {:7} {:8}  {:>9}  {:>10}  {:>10}\n", family.name, part.turning().spirals().size(),
               part.turning().panels().size(), text.size(), cell(1e6 * least(load), 1), cell(1e6 * least(build), 1),
               cell(1e6 * least(reach), 1));
  }
}

}  // namespace bench
