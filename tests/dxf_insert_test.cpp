// DXF: blocks come into the drawing by INSERT: moved, turned, scaled, mirrored, nested, in arrays, but not without end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "drawing_helpers.hpp"
#include "dxf_text.hpp"
#include "shapes.hpp"

namespace dxf_insert_test {
namespace {

using namespace dxf_text;
using drawings::area_of;
using drawings::kinds_of;
using drawings::length_of;
using drawings::numbers_of;
using rollfix::Drawing;
using rollfix::Vec2;
using shapes::kPi;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Rows = std::vector<std::vector<double>>;

/// A block A with a line from (0, 0) to (1, 0), inserted so.
Drawing inserted_line(const Numbers& how, double x = 0, double y = 0) {
  return parsed(with_blocks(block("A", line(0, 0, 1, 0)), insert("A", x, y, how)));
}

Drawing inserted_circle(const Numbers& how) {
  return parsed(with_blocks(block("A", circle(2, 0, 1)), insert("A", 0, 0, how)));
}

TEST(DxfInsert, moves_a_block_by_its_base_point) {
  const std::string blocks = block("A", line(0, 0, 1, 0), 0.5, 0.25);
  EXPECT_EQ(numbers_of(parsed(with_blocks(blocks, insert("A", 10, 20)))), (Rows{{9.5, 19.75, 10.5, 19.75}}));
}

TEST(DxfInsert, quarter_turns_are_exact) {
  EXPECT_EQ(numbers_of(inserted_line({{50, 90}}, 3, 4)), (Rows{{3, 4, 3, 5}}));
  EXPECT_EQ(numbers_of(inserted_line({{50, 180}}, 3, 4)), (Rows{{3, 4, 2, 4}}));
  EXPECT_EQ(numbers_of(inserted_line({{50, -90}}, 3, 4)), (Rows{{3, 4, 3, 3}}));
  EXPECT_EQ(numbers_of(inserted_line({{50, 720}}, 3, 4)), (Rows{{3, 4, 4, 4}}));
}

TEST(DxfInsert, scales_before_it_turns) {
  EXPECT_EQ(numbers_of(inserted_line({{41, 2}, {42, 5}, {50, 90}})), (Rows{{0, 0, 0, 2}}));
}

TEST(DxfInsert, arc_stays_an_arc_under_equal_scales) {
  EXPECT_THAT(kinds_of(inserted_circle({{41, 3}, {42, 3}, {50, 17}})), ElementsAre("arc"));
  EXPECT_NEAR(length_of(inserted_circle({{41, 3}, {42, 3}, {50, 17}})), 6 * kPi, 1e-13);
  EXPECT_NEAR(area_of(inserted_circle({{41, 3}, {42, 3}, {50, 17}})), 9 * kPi, 1e-13);
}

TEST(DxfInsert, arc_under_unequal_scales_is_an_elliptic_arc) {
  EXPECT_THAT(kinds_of(inserted_circle({{41, 3}, {42, 2}, {50, 17}})), ElementsAre("elliptic-arc"));
  EXPECT_NEAR(area_of(inserted_circle({{41, 3}, {42, 2}, {50, 17}})), 6 * kPi, 1e-13);
}

TEST(DxfInsert, negative_scale_mirrors) {
  const Drawing drawing = inserted_circle({{41, -3}, {42, 3}});
  EXPECT_THAT(kinds_of(drawing), ElementsAre("arc"));
  EXPECT_NEAR(area_of(drawing), -9 * kPi, 1e-13);
  EXPECT_LE((drawing.curves[0].curve.front() - Vec2(-9, 0)).norm(), 1e-14);
  EXPECT_NEAR(area_of(inserted_circle({{41, -3}, {42, -3}})), 9 * kPi, 1e-13);
}

TEST(DxfInsert, array_repeats_the_block_in_rows_and_columns_that_are_not_scaled) {
  const Drawing drawing = inserted_line({{41, 2}, {70, 2}, {71, 2}, {44, 10}, {45, 100}});
  EXPECT_EQ(numbers_of(drawing), (Rows{{0, 0, 2, 0}, {10, 0, 12, 0}, {0, 100, 2, 100}, {10, 100, 12, 100}}));
}

TEST(DxfInsert, array_turns_with_the_insert) {
  EXPECT_EQ(numbers_of(inserted_line({{50, 90}, {70, 2}, {44, 10}})), (Rows{{0, 0, 0, 1}, {0, 10, 0, 11}}));
}

TEST(DxfInsert, nested_blocks_are_placed_one_after_the_other) {
  const std::string blocks =
      block("A", line(0, 0, 1, 0)) + block("B", insert("A", 1, 0, {{50, 90}}) + line(0, 0, 1, 0));
  const Drawing drawing = parsed(with_blocks(blocks, insert("B", 10, 0, {{41, 2}, {42, 3}})));
  EXPECT_EQ(numbers_of(drawing), (Rows{{12, 0, 12, 3}, {10, 0, 12, 0}}));
}

TEST(DxfInsert, unequal_scale_around_a_turn_shears) {
  const std::string blocks = block("A", circle(0, 0, 1)) + block("B", insert("A", 0, 0, {{41, 2}, {50, 45}}));
  const Drawing drawing = parsed(with_blocks(blocks, insert("B", 0, 0, {{42, 3}})));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("elliptic-arc"));
  EXPECT_NEAR(area_of(drawing), 6 * kPi, 1e-13);
}

TEST(DxfInsert, inverse_scales_make_a_circle_round_again) {
  const std::string blocks = block("A", circle(0, 0, 1)) + block("B", insert("A", 0, 0, {{41, 0.3}, {42, 0.7}}));
  const Drawing drawing = parsed(with_blocks(blocks, insert("B", 0, 0, {{41, 0.7}, {42, 0.3}})));
  EXPECT_THAT(kinds_of(drawing), ElementsAre("arc"));
}

TEST(DxfInsert, extrusion_below_mirrors_the_whole_block) {
  EXPECT_EQ(numbers_of(inserted_line({{230, -1}}, 3, 4)), (Rows{{-3, 4, -4, 4}}));
  EXPECT_EQ(numbers_of(inserted_line({{50, 90}, {230, -1}}, 3, 4)), (Rows{{-3, 4, -3, 5}}));
}

TEST(DxfInsert, names_of_blocks_do_not_differ_by_case) {
  EXPECT_EQ(parsed(with_blocks(block("Part", line(0, 0, 1, 0)), insert("PART", 0, 0))).curves.size(), 1U);
}

TEST(DxfInsert, blocks_that_nothing_inserts_are_not_drawn) {
  const Drawing drawing = parsed(with_blocks(block("A", line(0, 0, 1, 0) + record("TEXT", {})), line(5, 5, 6, 6)));
  EXPECT_EQ(drawing.curves.size(), 1U);
  EXPECT_THAT(drawing.notes, IsEmpty());
}

TEST(DxfInsert, attributes_are_left_out_and_counted) {
  const std::string attributes = record("ATTRIB", {{10, 0}, {20, 0}}) + record("SEQEND", {});
  const Drawing drawing =
      parsed(with_blocks(block("A", line(0, 0, 1, 0)), insert("A", 0, 0, {{66, 1}}) + attributes + line(5, 5, 6, 6)));
  EXPECT_EQ(drawing.curves.size(), 2U);
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 1 ATTRIB"));
}

TEST(DxfInsert, block_of_another_file_is_left_out_and_counted) {
  const std::string other = group(0, "BLOCK") + group(2, "X") + group(70, 4) + group(1, "x.dwg") + group(0, "ENDBLK");
  const Drawing drawing = parsed(with_blocks(other, insert("X", 0, 0) + line(0, 0, 1, 0)));
  EXPECT_THAT(drawing.notes, ElementsAre("left out: 1 INSERT of another file"));
}

// ---- What has no end, or no sense.

TEST(DxfInsertRefusal, block_that_does_not_exist) {
  EXPECT_EQ(message_of(file(insert("NUT", 0, 0))), "part.dxf:6: INSERT of block 'NUT', which the file does not have");
}

TEST(DxfInsertRefusal, block_inside_itself) {
  EXPECT_THAT(message_of(with_blocks(block("A", insert("A", 0, 0)), insert("A", 0, 0))),
              HasSubstr("INSERT of block 'A' inside itself: that has no end"));
  const std::string ring =
      block("A", insert("B", 0, 0)) + block("B", insert("C", 0, 0)) + block("C", insert("a", 0, 0));
  EXPECT_THAT(message_of(with_blocks(ring, insert("B", 0, 0))), HasSubstr("inside itself"));
}

TEST(DxfInsertRefusal, blocks_nested_too_deep) {
  std::string blocks = block("B0", line(0, 0, 1, 0));
  for (int k = 1; k <= 200; ++k) blocks += block(fmt::format("B{}", k), insert(fmt::format("B{}", k - 1), 0, 0));
  EXPECT_EQ(parsed(with_blocks(blocks, insert("B99", 0, 0))).curves.size(), 1U);
  EXPECT_THAT(message_of(with_blocks(blocks, insert("B200", 0, 0))), HasSubstr("is nested more than 100 deep"));
}

/// Each block inserts the one before ten times: 10^levels copies of the innermost.
std::string tenfold(int levels, const std::string& innermost) {
  std::string blocks = block("B0", innermost);
  for (int k = 1; k <= levels; ++k) {
    std::string ten;
    for (int copy = 0; copy < 10; ++copy) ten += insert(fmt::format("B{}", k - 1), copy, 0);
    blocks += block(fmt::format("B{}", k), ten);
  }
  return with_blocks(blocks, insert(fmt::format("B{}", levels), 0, 0));
}

TEST(DxfInsertRefusal, more_copies_than_any_drawing_has) {
  EXPECT_EQ(parsed(tenfold(4, line(0, 0, 1, 0))).curves.size(), 10000U);
  EXPECT_THAT(message_of(tenfold(9, line(0, 0, 1, 0))), HasSubstr("the INSERTs bring more than 1000000"));
  EXPECT_THAT(message_of(tenfold(9, "")), HasSubstr("the INSERTs bring more than 1000000"));
}

TEST(DxfInsertRefusal, array_of_more_cells_than_any_drawing_has) {
  const Numbers huge = {{70, 32767}, {71, 32767}};
  EXPECT_THAT(message_of(with_blocks(block("A", ""), insert("A", 0, 0, huge))), HasSubstr("more than 1000000"));
  const Numbers beyond = {{70, 9e18}, {71, 9e18}};
  EXPECT_THAT(message_of(with_blocks(block("A", ""), insert("A", 0, 0, beyond))), HasSubstr("more than 1000000"));
}

TEST(DxfInsertRefusal, scale_of_0) {
  EXPECT_THAT(message_of(with_blocks(block("A", ""), insert("A", 0, 0, {{41, 0}}))), HasSubstr("has a scale of 0"));
}

TEST(DxfInsertRefusal, scales_that_multiply_beyond_all_numbers_are_told_without_any) {
  std::string blocks = block("B0", circle(0, 0, 1));
  for (int k = 1; k <= 8; ++k) {
    blocks += block("B" + std::to_string(k), insert("B" + std::to_string(k - 1), 0, 0, {{41, 1e60}, {42, 1e60}}));
  }
  const std::string message = message_of(with_blocks(blocks, insert("B8", 0, 0)));
  EXPECT_THAT(message, HasSubstr("beyond all numbers"));
  EXPECT_EQ(message.find("nan"), std::string::npos) << message;
}

TEST(DxfInsertRefusal, scales_that_multiply_beyond_the_range) {
  const std::string blocks = block("A", circle(1, 0, 1)) + block("B", insert("A", 0, 0, {{41, 1e60}, {42, 1e60}}));
  EXPECT_THAT(message_of(with_blocks(blocks, insert("B", 0, 0, {{41, 1e60}, {42, 1e60}}))),
              HasSubstr("CIRCLE on layer '0': its INSERT puts it at ("));
}

TEST(DxfInsert, two_blocks_of_one_name_are_a_note_where_none_is_drawn) {
  EXPECT_THAT(parsed(with_blocks(block("A", "") + block("a", ""), circle(0, 0, 1))).notes,
              ElementsAre("block 'A' is defined more than once, and not drawn"));
}

TEST(DxfInsertRefusal, two_blocks_of_one_name) {
  EXPECT_THAT(message_of(with_blocks(block("A", "") + block("a", ""), insert("A", 0, 0))),
              HasSubstr("block 'A' is defined here again"));
}

}  // namespace
}  // namespace dxf_insert_test
