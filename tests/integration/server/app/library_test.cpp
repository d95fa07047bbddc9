// The library of builds in a running server: after kill -9, in a copy of the world, in a backup and
// in an exported log.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "server/backup/backup_program.hpp"
#include "server/store/world_folder.hpp"
#include "tests/integration/server/app/large_build.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/replay/run_replay.hpp"

namespace runstone::test {
namespace {

/// Writes an .rsb of more than one part of the store.
void write_large_build(const std::string& file, const std::string& name) {
  const Bytes bytes = large_build(name);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

std::string bytes_in_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void check_verified(const std::string& world) {
  const ReplayOutcome replay = run_replay({"verify", "--world", world});
  INFO(replay.out << replay.err);
  CHECK(replay.code == 0);
}

}  // namespace

TEST_CASE("a library survives kill -9 and a backup, and comes back byte by byte",
          "[integration][library]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "mill.rsb";
  write_large_build(file, "Mill");
  {
    ServerProcess process([&] { return quiet_config(world); });
    REQUIRE(process.port() != 0);
    const Answer added = must(world, {"builds", "import", file});
    CHECK(added.text.starts_with("added: 1 \"Mill\""));
    must(world, {"builds", "import", file});
    process.kill();
  }
  check_verified(world);
  {
    const auto server = start_server(quiet_config(world), flat_creation());
    CHECK(must(world, {"builds", "list", "name", "mill"}).text.find("the library has 2 builds") !=
          std::string::npos);
    const std::string copy = folder / "copy.rsb";
    must(world, {"builds", "export", "1", copy});
    CHECK(bytes_in_file(copy) == bytes_in_file(file));
    std::ostringstream said;
    const auto saved = back_up({world, folder / "backup", false}, 1'795'000'000'000'000, said, {});
    INFO((saved ? said.str() : saved.error()));
    REQUIRE(saved.has_value());
    must(world, {"builds", "remove", "1"});
    CHECK_FALSE(control(world, {"builds", "show", "1"}).is_ok);
    CHECK(must(world, {"log", "cause", "library"}).text.find("removed build 1") !=
          std::string::npos);
    CHECK(server->stop().is_clean);
  }
  check_verified(world);
  check_verified(folder / "backup");
  {
    const auto server = start_server(quiet_config(folder / "backup"), flat_creation());
    const std::string copy = folder / "again.rsb";
    must(folder / "backup", {"builds", "export", "1", copy});
    CHECK(bytes_in_file(copy) == bytes_in_file(file));
    CHECK(server->stop().is_clean);
  }
}

TEST_CASE("a build of the library is placed from the console as one action, and taken back",
          "[integration][library]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "mill.rsb";
  write_large_build(file, "Mill");
  const auto server = start_server(quiet_config(world), flat_creation());
  must(world, {"builds", "import", file});
  const std::vector<std::string> place = {"builds", "place", "1", "at", "-70", "90", "5"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> words = place;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const Answer refused = control(world, place);
  CHECK_FALSE(refused.is_ok);
  CHECK(refused.text.find("this world lacks") != std::string::npos);
  CHECK(refused.text.find("`materials add`") != std::string::npos);
  CHECK(must(world, with({"materials", "nearest", "turn", "90"})).text.find("\"Mill\" is placed") !=
        std::string::npos);
  CHECK(must(world, {"undo"}).text.find("undo: ") != std::string::npos);
  must(world, with({"materials", "add"}));
  CHECK(must(world, {"materials", "m0000"}).text.find("m0000") != std::string::npos);
  CHECK(server->stop().is_clean);
  check_verified(world);
}

TEST_CASE("an import of an .rlog keeps the records of a library without its builds",
          "[integration][library]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "mill.rsb";
  write_large_build(file, "Mill");
  {
    const auto server = start_server(quiet_config(world), flat_creation());
    must(world, {"builds", "import", file});
    CHECK(server->stop().is_clean);
  }
  const std::string log = folder / "log.rlog", other = folder / "other";
  REQUIRE(run_replay({"export", "--world", world, log}).code == 0);
  REQUIRE(run_replay({"import", "--world", other, log}).code == 0);
  check_verified(other);
  const auto server = start_server(quiet_config(other), flat_creation());
  CHECK(must(other, {"builds", "list"}).text.find("the library has 0 builds") != std::string::npos);
  CHECK(server->stop().is_clean);
}

TEST_CASE("a build larger than build_mib is refused with the limit", "[integration][library]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "large.rsb";
  write_large_build(file, "Mill");
  std::filesystem::resize_file(file, (2U << 20) + 1);
  ServerConfig config = quiet_config(world);
  config.build_mib = 2;
  const auto server = start_server(config, flat_creation());
  const Answer refused = control(world, {"builds", "import", file});
  CHECK_FALSE(refused.is_ok);
  CHECK(refused.text.find("takes 3 MiB, and one of at most 2 MiB is allowed (build_mib)") !=
        std::string::npos);
  CHECK(server->stop().is_clean);
}

}  // namespace runstone::test
