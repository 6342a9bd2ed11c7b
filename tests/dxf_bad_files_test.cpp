// DXF: what every kind of bad file is told, with line and value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "dxf_text.hpp"

namespace dxf_bad_files_test {
namespace {

using namespace dxf_text;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string message_of_entity(const std::string& name, const Numbers& numbers) {
  return message_of(file(record(name, numbers)));
}

/// A message of the text with one piece of it replaced.
std::string message_with(std::string text, const std::string& piece, const std::string& by) {
  const std::size_t at = text.find(piece);
  if (at == std::string::npos) return "nothing to replace";
  return message_of(text.replace(at, piece.size(), by));
}

const std::string kLine = file(line(0.5, 0, 1, 0));

// ---- Not a DXF file.

TEST(BadDxf, empty_file) {
  EXPECT_EQ(message_of(""), "part.dxf: is empty, expected a DXF file");
  EXPECT_EQ(message_of(" \r\n \r\n"), "part.dxf: is empty, expected a DXF file");
}

TEST(BadDxf, drawing_in_dwg) {
  EXPECT_EQ(message_of(std::string("AC1027\0\0\0\0", 10)),
            "part.dxf: is a DWG file, expected a DXF file; save it as DXF");
}

TEST(BadDxf, picture) {
  EXPECT_EQ(message_of(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)),
            "part.dxf: is neither text nor a binary DXF file, expected a DXF file");
}

TEST(BadDxf, other_text) {
  EXPECT_EQ(message_of("solid cube\nfacet\n"),
            "part.dxf: starts with 'solid cube', expected a DXF file, which starts with 0 SECTION");
  EXPECT_EQ(message_of("1.5 2\n2 3\n"),
            "part.dxf: starts with '1.5 2', expected a DXF file, which starts with 0 SECTION");
  EXPECT_THAT(message_of("1\n2\n3\n"), StartsWith("part.dxf:2: found group code 1 with '2', expected 0 with SECTION"));
}

TEST(BadDxf, wide_letters) {
  EXPECT_EQ(message_of("\xFF\xFE 0"), "part.dxf: is UTF-16 text, expected a DXF file; save it as UTF-8");
}

TEST(BadDxf, binary_file_sent_as_text) {
  EXPECT_THAT(message_of("AutoCAD Binary DXF\n\x1a 0"), HasSubstr("was damaged, as by a transfer as text"));
}

TEST(BadDxf, nothing_to_draw) {
  EXPECT_EQ(message_of(group(0, "EOF")),
            "part.dxf:2: the file ends without a section ENTITIES, which holds what is drawn");
}

// ---- What is fine.

TEST(OddDxf, line_ends_may_be_mixed) {
  std::string windows;
  std::string mac;
  std::string mixed;
  int number = 0;
  for (const char c : kLine) {
    windows += c == '\n' ? "\r\n" : std::string(1, c);
    mac += c == '\n' ? '\r' : c;
    mixed += c == '\n' && ++number % 3 == 0 ? "\r\n" : std::string(1, c);
  }
  for (const std::string& text : {kLine, windows, mac, mixed, "\xEF\xBB\xBF" + kLine}) {
    EXPECT_EQ(parsed(text).curves.size(), 1U);
  }
}

TEST(OddDxf, blanks_comments_and_exponents_are_read) {
  const std::string odd =
      "999\nmade by hand\n" + file("   0  \nLINE \n 8\n0\n 10\n 1.5E+01 \n20\n+2e-1\n999\nhalf\n11\n.5\n21\n-7.\n");
  const auto record = parsed(odd).curves.at(0).curve.record();
  EXPECT_EQ(record->numbers, (std::vector<double>{15, 0.2, 0.5, -7}));
}

TEST(OddDxf, no_newline_at_the_end_and_text_behind_it) {
  EXPECT_EQ(parsed(kLine.substr(0, kLine.size() - 1)).curves.size(), 1U);
  EXPECT_EQ(parsed(kLine + "\n\nbye\n").curves.size(), 1U);
}

TEST(OddDxf, what_programs_append_for_themselves_is_passed_over) {
  const std::string own = group(102, "{ACAD_REACTORS") + group(10, "nonsense") + group(102, "}");
  const std::string extended = group(1001, "PROGRAM") + group(1010, 7) + group(1040, "nonsense");
  EXPECT_EQ(parsed(file(group(0, "LINE") + own + line(0, 0, 1, 0).substr(9) + extended)).curves.size(), 1U);
}

// ---- Cut short.

TEST(CutDxf, anywhere) {
  for (std::size_t length = 0; length + 1 < kLine.size(); ++length) {
    const std::string message = message_of(kLine.substr(0, length));
    EXPECT_NE(message, "no error") << length;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(CutDxf, behind_a_number) {
  const std::size_t at = kLine.find("0.5");
  EXPECT_EQ(message_of(kLine.substr(0, at + 4)),
            "part.dxf:10: the file ends here, expected a last line EOF: it has been cut short, export it again");
}

TEST(CutDxf, without_endsec) {
  const std::string end = group(0, "ENDSEC");
  EXPECT_EQ(message_with(kLine, end, ""), "part.dxf:18: found EOF, expected ENDSEC, the end of section ENTITIES");
  EXPECT_THAT(
      message_with(file("", header("$INSUNITS", 4)), end, ""),
      AllOf(StartsWith("part.dxf:10: found group code 0 with 'SECTION', expected 0 ENDSEC, the end of section "),
            HasSubstr("HEADER that starts at part.dxf:2")));
}

TEST(CutDxf, without_endblk) {
  EXPECT_EQ(message_with(with_blocks(block("A", line(0, 0, 1, 0)), ""), group(0, "ENDBLK"), ""),
            "part.dxf:30: found ENDSEC, expected ENDBLK, the end of block 'A'");
}

TEST(CutDxf, polyline_without_seqend) {
  EXPECT_EQ(message_with(file(polyline({{0, 0}, {1, 0}}, 1)), record("SEQEND", {}), line(0, 0, 1, 0)),
            "part.dxf:44: found LINE, expected VERTEX or SEQEND, the end of the POLYLINE that starts at part.dxf:6");
}

// ---- Numbers.

TEST(BadDxfNumber, group_code) {
  EXPECT_EQ(message_with(kLine, " 20\n", " 2o\n"),
            "part.dxf:11: '2o' is not a group code, expected a whole number from -5 to 1071");
  EXPECT_THAT(message_with(kLine, " 20\n", "20.5\n"), StartsWith("part.dxf:11: '20.5' is not a group code"));
  EXPECT_THAT(message_with(kLine, " 20\n", "99999\n"), StartsWith("part.dxf:11: '99999' is not a group code"));
  EXPECT_THAT(message_with(kLine, " 20\n", "\n"), StartsWith("part.dxf:11: '' is not a group code"));
}

TEST(BadDxfNumber, coordinate) {
  EXPECT_EQ(message_with(kLine, "0.5", "0,5"), "part.dxf:10: expected a number behind group code 10, found '0,5'");
  EXPECT_THAT(message_with(kLine, "0.5", ""),
              StartsWith("part.dxf:10: expected a number behind group code 10, found ''"));
  EXPECT_THAT(message_with(kLine, "0.5", "0x5"),
              StartsWith("part.dxf:10: expected a number behind group code 10, found '0x5'"));
  for (const std::string number : {"inf", "-inf", "nan", "1e76", "-1e300", "1e999"}) {
    EXPECT_EQ(message_with(kLine, "0.5", number),
              "part.dxf:10: expected a finite number of at most 1e+75 behind group code 10, found '" + number + "'");
  }
}

TEST(BadDxfNumber, flag) {
  EXPECT_EQ(message_with(file(light_polyline({{0, 0}, {1, 0}}, true)), " 70\n1\n", " 70\n1.5\n"),
            "part.dxf:12: expected a whole number behind group code 70, found '1.5'");
}

TEST(BadDxfNumber, bulge) {
  EXPECT_EQ(message_of(file(light_polyline({{0, 0, 2e4}, {1, 0}}, false))),
            "part.dxf:18: the bulge 20000 is nonsense, expected one from -10000 to 10000");
  EXPECT_THAT(message_of(file(polyline({{0, 0, -2e4}, {1, 0}}, 0))), HasSubstr("the bulge -20000 is nonsense"));
}

TEST(BadDxfNumber, long_values_are_cut_in_messages) {
  EXPECT_THAT(
      message_with(kLine, "0.5", std::string(1000, '7') + "x"),
      StartsWith("part.dxf:10: expected a number behind group code 10, found '" + std::string(60, '7') + "...'"));
}

// ---- Entities that lack something.

TEST(BadDxfEntity, without_what_it_needs) {
  EXPECT_EQ(message_of_entity("LINE", {{10, 0}, {20, 0}, {11, 1}}),
            "part.dxf:6: LINE without its point (group codes 11 and 21)");
  EXPECT_EQ(message_of_entity("CIRCLE", {{10, 0}, {20, 0}}), "part.dxf:6: CIRCLE without its radius (group code 40)");
  EXPECT_EQ(message_of_entity("ARC", {{10, 0}, {20, 0}, {40, 1}, {50, 0}}),
            "part.dxf:6: ARC without its angles (group codes 50 and 51)");
  EXPECT_THAT(message_of_entity("ELLIPSE", {{10, 0}, {20, 0}, {11, 1}, {21, 0}, {41, 0}, {42, 1}}),
              HasSubstr("ELLIPSE without the ratio of its axes"));
  EXPECT_THAT(message_of_entity("SPLINE", {{71, 3}}), HasSubstr("SPLINE without points"));
  EXPECT_THAT(message_of_entity("INSERT", {{10, 0}, {20, 0}}), HasSubstr("INSERT without its block's name"));
  EXPECT_THAT(message_of_entity("LWPOLYLINE", {{10, 0}}), HasSubstr("without the y of each of its vertices"));
  EXPECT_THAT(message_of_entity("LWPOLYLINE", {{42, 1}}), HasSubstr("a value of a vertex before the first vertex"));
}

TEST(BadDxfEntity, with_sizes_that_make_no_sense) {
  EXPECT_THAT(message_of_entity("ARC", {{10, 0}, {20, 0}, {40, -1}, {50, 0}, {51, 90}}),
              HasSubstr("ARC has the radius -1, expected one of at least 0"));
  EXPECT_THAT(message_of_entity("ELLIPSE", {{10, 0}, {20, 0}, {11, 1}, {21, 0}, {40, 0}, {41, 0}, {42, 1}}),
              HasSubstr("has axes of ratio 0"));
}

TEST(BadDxfEntity, with_counts_that_lie) {
  EXPECT_EQ(message_with(file(light_polyline({{0, 0}, {1, 0}}, true)), " 90\n2\n", " 90\n1000000000\n"),
            "part.dxf:6: LWPOLYLINE says that it has 1000000000 vertices, but has 2");
  const Numbers spline = {{71, 1}, {72, 1000000000}, {40, 0}, {40, 0}, {40, 1},
                          {40, 1}, {10, 0},          {20, 0}, {10, 1}, {20, 0}};
  EXPECT_EQ(message_of_entity("SPLINE", spline), "part.dxf:6: SPLINE says that it has 1000000000 knots, but has 4");
}

Numbers spline_with(int degree, const std::vector<double>& knots, const std::vector<double>& weights) {
  Numbers numbers = {{71, degree}};
  for (const double knot : knots) numbers.emplace_back(40, knot);
  for (const double weight : weights) numbers.emplace_back(41, weight);
  for (const double x : {0.0, 1.0, 2.0}) numbers.insert(numbers.end(), {{10, x}, {20, x * x}});
  return numbers;
}

TEST(BadDxfEntity, spline_that_is_none) {
  const std::string where = "part.dxf:6: SPLINE on layer '0': ";
  EXPECT_THAT(message_of_entity("SPLINE", spline_with(2, {0, 0, 0, 1, 1}, {})), StartsWith(where + "expected 6 knots"));
  EXPECT_THAT(message_of_entity("SPLINE", spline_with(2, {0, 0, 0, 1, 0.5, 1}, {})),
              StartsWith(where + "expected knots in rising order"));
  EXPECT_THAT(message_of_entity("SPLINE", spline_with(2, {0, 0, 0, 1, 1, 1}, {1, 1})),
              StartsWith(where + "expected one weight for each"));
  EXPECT_THAT(message_of_entity("SPLINE", spline_with(2, {0, 0, 0, 1, 1, 1}, {1, 0, 1})),
              StartsWith(where + "expected weights above 0"));
  EXPECT_THAT(message_of_entity("SPLINE", spline_with(0, {0, 0, 1, 1}, {})),
              StartsWith(where + "expected a spline of degree"));
  EXPECT_THAT(message_of_entity("SPLINE", spline_with(2000000000, {}, {})),
              StartsWith(where + "expected a spline of degree"));
}

TEST(BadDxfEntity, vertex_on_its_own) {
  EXPECT_EQ(message_of_entity("VERTEX", {{10, 0}}), "part.dxf:6: VERTEX stands outside a POLYLINE");
}

// ---- Not flat.

TEST(SpatialDxf, tilted_entity) {
  EXPECT_EQ(message_of_entity("CIRCLE", {{10, 0}, {20, 0}, {40, 1}, {210, 1}, {220, 0}, {230, 0}}),
            "part.dxf:6: CIRCLE is tilted by its extrusion (1, 0, 0), expected a flat drawing, with (0, 0, 1) or "
            "(0, 0, -1)");
  EXPECT_THAT(message_of_entity("ARC", {{10, 0}, {20, 0}, {40, 1}, {50, 0}, {51, 9}, {230, 0}}),
              HasSubstr("is tilted"));
}

TEST(SpatialDxf, heights_that_differ) {
  EXPECT_EQ(message_of_entity("LINE", {{10, 0}, {20, 0}, {30, 1}, {11, 1}, {21, 0}, {31, 2}}),
            "part.dxf:6: lies at z = 2 and the first curve at 1, expected a flat drawing");
  EXPECT_EQ(message_of(file(line(0, 0, 1, 0) + light_polyline({{0, 0}, {1, 1}}, false, {{38, 0.1}}))),
            "part.dxf:18: lies at z = 0.1 and the first curve at 0, expected a flat drawing");
  EXPECT_THAT(message_of_entity("ELLIPSE", {{10, 0}, {20, 0}, {11, 1}, {21, 0}, {31, 1}, {40, 1}, {41, 0}, {42, 1}}),
              HasSubstr("expected a flat drawing"));
}

TEST(SpatialDxf, polyline_in_space) {
  std::string text = record("POLYLINE", {{66, 1}, {70, 8}});
  for (const double z : {0.0, 1.0, 2.0}) text += record("VERTEX", {{10, z}, {20, 0}, {30, z}, {70, 32}});
  EXPECT_THAT(message_of(file(text + record("SEQEND", {}))), HasSubstr("expected a flat drawing"));
}

}  // namespace
}  // namespace dxf_bad_files_test
