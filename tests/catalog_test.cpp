// Many parts in one file: built of folders, lists and drawings, added to, taken out of, and never half written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <thread>

#include "catalogs.hpp"
#include "refusal.hpp"

namespace catalog_test {
namespace {

using namespace catalogs;
using cli::Json;
using cli::run;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kSquare = "0,0\n10,0\n10,10\n0,10\n";
constexpr const char* kTriangle = "0,0\n10,0\n5,8\n";
constexpr const char* kTwoLoops =
    R"(<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">)"
    R"(<rect x="10" y="10" width="80" height="60"/><circle cx="50" cy="40" r="8"/></svg>)";

class CatalogFile : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    const cli::fs::path folder = cli::fs::path(name).parent_path();
    if (!folder.empty()) cli::fs::create_directories(folder);
    std::ofstream(name) << text;
  }
  std::vector<std::string> names() {
    std::vector<std::string> all;
    const Catalog catalog("parts.db");
    for (std::size_t k = 0; k < catalog.size(); ++k) all.push_back(catalog.entry(k).name);
    return all;
  }
  /// What no command of ours does to a catalog.
  static void meddle(const std::string& sql) {
    sqlite3* database = nullptr;
    sqlite3_open("parts.db", &database);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
    sqlite3_close(database);
  }
  static void ask(const char* sql, const std::function<void(sqlite3_stmt*)>& take) {
    sqlite3* database = nullptr;
    sqlite3_open("parts.db", &database);
    sqlite3_stmt* rows = nullptr;
    sqlite3_prepare_v2(database, sql, -1, &rows, nullptr);
    while (sqlite3_step(rows) == SQLITE_ROW) take(rows);
    sqlite3_finalize(rows);
    sqlite3_close(database);
  }

  cli::Folder folder_;
};

TEST_F(CatalogFile, takes_every_outline_in_a_folder_and_says_what_it_left_out) {
  write("shapes/square.csv", kSquare);
  write("shapes/deep/triangle.csv", kTriangle);
  write("shapes/plate.svg", kTwoLoops);
  write("shapes/bow.csv", "0,0\n10,10\n10,0\n0,10\n");
  write("shapes/notes.md", "not an outline");
  const cli::Ran plain = run("catalog build shapes -o parts.db --unit mm");
  EXPECT_EQ(plain.code, 0) << plain.err;
  EXPECT_THAT(names(), testing::UnorderedElementsAre("deep/triangle.csv", "plate.svg#1", "plate.svg#2", "square.csv"));
  EXPECT_THAT(plain.out, HasSubstr("bow.csv"));
  EXPECT_THAT(run("catalog list parts.db").out, HasSubstr("that does not cross itself"));
}

TEST_F(CatalogFile, leaves_out_what_an_option_does_not_go_with) {
  write("shapes/square.csv", kSquare);
  write("shapes/plate.svg", kTwoLoops);
  const cli::Ran ran = run("catalog build shapes -o parts.db --corner-angle 30deg");
  EXPECT_THAT(names(), ElementsAre("square.csv"));
  EXPECT_THAT(ran.out, HasSubstr("plate.svg"));
}

TEST_F(CatalogFile, is_not_read_again_but_where_a_file_has_changed) {
  write("shapes/square.csv", kSquare);
  write("shapes/triangle.csv", kTriangle);
  run("catalog build shapes -o parts.db");
  write("shapes/triangle.csv", "0,0\n20,0\n10,16.0\n");
  const Json report = run("catalog build shapes -o parts.db --json").json();
  EXPECT_EQ(report["unchanged"], 1);
  EXPECT_EQ(report["replaced"], 1);
  EXPECT_NEAR(Catalog("parts.db").entry(1).perimeter, 2 * (10 + 2 * std::hypot(5, 8)), 1e-9);
}

TEST_F(CatalogFile, takes_a_list_with_how_many_there_are) {
  write("bin/square.csv", kSquare);
  write("bin/list.txt", "# what is in the bin\nsquare.csv\t3\n\ngallery:cam\n");
  run("catalog build bin/list.txt -o parts.db");
  EXPECT_THAT(names(), ElementsAre("square.csv", "gallery:cam"));
  EXPECT_EQ(Catalog("parts.db").entry(0).count, 3);
  write("bin/list.txt", "square.csv\tmany\n");
  EXPECT_THAT(run("catalog build bin/list.txt -o parts.db").err, HasSubstr("bin/list.txt:1: count 'many'"));
}

