// What goes wrong is said in one line that names the place and the cure; nothing is printed or written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cli.hpp"

namespace cli_errors_test {
namespace {

using cli::run;
using cli::run_words;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

struct Mistake {
  std::string name;
  std::string command;
  std::vector<std::string> expected;  // pieces of the message
};

std::ostream& operator<<(std::ostream& out, const Mistake& mistake) { return out << "rollfix " << mistake.command; }

void write_files(const cli::Folder& folder) {
  folder.write("few.csv", "0 0\n1 0\n");
  folder.write("nan.csv", "0 0\n1 0\n1 nan\n0 1\n");
  folder.write("twice.csv", "0 0\n1 0\n1 0\n0 1\n");
  folder.write("bow.csv", "0 0\n2 2\n2 0\n0 2\n");
  folder.write("word.csv", "0 0\n1 0\n1 l.5\n0 1\n");
  folder.write("cusp.csv", "0 0\n1 0\n2 1\n1 0\n0 0\n0 2\n");
  folder.write("square.csv", "0 0\n1 0\n1 1\n0 1\n");
  folder.write("broken.json", "{\"gallery\": \"ellipse\",\n \"parameters\": {\"a\": 2]}");
  folder.write("typo.json", R"({"gallery": "elipse"})");
  folder.write("other.json", R"({"schema": 1})");
  folder.write("field.json", R"({"gallery": "ellipse", "params": {"a": 2}})");
  folder.write("list.json", R"({"gallery": "ellipse", "parameters": {"a": [2]}})");
  folder.write("huge.json", R"({"gallery": "ellipse", "parameters": {"a": 1e999}})");
  folder.write("deep.json", "{\"curves\": " + std::string(100000, '[') + std::string(100000, ']') + "}");
  folder.write("cell.csv", "time,u,psi\n0,0,0\n1,abc,1\n");
  folder.write("roll.csv", "time,u,psi\n0,0,0\n1,-1,2\n");
  folder.write("exists.svg", "old");
}

class Mistakes : public testing::TestWithParam<Mistake> {};

}  // namespace

TEST_P(Mistakes, are_told_in_one_line) {
  const cli::Folder folder;
  write_files(folder);
  const std::vector<std::string> before = folder.files();
  const cli::Ran ran = run(GetParam().command);
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, StartsWith("rollfix: "));
  EXPECT_THAT(ran.err, EndsWith("\n"));
  // The names that are known have a line of their own.
  const int lines = ran.err.find("\n  Known are: ") == std::string::npos ? 1 : 2;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), lines) << ran.err;
  for (const std::string& piece : GetParam().expected) EXPECT_THAT(ran.err, HasSubstr(piece));
  EXPECT_EQ(folder.files(), before);
  EXPECT_EQ(cli::read("exists.svg"), "old");
}

const std::vector<Mistake> kParts = {
    {"missing_file", "inspect missing.csv", {"missing.csv", "no such file"}},
    {"folder_for_a_file", "inspect .", {"."}},
    {"no_part", "inspect", {"expected a PART"}},
    {"too_few_points", "inspect few.csv", {"few.csv", "2 different points", "at least 3"}},
    {"not_a_number", "inspect nan.csv", {"nan.csv:3", "nan"}},
    {"repeated_point", "inspect twice.csv", {"twice.csv", "lines 2 and 3", "(1, 0)"}},
    {"self_crossing", "inspect bow.csv", {"bow.csv", "(1, 1)", "--allow-crossing"}},
    {"cusp", "inspect cusp.csv", {"cusp.csv", "cusp", "arc length"}},
    {"word_in_line_3", "inspect word.csv", {"word.csv:3", "l.5"}},
    {"unknown_ending", "inspect part.step", {"part.step", ".step"}},
    {"unknown_shape", "inspect gallery:elipse", {"did you mean 'ellipse'?", "limacon"}},
    {"unknown_parameter", "inspect gallery:ellipse,c=1", {"'c'", "Known are: a, b"}},
    {"impossible_parameter", "inspect gallery:ellipse,a=-1", {"a = '-1'", "above 0"}},
    {"option_for_points", "inspect gallery:ellipse --open", {"--open is for points"}},
    {"default_corner_angle_of_no_points", "inspect gallery:cam --corner-angle 59deg", {"--corner-angle is for points"}},
    {"corner_angle_without_unit", "inspect square.csv --corner-angle 59", {"59deg"}},
    {"corner_angle_of_letters", "inspect square.csv --corner-angle x", {"--corner-angle", "'x'", "73deg"}},
    {"broken_json", "inspect broken.json", {"broken.json:2:23"}},
    {"typo_in_json", "inspect typo.json", {"typo.json", "did you mean 'ellipse'?"}},
    {"other_json", "inspect other.json", {"other.json", "gallery"}},
    {"unknown_field_in_json", "inspect field.json", {"field.json", "'params'"}},
    {"list_in_json", "inspect list.json", {"list.json", "'a'", "array"}},
    {"brackets_too_deep_in_json", "inspect deep.json", {"deep.json", "nested more than 100 deep"}},
    {"huge_number_in_json", "inspect huge.json", {"huge.json", "out of range"}},
};

