// DXF: what is shown, on which layer, in which unit; the rest is counted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "drawing_helpers.hpp"
#include "dxf_text.hpp"

namespace dxf_layers_test {
namespace {

using namespace dxf_text;
using rollfix::Drawing;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const rollfix::files::DxfOptions kCut{"Cut"};

std::vector<std::string> layers_of(const Drawing& drawing) {
  std::vector<std::string> names;
  for (const rollfix::DrawnCurve& drawn : drawing.curves) names.push_back(drawn.origin.layer);
  return names;
}

std::string with_layers(const std::string& records, const std::string& entities, const std::string& blocks = "") {
  return file(entities, layers(records) + (blocks.empty() ? "" : section("BLOCKS", blocks)));
}

TEST(DxfLayers, all_are_taken_unless_one_is_named) {
  const std::string text = file(line(0, 0, 1, 0, "Cut") + line(0, 0, 1, 0, "Frame"));
  EXPECT_THAT(layers_of(parsed(text)), ElementsAre("Cut", "Frame"));
  EXPECT_THAT(layers_of(parsed(text, kCut)), ElementsAre("Cut"));
  EXPECT_THAT(parsed(text, kCut).notes, ElementsAre("left out: 1 entity on other layers than 'Cut'"));
}

TEST(DxfLayers, names_do_not_differ_by_case) {
  EXPECT_EQ(parsed(file(line(0, 0, 1, 0, "CUT")), kCut).curves.size(), 1U);
}

TEST(DxfLayers, missing_one_is_refused_with_those_that_exist) {
  const std::string text = file(line(0, 0, 1, 0, "Cuts") + line(0, 0, 1, 0, "Frame"));
  EXPECT_THAT(message_of(text, kCut),
              AllOf(StartsWith("part.dxf: has no layer 'Cut'; did you mean 'Cuts'"), HasSubstr("Frame")));
}

TEST(DxfLayers, off_and_frozen_ones_are_left_out_and_counted) {
  const std::string table = layer("Off", 0, -7) + layer("Frozen", 1) + layer("Locked", 4);
  const Drawing drawing =
      parsed(with_layers(table, line(0, 0, 1, 0, "Off") + line(0, 0, 1, 0, "Frozen") + line(0, 0, 1, 0, "Locked")));
  EXPECT_THAT(layers_of(drawing), ElementsAre("Locked"));
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 2 entities on layers that are off or frozen"));
}

TEST(DxfLayers, one_that_is_named_is_taken_even_where_it_is_off) {
  EXPECT_EQ(parsed(with_layers(layer("Cut", 1, -7), line(0, 0, 1, 0, "cut")), kCut).curves.size(), 1U);
}

TEST(DxfLayers, layer_0_of_a_block_is_that_of_its_insert) {
  const std::string blocks = block("A", line(0, 0, 1, 0) + line(0, 0, 1, 0, "Own")) + block("B", insert("A", 0, 0));
  const std::string text = with_blocks(blocks, insert("B", 0, 0, {}, "Cut"));
  EXPECT_THAT(layers_of(parsed(text)), ElementsAre("Cut", "Own"));
  EXPECT_THAT(layers_of(parsed(text, kCut)), ElementsAre("Cut"));
}

TEST(DxfLayers, insert_on_a_layer_that_is_off_hides_only_what_is_on_it) {
  const std::string blocks = block("A", line(0, 0, 1, 0) + line(0, 0, 1, 0, "Own"));
  const std::string entities = insert("A", 0, 0, {}, "Cut");
  EXPECT_THAT(layers_of(parsed(with_layers(layer("Cut", 0, -7), entities, blocks))), ElementsAre("Own"));
  EXPECT_THAT(layers_of(parsed(with_layers(layer("Cut", 1), entities, blocks))), IsEmpty());
}

TEST(DxfLayers, old_letters_and_escapes_are_read) {
  EXPECT_THAT(layers_of(parsed(file(line(0, 0, 1, 0, "Fr\xe4sen")))), ElementsAre("Fr\xc3\xa4sen"));
  EXPECT_THAT(layers_of(parsed(file(line(0, 0, 1, 0, "Fr\\U+00E4sen")))), ElementsAre("Fr\xc3\xa4sen"));
  EXPECT_THAT(layers_of(parsed(file(line(0, 0, 1, 0, "Fr\xc3\xa4sen")))), ElementsAre("Fr\xc3\xa4sen"));
  EXPECT_THAT(layers_of(parsed(file(line(0, 0, 1, 0, "5 \x80")))), ElementsAre("5 \xe2\x82\xac"));
  EXPECT_EQ(parsed(file(line(0, 0, 1, 0, "Fr\xe4sen")), {"Fr\xc3\xa4sen"}).curves.size(), 1U);
}

TEST(DxfShown, unknown_entities_are_counted_by_name) {
  const std::string texts = record("TEXT", {{10, 0}}) + record("HATCH", {{10, 0}}) + record("TEXT", {{40, 1}});
  EXPECT_THAT(parsed(file(texts + line(0, 0, 1, 0))).notes, ElementsAre("left out: 1 HATCH, 2 TEXT"));
}

TEST(DxfShown, meshes_are_counted_as_such) {
  const std::string mesh = record("POLYLINE", {{66, 1}, {70, 64}}) +
                           record("VERTEX", {{10, 0}, {20, 0}, {30, 7}, {70, 192}}) +
                           record("VERTEX", {{71, 1}, {72, 2}, {70, 128}}) + record("SEQEND", {});
  const Drawing drawing = parsed(file(mesh + record("3DFACE", {{10, 0}, {30, 9}}) + line(0, 0, 1, 0)));
  EXPECT_EQ(drawing.curves.size(), 1U);
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 1 3DFACE, 1 POLYLINE"));
}

TEST(DxfShown, many_kinds_of_entities_are_not_all_named) {
  std::string texts;
  for (int k = 0; k < 1000; ++k) texts += record(fmt::format("KIND{:03}", k), {});
  EXPECT_THAT(parsed(file(texts)).notes, ElementsAre(AllOf(HasSubstr("KIND019 and 980 more kinds"))));
}

TEST(DxfShown, invisible_and_paper_space_entities_are_counted) {
  const std::string hidden = record("LINE", {{60, 1}, {10, 0}, {20, 0}, {11, 1}, {21, 0}});
  const std::string paper = record("LINE", {{67, 1}, {10, 0}, {20, 0}, {11, 1}, {21, 0}});
  const Drawing drawing = parsed(file(hidden + paper + paper + line(0, 0, 1, 0)));
  EXPECT_EQ(drawing.curves.size(), 1U);
  EXPECT_THAT(drawing.notes,
              ElementsAre("left out: 1 entity marked as invisible", "left out: 2 entities in paper space"));
}

TEST(DxfShown, what_is_not_shown_may_be_tilted) {
  const std::string tilted = record("CIRCLE", {{67, 1}, {10, 0}, {20, 0}, {40, 1}, {210, 1}, {230, 0}});
  EXPECT_EQ(parsed(file(tilted + line(0, 0, 1, 0))).curves.size(), 1U);
}

TEST(DxfShown, drawing_at_one_height_is_flattened_with_a_note) {
  const Drawing drawing =
      parsed(file(record("LINE", {{10, 0}, {20, 0}, {30, 5}, {11, 1}, {21, 0}, {31, 5}}) +
                  light_polyline({{0, 0}, {1, 1}}, false, {{38, 5}}) + polyline({{0, 0}, {1, 1}}, 0, 5) +
                  record("CIRCLE", {{10, 0}, {20, 0}, {30, -5}, {40, 1}, {230, -1}})));
  EXPECT_EQ(drawing.curves.size(), 4U);
  EXPECT_THAT(drawing.notes, ElementsAre("flattened: all lies at z = 5"));
}

TEST(DxfShown, rounded_heights_are_one) {
  const std::string text = record("LINE", {{10, 0}, {20, 0}, {30, 1e-10}, {11, 1}, {21, 0}, {31, -1e-10}});
  EXPECT_THAT(parsed(file(text)).notes, ElementsAre(HasSubstr("flattened")));
}

TEST(DxfUnits, come_from_insunits) {
  EXPECT_EQ(parsed(file("", header("$INSUNITS", 1))).unit, "in");
  EXPECT_EQ(parsed(file("", header("$INSUNITS", 4))).unit, "mm");
  EXPECT_EQ(parsed(file("", header("$INSUNITS", 13))).unit, "um");
  EXPECT_THAT(parsed(file("", header("$INSUNITS", 4))).notes, IsEmpty());
}

TEST(DxfUnits, come_from_measurement_where_insunits_says_nothing) {
  const std::string both =
      section("HEADER", group(9, "$INSUNITS") + group(70, 0) + group(9, "$MEASUREMENT") + group(70, 0));
  EXPECT_EQ(parsed(file("", both)).unit, "in");
  EXPECT_EQ(parsed(file("", header("$MEASUREMENT", 1))).unit, "mm");
  EXPECT_THAT(parsed(file("", header("$MEASUREMENT", 1))).notes, ElementsAre(HasSubstr("metric ($MEASUREMENT)")));
}

TEST(DxfUnits, are_empty_where_the_file_does_not_say) {
  EXPECT_EQ(parsed(file("")).unit, "");
  EXPECT_EQ(parsed(file("", header("$INSUNITS", 0))).unit, "");
  EXPECT_EQ(parsed(file("", header("$INSUNITS", 99))).unit, "");
  EXPECT_THAT(parsed(file("", header("$INSUNITS", 99))).notes, ElementsAre(HasSubstr("is 99, which means nothing")));
}

}  // namespace
}  // namespace dxf_layers_test
