// Figures as files: three formats from one drawing, and never half a file.
#include "rollfix/draw.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "draw/save.hpp"
#include "draw_helpers.hpp"
#include "paths.hpp"
#include "rollfix/error.hpp"

namespace draw_save_test {
namespace {

namespace fs = std::filesystem;
using rollfix::FigureFormat;
using rollfix::Svg;
using rollfix::Vec2;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

Svg disk(const std::string& colour) {
  Svg svg(120, 70);
  rollfix::Paint paint;
  paint.fill = colour;
  svg.circle({60, 35}, 30, paint);
  return svg;
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string output_of(const std::string& program) {
  std::FILE* pipe = popen(program.c_str(), "r");
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  return text;
}

/// While it lives, no file can grow beyond this many bytes: as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

/// An empty folder of its own for each test.
class SaveFigure : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("rollfix_" + std::to_string(getpid()) + "_" + test->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_;
};

TEST(EncodeFigure, png_has_two_pixels_for_each_of_the_figures) {
  const std::string png = rollfix::encode(disk("#336699"), FigureFormat::png);
  ASSERT_THAT(png, StartsWith("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(big_endian(png, 16), 240U);
  EXPECT_EQ(big_endian(png, 20), 140U);
}

TEST(EncodeFigure, png_is_neither_blank_nor_without_colour) {
  const std::string blank = rollfix::encode(Svg(120, 70), FigureFormat::png);
  const std::string white = rollfix::encode(disk("#ffffff"), FigureFormat::png);
  const std::string red = rollfix::encode(disk("#ff0000"), FigureFormat::png);
  const std::string blue = rollfix::encode(disk("#0000ff"), FigureFormat::png);
  EXPECT_EQ(white, blank);  // the background is white
  EXPECT_NE(red, blank);
  EXPECT_NE(red, blue);
}

TEST(EncodeFigure, gives_the_same_bytes_twice_in_every_format) {
  for (const FigureFormat format : {FigureFormat::svg, FigureFormat::png, FigureFormat::pdf}) {
    EXPECT_EQ(rollfix::encode(disk("#336699"), format), rollfix::encode(disk("#336699"), format));
  }
}

TEST(EncodeFigure, pdf_is_one_and_carries_no_date) {
  const std::string pdf = rollfix::encode(disk("#336699"), FigureFormat::pdf);
  EXPECT_THAT(pdf, AllOf(StartsWith("%PDF-"), EndsWith("%%EOF\n")));
  EXPECT_EQ(pdf.find("CreationDate"), std::string::npos);
}

TEST(EncodeFigure, the_renderer_accepts_any_text_that_a_user_may_give) {
  Svg svg = disk("#336699");
  svg.describe("\xff\x01<&>\"");
  svg.text({5, 20}, {{"\xff\x01<&>\""}});
  EXPECT_NO_THROW(rollfix::encode(svg, FigureFormat::png));
}

TEST(EncodeFigure, without_the_renderer_says_what_to_install_and_what_works_all_the_same) {
  EXPECT_THAT([] { rollfix::draw::render_png("<svg/>", 1, 1, 1, "librsvg-missing.so"); },
              ThrowsMessage<rollfix::InputError>(
                  AllOf(HasSubstr("librsvg-missing.so"), HasSubstr("librsvg2-2"), HasSubstr(".svg"))));
}

TEST(EncodeFigure, asks_for_a_renderer_only_when_a_png_or_pdf_is_drawn) {
  setenv("LD_TRACE_LOADED_OBJECTS", "1", 1);  // the loader prints what the program needs instead of running it
  const std::string libraries = output_of(kProgram);
  unsetenv("LD_TRACE_LOADED_OBJECTS");
  EXPECT_THAT(libraries, AllOf(HasSubstr("libc."), Not(HasSubstr("librsvg")), Not(HasSubstr("libcairo"))));
}

TEST(FigureFormat, goes_by_the_files_ending_in_either_case) {
  EXPECT_EQ(rollfix::figure_format("a/b.svg"), FigureFormat::svg);
  EXPECT_EQ(rollfix::figure_format("b.PNG"), FigureFormat::png);
  EXPECT_EQ(rollfix::figure_format("c.d.pdf"), FigureFormat::pdf);
}

TEST(FigureFormat, lists_the_known_endings_for_an_unknown_one) {
  EXPECT_THAT([] { rollfix::figure_format("plot.jpg"); },
              ThrowsMessage<rollfix::InputError>(
                  AllOf(HasSubstr("plot.jpg"), HasSubstr(".svg, .png or .pdf"), HasSubstr("found \".jpg\""))));
  EXPECT_THAT([] { rollfix::figure_format("plot"); }, ThrowsMessage<rollfix::InputError>(HasSubstr("found no ending")));
}

TEST_F(SaveFigure, writes_what_encode_gives_and_nothing_else) {
  for (const std::string name : {"a.svg", "a.png", "a.pdf"}) {
    rollfix::save_figure(disk("#336699"), folder_ / name);
    EXPECT_EQ(content(folder_ / name), rollfix::encode(disk("#336699"), rollfix::figure_format(name)));
  }
  EXPECT_EQ(files(), 3);
}

TEST_F(SaveFigure, replaces_an_older_file) {
  std::ofstream(folder_ / "a.svg") << "old";
  rollfix::save_figure(disk("#336699"), folder_ / "a.svg");
  EXPECT_EQ(content(folder_ / "a.svg"), disk("#336699").str());
}

TEST_F(SaveFigure, writes_through_a_link_and_keeps_it) {
  std::ofstream(folder_ / "target.svg") << "old";
  fs::create_symlink(folder_ / "target.svg", folder_ / "link.svg");
  rollfix::save_figure(disk("#336699"), folder_ / "link.svg");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.svg"));
  EXPECT_EQ(content(folder_ / "target.svg"), disk("#336699").str());
}

TEST_F(SaveFigure, says_why_a_place_cannot_be_written_to_and_leaves_nothing_behind) {
  const fs::path nowhere = folder_ / "missing" / "a.svg";
  EXPECT_THAT([&] { rollfix::save_figure(disk("#336699"), nowhere); },
              ThrowsMessage<rollfix::InputError>(AllOf(HasSubstr(nowhere.string()), HasSubstr("No such file"))));
  EXPECT_EQ(files(), 0);
}

TEST_F(SaveFigure, keeps_the_older_file_and_nothing_else_when_the_disk_is_full) {
  std::ofstream(folder_ / "a.svg") << "old";
  std::string message;
  {
    const FullDisk full(100);
    try {
      rollfix::save_figure(disk("#336699"), folder_ / "a.svg");
    } catch (const rollfix::InputError& error) {
      message = error.what();
    }
  }
  EXPECT_THAT(message, HasSubstr("File too large"));
  EXPECT_EQ(content(folder_ / "a.svg"), "old");
  EXPECT_EQ(files(), 1);
}

TEST_F(SaveFigure, leaves_a_folder_of_that_name_alone) {
  fs::create_directory(folder_ / "a.png");
  EXPECT_THAT([&] { rollfix::save_figure(disk("#336699"), folder_ / "a.png"); },
              ThrowsMessage<rollfix::InputError>(HasSubstr("Is a directory")));
  EXPECT_EQ(files(), 1);
}

TEST_F(SaveFigure, leaves_nothing_behind_for_an_unknown_ending) {
  EXPECT_THROW(rollfix::save_figure(disk("#336699"), folder_ / "a.bmp"), rollfix::InputError);
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace draw_save_test