const std::vector<Mistake> kReadings = {
    {"no_reading", "locate gallery:cam", {"--reading", "--log", "--touch"}},
    {"one_number", "locate gallery:cam --reading 1", {"LENGTH,TURN", "1 number"}},
    {"one_of_two_fingers", "locate gallery:cam --reading 1,2,3", {"at least two readings", "facing"}},
    {"facing_of_one_finger", "locate gallery:cam --reading 1,2 --facing 3deg", {"--facing", "LA,LB,THETA"}},
    {"readings_of_one_and_of_two", "locate gallery:cam --reading 1,2 --reading 1,2,3", {"1,2", "2 numbers"}},
    {"four_numbers", "locate gallery:cam --reading 0,5,1,2", {"4 numbers", "decimal comma"}},
    {"letters", "locate gallery:cam --reading 1,x", {"--reading 1,x", "'x'"}},
    {"nan", "locate gallery:cam --reading nan,1", {"'nan'", "finite"}},
    {"minus_infinity", "locate gallery:cam --reading -inf,1", {"'-inf'", "finite"}},
    {"length_in_degrees", "locate gallery:cam --reading 5deg,1", {"'5deg' is not a number"}},
    {"longer_than_an_open_curve",
     "locate gallery:exponential --reading 100,1",
     {"gallery:exponential", "10.014", "100"}},
    {"readings_and_log", "locate gallery:cam --reading 1,1 --log roll.csv", {"found both"}},
    {"at_without_log", "locate gallery:cam --reading 1,1 --at 2", {"--at", "--log"}},
    {"negative_tolerance", "locate gallery:cam --reading 1,1 --tolerance -1", {"--tolerance", "negative"}},
    {"budget_of_nothing", "locate gallery:cam --reading 1,1 --budget 0", {"--budget", "'0'", "at least 1"}},
};

