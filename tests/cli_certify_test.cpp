// `rollfix locate --certify`, and the program that checks what it writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli.hpp"

namespace cli_certify_test {
namespace {

using cli::Folder;
using cli::Ran;
using cli::run;

Ran verified(const std::string& certificate) { return cli::shell("rollfix-verify " + certificate); }

TEST(CliCertify, writes_a_certificate_that_the_verifier_proves) {
  const Folder folder;
  const Ran ran = run("locate gallery:cam --reading 0.9,40deg --tolerance 1e-9 --certify proof.json");
  EXPECT_EQ(ran.code, 0);
  EXPECT_EQ(verified("proof.json").code, 0);
  EXPECT_THAT(verified("proof.json").out,
              testing::MatchesRegex("proved: 4 placements, 8 cells, nothing else\npart \"gallery:cam[^\n]*, closed, "
                                    "perimeter [0-9.]+\nreading length 0.9, turn 0.698[0-9]* rad\n"
                                    "tolerance 1e-09 rad\n"));
}

TEST(CliCertify, is_refused_where_its_turn_is_changed) {
  const Folder folder;
  std::string text = run("locate gallery:cam --reading 0.9,40deg --certify -").out;
  const std::size_t at = text.find("\"turn\":0.6");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 10, "\"turn\":0.1");
  folder.write("changed.json", text);
  EXPECT_EQ(verified("changed.json").code, 1);
  EXPECT_THAT(verified("changed.json").out,
              testing::MatchesRegex("refused: row 0, off, in tolerances: stated -?[0-9.e+]+, computed -?[0-9.e+]+\n"));
}

TEST(CliCertify, names_the_field_that_was_changed_by_hand) {
  const Folder folder;
  const std::string text = run("locate gallery:cam --reading 0.9,40deg --certify -").out;
  const auto said_of = [&](const std::string& field, const std::string& instead) {
    std::string changed = text;
    changed.replace(changed.find(field), field.size(), instead);
    folder.write("changed.json", changed);
    EXPECT_EQ(verified("changed.json").code, 2);
    return verified("changed.json").err;
  };
  EXPECT_EQ(said_of("\"turn\":", "\"turn\":\"40deg\",\"was\":"),
            "rollfix-verify: changed.json: /readings/0/turn: expected number, found string\n");
  EXPECT_EQ(said_of("\"turn\":", "\"turned\":"),
            "rollfix-verify: changed.json: /readings/0: expected a field 'turn', found none\n");
}

TEST(CliCertify, proves_that_nothing_fits) {
  const Folder folder;
  EXPECT_EQ(run("locate gallery:cam --reading 0.9,200deg --certify proof.json").code, 1);
  EXPECT_EQ(verified("proof.json").code, 0);
}

TEST(CliCertify, of_several_readings_writes_what_the_verifier_proves) {
  const Folder folder;
  EXPECT_EQ(run("locate gallery:cam --reading 0.4,0.2890632 --reading 0.9,0.6575464 --certify proof.json").code, 0);
  EXPECT_EQ(verified("proof.json").code, 0);
  EXPECT_EQ(run("locate gallery:cam --reading 0.4,0.2890632 --reading 0.9,0.75 --certify none.json").code, 1);
  EXPECT_THAT(verified("none.json").out, testing::StartsWith("proved: 0 placements, "));
}

TEST(CliCertify, of_two_fingers_writes_what_the_verifier_proves) {
  const Folder folder;
  const std::string readings =
      "--reading 0.7446832,-0.3983439,1.0032473 --reading 1.5,-0.8,1.9367925 --tolerance 1e-6 --certify proof.json";
  EXPECT_EQ(run("locate gallery:cam " + readings).code, 0);
  EXPECT_EQ(verified("proof.json").code, 0);
  EXPECT_THAT(verified("proof.json").out, testing::StartsWith("proved: 4 placements, "));
  std::string text = cli::read("proof.json");
  const std::size_t at = text.find("\"turn\":1.936");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 12, "\"turn\":1.836");
  folder.write("changed.json", text);
  EXPECT_EQ(verified("changed.json").code, 1);
}

TEST(CliCertify, of_two_fingers_and_their_facing_is_proved) {
  const Folder folder;
  EXPECT_EQ(
      run("locate gallery:cam --reading 1.5,-0.8,110.97deg --facing -142.4deg --tolerance 1e-6 --certify proof.json")
          .code,
      0);
  EXPECT_EQ(verified("proof.json").code, 0);
}

TEST(CliCertify, of_what_has_no_certificate_is_an_error) {
  const Folder folder;
  for (const char* arguments :
       {"--reading 1.5,-0.8,110.97deg --facing -142.4deg --mirror", "--reading 1,0.5 --direction either",
        "--reading 1,0.5 --mirror", "--reading 1,0.5 --march"}) {
    const Ran ran = run(std::string("locate gallery:cam --certify proof.json ") + arguments);
    EXPECT_EQ(ran.code, 2) << arguments;
    EXPECT_FALSE(cli::fs::exists("proof.json")) << arguments;
  }
}

TEST(CliCertify, leaves_a_file_that_exists_alone) {
  const Folder folder;
  folder.write("proof.json", "mine");
  EXPECT_EQ(run("locate gallery:cam --reading 0.9,40deg --certify proof.json").code, 2);
  EXPECT_EQ(cli::read("proof.json"), "mine");
}

TEST(CliCertify, says_what_is_no_certificate) {
  const Folder folder;
  folder.write("part.json", "{\"schema\": \"rollfix/part/1\"}");
  EXPECT_EQ(verified("part.json").code, 2);
  EXPECT_EQ(verified("missing.json").code, 2);
  EXPECT_EQ(verified("").code, 2);
}

}  // namespace
}  // namespace cli_certify_test