TEST_F(CatalogFile, loses_parts_only_when_it_is_told_to) {
  of({"cam", "limacon", "gear"});
  EXPECT_EQ(run("catalog remove parts.db limacon").code, 0);
  EXPECT_THAT(names(), ElementsAre("cam", "gear"));
  EXPECT_THAT(run("catalog remove parts.db cam nobody").err, HasSubstr("there is no part 'nobody'"));
  EXPECT_THAT(names(), ElementsAre("cam", "gear"));
}

TEST_F(CatalogFile, gives_each_part_back_with_the_same_bits) {
  const Catalog catalog = of(mixed_shapes(3));
  for (std::size_t k = 0; k < catalog.size(); ++k) {
    const Part part = load_part("gallery:" + catalog.entry(k).name);
    for (double s = 0; s < part.perimeter(); s += part.perimeter() / 97) {
      EXPECT_EQ(catalog.part(k).turning().angle(s), part.turning().angle(s));
      EXPECT_EQ(catalog.part(k).point(s), part.point(s));
    }
  }
}

TEST_F(CatalogFile, that_was_damaged_says_so) {
  of({"cam"});
  meddle("UPDATE shapes SET numbers = zeroblob(16)");
  EXPECT_THAT(refusal_of([] { Catalog("parts.db").part(0); }), HasSubstr("checksum"));
  write("text.db", "no catalog at all, but some text that is longer than the header of a file that SQLite would have");
  EXPECT_THAT(refusal_of([] { Catalog("text.db"); }), HasSubstr("is not a catalog"));
  EXPECT_THAT(refusal_of([] { Catalog("nowhere.db"); }), HasSubstr("there is no such file"));
  EXPECT_THAT(refusal_of([] { Catalog("."); }), HasSubstr("is a folder, expected a catalog's file"));
}

constexpr const char* kNothing = "nothing was thrown";

/// Everything that is said of the parts, or the refusal.
std::string all_said() {
  return refusal_of([] {
    const Catalog catalog("parts.db");
    for (std::size_t k = 0; k < catalog.size(); ++k) {
      identify(catalog, {catalog.part(k), roll_on(catalog.part(k), 1, {0.5, 1.1})});
    }
  });
}

TEST_F(CatalogFile, is_refused_with_any_column_of_any_part_changed) {
  of({"cam", "limacon"});
  const std::string whole = cli::read("parts.db");
  ASSERT_EQ(all_said(), kNothing);
  for (const std::string change :
       {"parts SET name = 'other'", "parts SET source = source + 1", "parts SET perimeter = perimeter * 1.0000001",
        "parts SET perimeter = 1e300", "parts SET period_turn = -period_turn", "parts SET most_curvature = 0",
        "parts SET closed = 0", "parts SET reversed = 1", "parts SET measured = 1", "parts SET symmetry = 2",
        "parts SET count = 1e9", "parts SET checksum = checksum + 1", "parts SET id = 7",
        "parts SET profile = (SELECT profile FROM parts WHERE id = 2)",
        "shapes SET fine = (SELECT fine FROM shapes WHERE part = 2)",
        "shapes SET (fine, fine_checksum) = (SELECT fine, fine_checksum FROM shapes WHERE part = 2)",
        "shapes SET outline = outline || ' '", "shapes SET numbers = numbers || x'00'",
        "shapes SET (outline, numbers, checksum) = "
        "(SELECT outline, numbers, checksum FROM shapes WHERE part = 2)"}) {
    write("parts.db", whole);
    meddle("UPDATE " + change + (change.starts_with("parts") ? " WHERE id = 1" : " WHERE part = 1"));
    EXPECT_NE(all_said(), kNothing) << change;
  }
}

