// What the program writes appears whole or not at all, whatever happens to it, and no half of it is left beside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/report.hpp"

namespace cli_whole_files_test {
namespace {

using cli::run;
using cli::shell;
using testing::HasSubstr;

const std::string kSimulate = "simulate gallery:cam --finger disk,r=0.2 --start 1 --length 1 ";
using Names = std::vector<std::string>;

}  // namespace

TEST(FullDisk, leaves_nothing_behind_and_is_told) {
  const cli::Folder folder;
  for (const std::string command : {"inspect gallery:cam -o a.svg", "inspect gallery:gear -o a.csv"}) {
    const cli::Ran ran = shell("ulimit -f 2; rollfix " + command);  // blocks of 512 or 1024 bytes
    EXPECT_EQ(ran.code, 2);
    EXPECT_THAT(ran.err, HasSubstr("can't be written: File too large"));
    EXPECT_EQ(folder.files(), Names{});
  }
}

TEST(FullDisk, leaves_an_older_file_as_it_was) {
  const cli::Folder folder;
  folder.write("a.svg", "old");
  EXPECT_EQ(shell("ulimit -f 2; rollfix inspect gallery:cam -o a.svg --force").code, 2);
  EXPECT_EQ(cli::read("a.svg"), "old");
  EXPECT_EQ(folder.files(), Names{"a.svg"});
}

TEST(SeveralFiles, of_which_one_can_not_be_written_are_all_left_out) {
  const cli::Folder folder;
  folder.write("a.csv", "old");
  EXPECT_THROW(rollfix::app::write_files({{"a.csv", "new"}, {"no/b.csv", "new"}}), rollfix::InputError);
  EXPECT_EQ(cli::read("a.csv"), "old");
  EXPECT_EQ(folder.files(), Names{"a.csv"});
}

TEST(SeveralFiles, of_which_one_came_to_be_meanwhile_are_all_left_out) {
  const cli::Folder folder;
  folder.write("b.csv", "of somebody else");
  EXPECT_THROW(rollfix::app::write_files({{"a.csv", "new", false}, {"b.csv", "new", false}}), rollfix::InputError);
  EXPECT_EQ(cli::read("b.csv"), "of somebody else");
  EXPECT_EQ(folder.files(), Names{"b.csv"});
}

TEST(SeveralFiles, that_are_one_are_refused) {
  const cli::Folder folder;
  const cli::Ran ran = run("locate gallery:ellipse --reading 1.5,73.2deg --certify z.svg -o ./z.svg");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("two files would be written to it"));
  EXPECT_EQ(folder.files(), Names{});
}

TEST(ManyRunsWithOneNewFile, write_it_once_and_the_others_say_that_it_exists) {
  const cli::Folder folder;
  std::string runs;
  for (int k = 0; k < 12; ++k) {
    runs += "{ rollfix " + kSimulate + "--samples 50000 --quiet -o same.csv 2>/dev/null && echo wrote; } & ";
  }
  const std::string out = shell(runs + "wait").out;
  EXPECT_EQ(out, "wrote\n");
}

TEST(PlantedLink, beside_the_output_is_not_followed) {
  const cli::Folder folder;
  folder.write("victim", "precious");
  // The shell's number becomes the program's.
  EXPECT_EQ(shell("ln -s victim .a.svg.$$; exec rollfix inspect gallery:cam --quiet -o a.svg").code, 0);
  EXPECT_EQ(cli::read("victim"), "precious");
}

TEST(LongNames, are_written_up_to_the_longest_that_a_folder_takes) {
  const cli::Folder folder;
  const std::string name = std::string(251, 'a') + ".svg";
  EXPECT_EQ(run("inspect gallery:cam -o " + name).code, 0);
  EXPECT_EQ(folder.files(), Names{name});
}

TEST(FullStandardOutput, is_told_for_help_and_version_too) {
  const cli::Folder folder;
  ASSERT_EQ(run("locate gallery:ellipse --reading 1.5,73.2deg --certify proof").code, 0);
  for (const std::string command : {"--help", "--version", "locate --help"}) {
    EXPECT_EQ(shell("rollfix " + command + " > /dev/full").code, 2) << command;
    EXPECT_EQ(shell("rollfix " + command + " >&-").code, 2) << command;
  }
  for (const std::string command : {"--help", "proof"}) {
    EXPECT_EQ(shell("rollfix-verify " + command + " > /dev/full").code, 2) << command;
    EXPECT_EQ(shell("rollfix-verify " + command + " >&-").code, 2) << command;
  }
}

TEST(TwoRunsWithOneFile, leave_the_whole_of_one) {
  const cli::Folder folder;
  const auto roll = [](const std::string& seed, const std::string& file) {
    return "rollfix " + kSimulate + "--samples 2000 --noise angle=0.01 --force --quiet --seed " + seed + " -o " + file;
  };
  EXPECT_EQ(shell(roll("1", "one.csv") + "; " + roll("2", "two.csv")).code, 0);
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(shell(roll("1", "same.csv") + " & " + roll("2", "same.csv") + "; wait").code, 0);
    const std::string same = cli::read("same.csv");
    EXPECT_TRUE(same == cli::read("one.csv") || same == cli::read("two.csv"));
  }
  EXPECT_EQ(folder.files(), (Names{"one.csv", "same.csv", "two.csv"}));
}

TEST(OneFileForTwoLogs, is_refused) {
  const cli::Folder folder;
  const cli::Ran ran =
      run("simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1 --length 2 -o same.csv -o same.csv");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("same.csv"));
  EXPECT_EQ(folder.files(), Names{});
}

TEST(Output, that_is_the_input_is_refused_with_force_as_well) {
  const cli::Folder folder;
  const std::string square = "0 0\n1 0\n1 1\n0 1\n";
  folder.write("square.csv", square);
  cli::fs::create_symlink("square.csv", "link.csv");
  EXPECT_EQ(run("inspect square.csv -o square.csv").code, 2);
  for (const std::string output : {"-o square.csv", "-o ./square.csv", "-o link.csv", "-osquare.csv"}) {
    const cli::Ran ran = run("inspect square.csv --force " + output);
    EXPECT_EQ(ran.code, 2) << output;
    EXPECT_THAT(ran.err, HasSubstr("was read, and would be written over")) << output;
  }
  EXPECT_EQ(run("locate gallery:ellipse --map=square.csv --reading 1.5,73.2deg --certify square.csv --force").code, 2);
  EXPECT_EQ(cli::read("square.csv"), square);
}

TEST(ReplacedFile, keeps_who_may_read_it) {
  const cli::Folder folder;
  folder.write("a.svg", "old");
  cli::fs::permissions("a.svg", cli::fs::perms::owner_read | cli::fs::perms::owner_write);
  EXPECT_EQ(run("inspect gallery:cam -o a.svg --force").code, 0);
  EXPECT_EQ(cli::fs::status("a.svg").permissions(), cli::fs::perms::owner_read | cli::fs::perms::owner_write);
}

TEST(ClosedStandardOutput, is_not_taken_for_a_file_that_is_written) {
  const cli::Folder folder;
  const cli::Ran ran = shell("rollfix inspect gallery:cam -o a.svg >&-");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("standard output can't be written to"));
  EXPECT_THAT(cli::read("a.svg"), testing::EndsWith("</svg>\n"));
}

}  // namespace cli_whole_files_test