const std::vector<Mistake> kLogs = {
    {"missing_log", "locate gallery:cam --log no.csv --finger disk,r=1", {"no.csv", "no such file"}},
    {"letters_in_a_cell", "locate gallery:cam --log cell.csv --finger disk,r=1", {"cell.csv:3", "'abc'"}},
    {"no_finger", "locate gallery:cam --log roll.csv", {"roll.csv", "--finger disk,r="}},
    {"finger_without_a_radius", "locate gallery:cam --log roll.csv --finger disk", {"disk,r=0.1", "jaw", "outline"}},
    {"finger_file_missing", "locate gallery:cam --log roll.csv --finger pad.csv", {"--finger pad.csv", "no such file"}},
    {"finger_that_is_concave",
     "locate gallery:cam --log roll.csv --finger gallery:limacon,a=1,b=0.9",
     {"--finger gallery:limacon,a=1,b=0.9", "a concave place"}},
    {"roll_0", "locate gallery:cam --log roll.csv --finger disk,r=1 --roll 0", {"--roll", "at least 1"}},
    {"roll_without_log", "locate gallery:cam --reading 1,1 --roll 1", {"--roll", "--log"}},
    {"roll_of_two_logs", "locate gallery:cam --log roll.csv --log roll.csv --roll 1", {"--roll", "more than once"}},
    {"jaw_on_a_flat_side", "simulate gallery:stadium --finger jaw --start 0.5 --length 0.1", {"flat jaw", "curvature"}},
    {"contact_of_a_disk",
     "simulate gallery:cam --finger disk,r=1 --start 1 --length 1 --contact 1",
     {"--contact", "--contact-angle"}},
    {"contact_angle_of_a_jaw",
     "simulate gallery:cam --finger jaw --start 1 --length 1 --contact-angle 1",
     {"--contact-angle", "--contact"}},
    {"seed_without_noise",
     "simulate gallery:cam --finger disk,r=1 --start 1 --length 1 --seed 1",
     {"--seed", "--noise"}},
    {"unknown_noise",
     "simulate gallery:cam --finger disk,r=1 --start 1 --length 1 --noise jitter=1",
     {"--noise jitter=1", "contact"}},
    {"radius_of_a_jaw",
     "simulate gallery:cam --finger jaw --start 1 --length 1 --noise radius=1",
     {"leave the radius out"}},
    {"two_jaws_by_angles",
     "simulate gallery:cam --finger jaw --start 1 --start 4 --length 1 --length 1 --contact-angle 1",
     {"--contact-angle is of a disk", "--contact, an arc length"}},
    {"reach_of_an_outline", "inspect gallery:cam --finger gallery:ellipse", {"disks and jaws"}},
    {"negative_radius", "locate gallery:cam --log roll.csv --finger disk,r=-1", {"disk,r=-1", "above 0"}},
    {"three_logs", "locate gallery:cam --log roll.csv --log roll.csv --log roll.csv", {"--log", "3 times"}},
    {"facing_beside_logs",
     "locate gallery:cam --log roll.csv --log roll.csv --finger disk,r=1 --facing 1",
     {"--facing", "log"}},
    {"two_fingers", "locate gallery:cam --log roll.csv --finger disk,r=1 --finger disk,r=1", {"--finger", "2 fingers"}},
    {"no_such_instant", "locate gallery:cam --log roll.csv --finger disk,r=1 --at 7", {"roll.csv", "7"}},
    {"everything_from_stdin", "locate - --log -", {"standard input"}},
    {"no_start", "simulate gallery:cam --finger disk,r=1 --length 1", {"--start"}},
    {"no_length", "simulate gallery:cam --finger disk,r=1 --start 1", {"--length", "--rotation", "neither"}},
    {"disk_too_big",
     "simulate gallery:limacon --finger disk,r=1 --start 3 --length 4",
     {"gallery:limacon", "s = ", "radius"}},
    {"off_the_end", "simulate gallery:exponential --finger disk,r=0.1 --start 9 --length 5", {"end", "10.014"}},
    {"one_sample",
     "simulate gallery:cam --finger disk,r=1 --start 0 --length 1 --samples 1",
     {"--samples", "at least 2"}},
};

const std::vector<Mistake> kUsage = {
    {"nothing", "", {"expected a command", "locate", "--help"}},
    {"unknown_command",
     "lcoate gallery:cam",
     {"'lcoate'", "did you mean 'locate'?",
      "inspect, locate, advise, catalog, identify, simulate, plan, teach, watch, demo"}},
    {"unknown_option", "inspect gallery:cam --opne", {"--opne", "did you mean '--open'?", "--corner-angle"}},
    {"option_before_command", "--json inspect gallery:cam", {"--json", "behind"}},
    {"option_without_value", "locate gallery:cam --reading", {"--reading", "expected a value"}},
    {"option_twice", "locate gallery:cam --reading 1,1 --budget 1 --budget 2", {"--budget", "more than once"}},
    {"value_for_a_flag", "inspect gallery:cam --json=yes", {"--json takes no value"}},
    {"two_parts", "inspect gallery:cam gallery:gear", {"'gallery:gear'", "too many"}},
    {"existing_figure", "inspect gallery:cam -o exists.svg", {"exists.svg", "--force"}},
    {"existing_log",
     "simulate gallery:cam --finger disk,r=1 --start 0 --length 1 -o roll.csv",
     {"roll.csv", "--force"}},
    {"unknown_figure", "inspect gallery:cam -o cam.jpg", {"cam.jpg", ".svg, .png or .pdf"}},
    {"figure_in_no_folder", "inspect gallery:cam -o no/cam.svg", {"no/cam.svg", "no folder no"}},
    {"figure_and_json_on_stdout", "inspect gallery:cam --json -o -", {"-o -", "--json"}},
    {"demo_in_a_file", "demo -o square.csv", {"square.csv", "folder"}},
};