TEST_F(CatalogFile, is_refused_with_parts_exchanged_or_missing) {
  of({"cam", "limacon"});
  const std::string whole = cli::read("parts.db");
  for (const std::string sql :
       {"UPDATE shapes SET part = 3 - part + 10; UPDATE shapes SET part = part - 10", "DELETE FROM parts WHERE id = 1",
        "UPDATE facts SET value = 'mm' WHERE name = 'unit'; INSERT OR IGNORE INTO facts VALUES ('unit', 'mm')"}) {
    write("parts.db", whole);
    meddle(sql);
    EXPECT_THAT(all_said(), HasSubstr("checksum")) << sql;
  }
}

TEST_F(CatalogFile, is_refused_with_a_view_in_place_of_a_table) {
  of({"cam", "limacon"});
  meddle("ALTER TABLE parts RENAME TO kept; CREATE VIEW parts AS SELECT * FROM kept");
  EXPECT_THAT(all_said(), HasSubstr("view"));
}

TEST_F(CatalogFile, is_refused_with_another_table_in_place_of_its_own) {
  of({"cam"});
  meddle("CREATE TABLE own AS SELECT * FROM parts; DROP TABLE parts; ALTER TABLE own RENAME TO parts");
  EXPECT_THAT(all_said(), HasSubstr("'parts' is not as rollfix made it"));
}

TEST_F(CatalogFile, keeps_its_checksum_through_all_that_is_done_to_it) {
  write("shapes/square.csv", kSquare);
  write("shapes/plate.svg", kTwoLoops);
  run("catalog build shapes -o parts.db");
  EXPECT_EQ(all_said(), kNothing);
  write("shapes/square.csv", kTriangle);
  run("catalog build shapes -o parts.db");
  EXPECT_EQ(all_said(), kNothing);
  run("catalog remove parts.db square.csv");
  EXPECT_EQ(all_said(), kNothing);
}

TEST_F(CatalogFile, has_one_unit_for_all) {
  write("shapes/a.svg", kTwoLoops);
  write("shapes/b.csv", "x [in],y [in]\n0,0\n1,0\n1,1\n0,1\n");
  run("catalog build shapes -o parts.db");
  const Catalog catalog("parts.db");
  EXPECT_EQ(catalog.unit(), "mm");
  EXPECT_NEAR(catalog.entry(2).perimeter, 4 * 25.4, 1e-9);
  EXPECT_THAT(run("catalog build shapes -o parts.db --unit in").err, HasSubstr("are in mm"));
}

TEST_F(CatalogFile, leaves_out_what_states_no_unit_beside_what_does) {
  write("shapes/a.svg", kTwoLoops);
  write("shapes/b.csv", kSquare);
  const cli::Ran ran = run("catalog build shapes -o parts.db");
  EXPECT_THAT(names(), ElementsAre("a.svg#1", "a.svg#2"));
  EXPECT_THAT(ran.out, HasSubstr("nobody says in what its lengths are, and the catalog is in mm: give --unit mm"));
  run("catalog build shapes -o parts.db --unit mm");
  EXPECT_THAT(names(), ElementsAre("a.svg#1", "a.svg#2", "b.csv"));
}

TEST_F(CatalogFile, leaves_out_what_states_a_unit_beside_what_does_not) {
  write("shapes/a.csv", kSquare);
  write("shapes/b.svg", kTwoLoops);
  EXPECT_THAT(run("catalog build shapes -o parts.db").out, HasSubstr("build them anew, with --unit mm"));
  EXPECT_THAT(names(), ElementsAre("a.csv"));
}

TEST_F(CatalogFile, tells_what_is_alike_once_and_what_was_left_out_last) {
  for (const std::string name : {"a", "b", "c"})
    write("shapes/" + name + ".csv", "x,y,z\n0,0,0\n1,0,0\n0," + std::to_string(name[0]) + ",0\n");
  write("shapes/d.csv", "0 0\n");
  const cli::Ran ran = cli::shell("rollfix catalog build shapes -o parts.db 2>&1");
  EXPECT_THAT(ran.out, StartsWith("rollfix: 3 files: the column z is not looked at: outlines are plane\n"));
  EXPECT_GT(ran.out.find("left out"), ran.out.find("3 files"));
}

