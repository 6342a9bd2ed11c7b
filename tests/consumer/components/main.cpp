// A stranger's program with every component: a saved part, a catalog, the published algorithm, a figure.
#include <cstdio>
#include <string>

#include "rollfix/draw.hpp"
#include "rollfix/files.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/march.hpp"
#include "rollfix/rollfix.hpp"

int main() {
  const rollfix::Outline outline = rollfix::gallery("ellipse,a=2,b=1");
  const rollfix::Part part = rollfix::parse_part(rollfix::format_part(rollfix::Part(outline)), "ellipse");
  const double length = 0.1 * part.perimeter();
  const std::size_t found = rollfix::locate(part, {length, 0.7}).placements.size();

  std::remove("consumer.db");
  rollfix::build_catalog("consumer.db", {{"gallery:ellipse,a=2,b=1", "ellipse"}, {"gallery:cam", "cam"}});
  const rollfix::Catalog catalog("consumer.db");
  const rollfix::Identified identified = rollfix::identify(catalog, {part, rollfix::Reading(length, 0.7)});

  const rollfix::march::March march(outline, rollfix::march::curvature_density());
  const std::size_t marched = march.segments(length, 0.7).segments.size();

  rollfix::PartFigure figure;
  figure.part = &part;
  const std::string svg = rollfix::draw_part(figure).str();
  std::printf("%zu placements, %zu by the march, %s, a figure of %zu bytes\n", found, marched,
              identified.verdict.c_str(), svg.size());
  return found > 0 && found == marched && !svg.empty() && !identified.parts.empty() ? 0 : 1;
}
