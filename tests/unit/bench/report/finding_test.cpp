#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/bench/report/findings.hpp"
#include "tests/support/temp_folder.hpp"

namespace runstone::bench {
namespace {

Finding finding_of(const std::string& step, const std::string& commit) {
  return {step,
          {"a cpu", 2, "g++ 12", commit, "AVX2"},
          true,
          "a world",
          "2026-01-31T23:59:59Z",
          1.5,
          {{"rows", {{{"world", "hills"}, {"median_ns", 12.5}}}}}};
}

void write_raw(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

TEST_CASE("a finding is read as it was written, and nothing unfinished stays beside it") {
  const test::TempFolder folder;
  const Finding written = finding_of("meshers", "abc");
  REQUIRE(write_finding(folder / "out", written).has_value());
  const auto read = read_finding(folder / "out", "meshers");
  REQUIRE(read.has_value());
  CHECK(read->step == "meshers");
  CHECK(is_comparable(*read, written));
  CHECK(read->measured_at == written.measured_at);
  CHECK(read->seconds == 1.5);
  CHECK(read->result == written.result);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out/data")) {
    static_cast<void>(entry);
    ++files;
  }
  CHECK(files == 1);
}

TEST_CASE("the error of an unusable finding has the reason and the file") {
  const test::TempFolder folder;
  const std::string out = folder / "out";
  REQUIRE(write_finding(out, finding_of("meshers", "abc")).has_value());
  CHECK(read_finding(out, "orders").error() == "not measured");

  const std::string file = finding_file(out, "meshers");
  const auto error_of = [&](const std::string& text) {
    write_raw(file, text);
    const auto read = read_finding(out, "meshers");
    REQUIRE_FALSE(read.has_value());
    CHECK(read.error().find(file) != std::string::npos);
    return read.error();
  };
  CHECK(error_of("{\"format\": 1, \"step\": \"mesh").find("parse error") != std::string::npos);
  CHECK(error_of("{\"format\": 2}").find("another format") != std::string::npos);
  CHECK(error_of("{\"format\": 1, \"step\": \"orders\"}").find("of the step \"orders\"") !=
        std::string::npos);
  CHECK(error_of("{\"format\": 1, \"step\": \"meshers\"}").find("quick") != std::string::npos);
  CHECK(error_of("[]").find("cannot be used") != std::string::npos);
}

TEST_CASE("findings name missing steps, failed steps and those of another commit") {
  const test::TempFolder folder;
  const std::string out = folder / "out";
  for (const char* step : {"a", "b"})
    REQUIRE(write_finding(out, finding_of(step, "new")).has_value());
  REQUIRE(write_finding(out, finding_of("c", "old")).has_value());
  const auto findings = Findings::read(out, {"a", "b", "c", "d", "e"}, {{"e", "no namespaces"}});

  REQUIRE(findings.common() != nullptr);
  CHECK(findings.common()->machine.commit == "new");
  CHECK(findings.doubts({"a", "b"}).empty());
  const auto doubts = findings.doubts({"a", "c", "d", "e"});
  REQUIRE(doubts.size() == 3);
  CHECK(doubts[0].find("commit old") != std::string::npos);
  CHECK(doubts[1] == "e failed in this run: no namespaces.");
  CHECK(doubts[2] == "Not measured: d.");
  const auto older = Findings::read(out, {"a"}, {{"a", "no room"}});
  CHECK(older.doubts({"a"}) ==
        std::vector<std::string>{"a failed in this run: no room. What is shown is older."});
  CHECK(findings.is_missing({"d", "e"}));
  CHECK_FALSE(findings.is_missing({"d", "a"}));
  CHECK(findings.rows("a").where("world", "hills").number("median_ns") == 12.5);
  CHECK(findings.rows("d").empty());
}

}  // namespace
}  // namespace runstone::bench
