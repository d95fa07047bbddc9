// Plays a world folder into a live server with runstone-replay and runstone-bot, as people run
// them.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// Edits of one author. Their order is kept, so any edits give the same world.
void make_world(const std::string& folder, std::size_t edits) {
  WorldMeta meta = sample_meta();
  meta.generator = {"flat", 1, 5, ""};
  auto store = *create_world(folder, meta);
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(11);
  auto records = sample_records(rng, 1, 1, edits);
  for (EditRecord& record : records) record.op = {1, 7, record.version.seq};
  const std::vector<PlayerRow> players = {sample_player(1)};
  REQUIRE(store->append(players, records).has_value());
}

std::string digest_of(const std::string& folder, const std::string& at) {
  const auto replay = run_replay({"verify", "--quick", "--world", folder, "--at", at});
  INFO(replay.out << replay.err);
  REQUIRE(replay.code == 0);
  const std::size_t begin = replay.out.find("digest ");
  return replay.out.substr(begin, replay.out.find('\n', begin) - begin);
}

/// Makes programs create their temporary files in a folder of the test.
class TemporaryFiles {
 public:
  TemporaryFiles() { ::setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~TemporaryFiles() { ::unsetenv("TMPDIR"); }
  bool none_left() const { return std::filesystem::is_empty(folder_.path()); }

 private:
  TempFolder folder_;
};

}  // namespace

TEST_CASE("a log played into a server of the same generator gives the same world", "[bots][play]") {
  const TempFolder folder;
  make_world(folder / "old", 200);
  auto server = start_server(quiet_config(folder / "live"), flat_creation());
  const std::string address = "127.0.0.1:" + std::to_string(server->port());
  const TemporaryFiles files;
  const auto played =
      run_replay({"play", "--world", folder / "old", "--at", "150", "--connect", address, "--speed",
                  "max", "--bot", RUNSTONE_BOT_PROGRAM, "--json", folder / "report.json"});
  INFO(played.err);
  CHECK(played.code == 0);
  CHECK(files.none_left());
  CHECK(std::filesystem::file_size(folder / "report.json") > 100);
  const StopReport stopped = server->stop();
  CHECK(stopped.digests.seq == 150);
  CHECK(digest_of(folder / "live", "150") == digest_of(folder / "old", "150"));
}

TEST_CASE("a play that fails ends with an exit code and leaves no file behind", "[bots][play]") {
  const TempFolder folder;
  make_world(folder / "old", 20);
  const TemporaryFiles files;
  const auto into = [&](const std::string& world, const std::string& bot) {
    return run_replay(
        {"play", "--world", folder / world, "--connect", "127.0.0.1:1", "--bot", bot});
  };
  const auto no_world = into("none", RUNSTONE_BOT_PROGRAM);
  CHECK(no_world.code == 2);
  const auto no_bot = into("old", folder / "no-bot");
  CHECK(no_bot.code == 2);
  CHECK(no_bot.err.find("no-bot: cannot be started: ") != std::string::npos);
  const auto script = [&](const std::string& text) {
    const std::string file = folder / "bot.sh";
    std::ofstream(file) << "#!/bin/sh\n" << text << '\n';
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return file;
  };
  CHECK(into("old", script("exit 7")).code == 7);
  CHECK(into("old", script("test -s \"$2\" || exit 3; test \"$4\" = 127.0.0.1:1 || exit 4")).code ==
        0);
  const auto killed = into("old", script("kill -9 $$"));
  CHECK(killed.code == 2);
  CHECK(killed.err.find("bot.sh: was ended by signal 9") != std::string::npos);
  // The program passes a signal on to the child, and still removes its file.
  CHECK(into("old", script("trap 'exit 5' TERM; kill -TERM $PPID; while :; do sleep 0.05; done"))
            .code == 5);
  CHECK(files.none_left());
}

TEST_CASE("a log is not played if no temporary folder can be made", "[bots][play]") {
  const TempFolder folder;
  make_world(folder / "old", 1);
  const auto error_with = [&](const std::string& temporary) {
    ::setenv("TMPDIR", temporary.c_str(), 1);
    const auto played = run_replay({"play", "--world", folder / "old", "--connect", "127.0.0.1:1",
                                    "--bot", RUNSTONE_BOT_PROGRAM});
    ::unsetenv("TMPDIR");
    CHECK(played.code == 2);
    return played.err;
  };
  CHECK(error_with(folder / "nowhere").find("no folder for temporary files, see TMPDIR: ") !=
        std::string::npos);
  // A folder in which nobody, including root, can create a file.
  CHECK(error_with("/proc").find("/proc: no temporary folder can be made: ") != std::string::npos);
}