const std::vector<Mistake> kWatch = {
    {"no_noise", "watch gallery:cam --finger disk,r=1 --log roll.csv", {"--noise contact=0.1,angle=0.5deg"}},
    {"noise_of_nothing",
     "watch gallery:cam --finger disk,r=1 --noise slip=0.1 --log roll.csv --once",
     {"noise", "contact", "angle"}},
    {"no_finger", "watch gallery:cam --noise angle=0.01 --log roll.csv --once", {"roll.csv", "--finger disk,r="}},
    {"missing_log", "watch gallery:cam --noise angle=0.01 --log no.csv", {"no.csv", "no such file", "tcp:HOST:PORT"}},
    {"no_port", "watch gallery:cam --noise angle=0.01 --log tcp:robot:", {"tcp:robot:", "port"}},
    {"prior_without_sd", "watch gallery:cam --noise angle=0.01 --log roll.csv --prior 1", {"--prior 1", "S,SD"}},
    {"prior_without_doubt", "watch gallery:cam --noise angle=0.01 --log roll.csv --prior 1,0", {"not above 0"}},
    {"both_ways_to_tell",
     "watch gallery:cam --noise angle=0.01 --log roll.csv --every 5 --on-change",
     {"--every", "--on-change"}},
    {"every_0", "watch gallery:cam --noise angle=0.01 --log roll.csv --every 0", {"--every", "at least 1"}},
    {"idle_for_no_time", "watch gallery:cam --noise angle=0.01 --log roll.csv --idle-timeout 0", {"above 0"}},
    {"everything_from_stdin", "watch - --noise angle=0.01 --log -", {"standard input"}},
};

std::string mistake_name(const testing::TestParamInfo<Mistake>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Part, Mistakes, testing::ValuesIn(kParts), mistake_name);
INSTANTIATE_TEST_SUITE_P(Reading, Mistakes, testing::ValuesIn(kReadings), mistake_name);
INSTANTIATE_TEST_SUITE_P(Log, Mistakes, testing::ValuesIn(kLogs), mistake_name);
INSTANTIATE_TEST_SUITE_P(Watch, Mistakes, testing::ValuesIn(kWatch), mistake_name);
INSTANTIATE_TEST_SUITE_P(Usage, Mistakes, testing::ValuesIn(kUsage), mistake_name);

TEST(Options, that_do_not_exist_are_an_error_and_not_ignored) {
  const cli::Ran ran = run_words({"locate", "gallery:cam", "--reading", "1,1", "--certificate", "1"});
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_THAT(ran.err, HasSubstr("locate has no option --certificate"));
}

TEST(Commands, that_do_not_exist_yet_are_an_error) {
  for (const char* command : {"verify"}) {
    const cli::Ran ran = run_words({command, "gallery:cam"});
    EXPECT_EQ(ran.code, 2) << command;
    EXPECT_THAT(ran.err, HasSubstr(std::string("there is no command '") + command + "'"));
  }
}

TEST(Messages, stay_on_one_line_whatever_a_name_holds) {
  const cli::Ran ran = run_words({"inspect", "two\nlines.csv"});
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
}

TEST(Messages, send_no_control_characters_to_a_terminal) {
  const cli::Ran ran = run_words({"inspect", "red\x1b[31m.csv"});
  EXPECT_EQ(ran.code, 2);
  EXPECT_EQ(ran.err.find('\x1b'), std::string::npos) << ran.err;
}

/// ESC, C1's CSI, the mark that writes from right to left, a line's end, and a byte that is no character.
const std::string kHostile =
    "a\x1b[31m\xC2\x9B"
    "2J\xE2\x80\xAE"
    "b\nc\xFF";

