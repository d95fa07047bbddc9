// Packs: one file that holds all of a world, and the world that is made of it.
#include "server/backup/world_pack.hpp"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "tests/unit/server/backup/backup_bench.hpp"

namespace runstone::test {
namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

struct PackBench : BackupBench {
  /// Returns the error or an empty text. `printed` is then what the program printed.
  std::string pack(const std::string& to, const BackupPace& pace = {}) {
    std::ostringstream out;
    const auto done = pack_world({world, to, false}, kBackupTimeUs, out, pace);
    printed = out.str();
    return done ? "" : done.error();
  }
  const std::string file = folder / "valley.tar";
};

}  // namespace

TEST_CASE_METHOD(PackBench, "a world is made of its pack, as it was at one moment", "[backup]") {
  write_file(world + "/server.toml", "sessions_max = 3\n");
  int rests = 0;
  BackupPace pace;
  pace.part_pages = 4;
  pace.rest = [&](std::chrono::nanoseconds) {
    if (++rests <= 5) play(20);
  };
  REQUIRE(pack(file, pace) == "");
  REQUIRE(rests > 5);
  CHECK_THAT(printed, Contains("moment      epoch=1 seq=400\n"));
  CHECK_FALSE(fs::exists(file + ".copy.partial"));
  CHECK(fs::status(file).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  REQUIRE(restore_to(file, back) == "");
  CHECK_THAT(printed, Contains("restored    " + file + " to " + back));
  const auto restored = opened(back);
  CHECK(*restored->last_sequence() == kBackupEdits);
  CHECK(restored->check().has_value());
  CHECK(restored->meta().server_key_seed == store->meta().server_key_seed);
  CHECK(fs::exists(back + "/server.toml"));
}

TEST_CASE_METHOD(PackBench, "a file that is made while a world is packed is not replaced",
                 "[backup]") {
  BackupPace pace;
  pace.part_pages = 4;
  pace.rest = [&](std::chrono::nanoseconds) { write_file(file, "mine"); };
  CHECK_THAT(pack(file, pace), Contains(file + ": cannot be made: File exists"));
  std::ifstream in(file);
  CHECK(std::string(std::istreambuf_iterator<char>(in), {}) == "mine");
  CHECK_FALSE(fs::exists(file + ".copy.partial"));
}

TEST_CASE_METHOD(PackBench, "tar unpacks a pack to a world", "[backup]") {
  REQUIRE(pack(file) == "");
  fs::create_directory(copy);
  REQUIRE(::system(("tar -xf " + file + " -C " + copy).c_str()) == 0);
  CHECK(opened(copy)->check().has_value());
  CHECK(fs::exists(copy + "/runstone-pack"));
}

TEST_CASE_METHOD(PackBench, "a pack that is cut off or damaged makes no world", "[backup]") {
  REQUIRE(pack(file) == "");
  const std::uint64_t bytes = fs::file_size(file);
  const auto refused = [&] {
    const std::string error = restore_to(file, back);
    CAPTURE(error);
    CHECK(error != "");
    CHECK_FALSE(fs::exists(back));
    CHECK_FALSE(fs::exists(back + ".partial"));
  };
  SECTION("cut off") {
    for (const std::uint64_t left : {bytes - 1'600, bytes / 2, bytes / 3 / 512 * 512,
                                     std::uint64_t{512}, std::uint64_t{100}, std::uint64_t{0}}) {
      CAPTURE(left);
      fs::resize_file(file, left);
      refused();
    }
  }
  SECTION("a bit is changed") {
    for (std::uint64_t part = 1; part < 8; ++part) {
      const auto at = static_cast<std::streamoff>(bytes * part / 8);
      CAPTURE(at);
      std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
      out.seekg(at);
      const char before = static_cast<char>(out.get());
      out.seekp(at);
      out.put(static_cast<char>(before ^ 4));
      out.close();
      refused();
    }
  }
  SECTION("something else") {
    write_file(file, "dear diary");
    CHECK_THAT(restore_to(file, back), Contains("is cut off"));
    write_file(file, std::string(2'048, 'x'));
    CHECK_THAT(restore_to(file, back), Contains("damaged header"));
    write_file(file, std::string(2'048, '\0'));
    CHECK_THAT(restore_to(file, back), Contains("is no pack of a world"));
  }
}

TEST_CASE_METHOD(PackBench, "a tar file with other names is refused before it is written",
                 "[backup]") {
  fs::create_directory(folder / "other");
  write_file(folder / "other/passwd", "x");
  REQUIRE(::system(("tar -C " + folder.path() + "/other --format=ustar -cf " + file + " passwd")
                       .c_str()) == 0);
  CHECK_THAT(restore_to(file, back), Contains("holds passwd, so it is no pack"));
  CHECK_FALSE(fs::exists(back));
}

TEST_CASE_METHOD(PackBench, "a pack replaces no file and does not lie in its world", "[backup]") {
  write_file(file, "mine");
  CHECK_THAT(pack(file), Contains("a pack replaces no file"));
  CHECK_THAT(pack(world + "/valley.tar"), Contains("lies in"));
  CHECK_THAT(pack(folder / "missing/valley.tar"), Contains("is no folder"));
  CHECK(fs::file_size(file) == 4);
  CHECK_THAT(restore_to(file, back), Contains("is cut off"));
}

TEST_CASE_METHOD(PackBench, "a killed program leaves no pack, and the next one cleans up",
                 "[backup]") {
  const pid_t child = ::fork();
  if (child == 0) {
    BackupPace pace;
    pace.part_pages = 4;
    pace.rest = [](std::chrono::nanoseconds) { ::raise(SIGKILL); };
    static_cast<void>(pack(file, pace));
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFSIGNALED(status));
  CHECK_FALSE(fs::exists(file));
  REQUIRE(fs::exists(file + ".copy.partial"));
  REQUIRE(pack(file) == "");
  CHECK_FALSE(fs::exists(file + ".copy.partial"));
}

TEST_CASE_METHOD(PackBench, "a full disk ends a pack with words", "[backup]") {
  BackupPace pace;
  pace.spare_bytes = 1ULL << 60;
  CHECK_THAT(pack(file, pace), Contains("MiB must stay free, but the disk has"));
  CHECK_FALSE(fs::exists(file));
  CHECK_FALSE(fs::exists(file + ".copy.partial"));
}

}  // namespace runstone::test