TEST_F(CatalogFile, refuses_a_name_that_is_there_already) {
  write("one/a.csv", kSquare);
  write("other/a.csv", kTriangle);
  const cli::Ran ran = run("catalog build one other -o parts.db");
  EXPECT_THAT(names(), ElementsAre("a.csv"));
  EXPECT_THAT(ran.out, HasSubstr("a part of this name is there from"));
}

TEST_F(CatalogFile, keeps_what_was_reported_when_the_build_is_killed) {
  std::string list;
  for (int k = 1; k <= 3000; ++k) list += "gallery:spline,n=9,wobble=0.2,seed=" + std::to_string(k) + "\n";
  write("list.txt", list);
  int report[2];
  ASSERT_EQ(pipe(report), 0);
  const pid_t child = fork();
  if (child == 0) {
    BuildOptions options;
    options.go_on = [&](const BuildProgress& progress) {
      return ::write(report[1], &progress.parts, sizeof progress.parts) > 0;
    };
    build_catalog("parts.db", catalog_sources("list.txt"), options);
    _exit(0);
  }
  close(report[1]);
  std::size_t reported = 0;
  while (reported < 100 && ::read(report[0], &reported, sizeof reported) == sizeof reported) {
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  while (::read(report[0], &reported, sizeof reported) == sizeof reported) {
  }
  close(report[0]);
  EXPECT_GE(Catalog("parts.db").size(), reported);
  EXPECT_LT(Catalog("parts.db").size(), 3000U);
  const BuildReport rest = build_catalog("parts.db", catalog_sources("list.txt"));
  EXPECT_EQ(Catalog("parts.db").size(), 3000U);
  EXPECT_GE(rest.unchanged, reported);
}

TEST_F(CatalogFile, is_left_whole_by_a_build_that_a_signal_ends) {
  std::string list;
  for (int k = 1; k <= 3000; ++k) list += "gallery:spline,n=9,wobble=0.2,seed=" + std::to_string(k) + "\n";
  write("list.txt", list);
  for (int k = 0; k < 20; ++k) {
    const std::string signal = k % 2 == 0 ? "TERM" : "INT";
    cli::shell("timeout -s " + signal + " 0." + std::to_string(100 + 13 * k) +
               " rollfix catalog build list.txt -o parts.db --quiet");
    EXPECT_FALSE(cli::fs::exists("parts.db-journal"));
  }
  EXPECT_GT(Catalog("parts.db").size(), 0U);
}

TEST_F(CatalogFile, that_a_killed_build_left_half_written_is_read_as_it_was_before) {
  of({"cam"});
  const pid_t child = fork();
  if (child == 0) {
    sqlite3* database = nullptr;
    sqlite3_open("parts.db", &database);
    // More than the cache holds, so that half of it is in the file already, and its journal beside it.
    sqlite3_exec(database,
                 "PRAGMA cache_size = 1; BEGIN; CREATE TABLE other (a); "
                 "WITH RECURSIVE n (k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM n WHERE k < 3000) "
                 "INSERT INTO other SELECT zeroblob(1000) FROM n; DELETE FROM parts; PRAGMA cache_spill = 1",
                 nullptr, nullptr, nullptr);
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(cli::fs::exists("parts.db-journal"));
  EXPECT_THAT(names(), ElementsAre("cam"));
}

TEST_F(CatalogFile, that_several_build_at_once_is_built_once_and_can_be_read_meanwhile) {
  std::string list;
  for (int k = 1; k <= 150; ++k) list += "gallery:spline,n=9,wobble=0.2,seed=" + std::to_string(k) + "\n";
  write("list.txt", list);
  of({"cam"});
  const cli::Ran ran = cli::shell(
      "for k in 1 2 3; do rollfix catalog build list.txt -o parts.db --json > report$k & done; "
      "for k in 1 2 3 4 5 6; do rollfix catalog list parts.db > /dev/null || echo failed; done; wait");
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(names().size(), 151U);
  double added = 0;
  for (const char* const report : {"report1", "report2", "report3"}) {
    const Json said = Json::parse(cli::read(report));
    added += said["added"].get<double>();
    EXPECT_EQ(said["replaced"].get<double>(), 0);
  }
  EXPECT_EQ(added, 150);
}

}  // namespace
}  // namespace catalog_test