/// Nothing but text and the ends of its lines.
void expect_harmless(const std::string& text) {
  for (const char* const piece : {"\x1b", "\xC2\x9B", "\xE2\x80\xAE", "\xFF", "b\nc"}) {
    EXPECT_EQ(text.find(piece), std::string::npos) << text;
  }
}

TEST(Names, from_outside_do_nothing_to_a_terminal_and_break_no_table) {
  const cli::Folder folder;
  const std::string name = kHostile + ".csv";
  folder.write(name, "0,0\n10,0\n10,10\n0,10\n");
  folder.write("bad" + name, "0,0\n10,10\n10,0\n0,10\n");
  folder.write("log" + name, "stamp,contact" + kHostile.substr(0, 8) + "_deg,yaw_deg\n0,1,2\n");
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"inspect", name},
           {"inspect", name, "--json"},
           {"inspect", name, "-o", "-"},
           {"locate", name, "--reading", "3,90deg"},
           {"locate", name, "--reading", "3,90deg", "--json"},
           {"locate", name, "--reading", "3,90deg", "-o", "new" + name + ".svg"},
           {"locate", name, "--log", "log" + name, "--finger", "disk,r=1"},
           {"catalog", "build", ".", "-o", "parts.db"},
           {"catalog", "list", "parts.db"},
           {"catalog", "list", "parts.db", "--json"},
           {"identify", "parts.db", "--reading", "3,90deg"},
           {"watch", name, "--log", "log" + name, "--once", "--finger", "disk,r=1", "--noise", "angle=0.1"}}) {
    const cli::Ran ran = run_words(words);
    EXPECT_NE(ran.code, 4) << ran.err;
    expect_harmless(ran.out);
    expect_harmless(ran.err);
  }
}

TEST(Names, in_json_read_back_as_they_are_but_for_bytes_that_are_no_text) {
  const cli::Folder folder;
  const std::string name = kHostile.substr(0, kHostile.size() - 1) + ".csv";
  folder.write(name, "0,0\n10,0\n10,10\n0,10\n");
  const cli::Ran ran = run_words({"inspect", name, "--json"});
  EXPECT_THAT(ran.out, HasSubstr("\\u009b2J\\u202e"));
  EXPECT_EQ(ran.json()["part"]["name"], name);
}

TEST(Units, from_outside_do_nothing_to_a_terminal) {
  const cli::Folder folder;
  folder.write("disk.json",
               R"({"curves": [{"type": "arc", "centre": [0, 0], "radius": 1}], "unit": "m\u001b[31m\u009b\u202e\nm"})");
  const cli::Ran ran = run("inspect disk.json");
  for (const std::string& text : {ran.out, ran.err}) expect_harmless(text);
}

TEST(HintsToPaste, are_one_word_to_a_shell) {
  const cli::Folder folder;
  folder.write("log.csv", "time,contact$(id>PWN)_deg,yaw_deg\n0,1,2\n");
  const std::string err = run("locate gallery:cam --log log.csv --finger disk,r=0.2").err;
  const std::size_t at = err.find("--columns ");
  ASSERT_NE(at, std::string::npos) << err;
  const std::string hint = err.substr(at, err.find('\n', at) - at);
  cli::shell("printf '%s' " + hint.substr(0, hint.rfind('\'') + 1));
  EXPECT_FALSE(cli::fs::exists("PWN")) << hint;
}

TEST(UnreadableFile, is_named) {
  const cli::Folder folder;
  folder.write("locked.csv", "0 0\n1 0\n0 1\n");
  cli::fs::permissions("locked.csv", cli::fs::perms::none);
  if (std::ifstream("locked.csv")) GTEST_SKIP() << "this user may read everything";
  const cli::Ran ran = run("inspect locked.csv");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("locked.csv: can't be opened"));
}

TEST(StandardOutput, that_is_full_is_an_error) {
  if (!cli::fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const cli::Ran ran = cli::shell("rollfix inspect gallery:cam > /dev/full");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("standard output"));
}

}  // namespace cli_errors_test
