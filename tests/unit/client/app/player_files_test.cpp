#include "client/app/player_files.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test::player_files_test {
namespace {

constexpr TimeUs kStart = 5'000'000;

WorldId world_of(std::uint8_t number) {
  WorldId out{};
  out[0] = number;
  return out;
}

WorldKit kit_with(Material first) {
  WorldKit out;
  out.slots[0] = first;
  out.slot = 3;
  out.tool = "sphere";
  return out;
}

struct FilesBench {
  /// Takes a turn and waits for the write that it may have begun. Returns the warning.
  std::string turn(TimeUs at) {
    std::string warning = files.step(at);
    while (files.is_writing()) {
      std::this_thread::yield();
      warning += files.step(at);
    }
    return warning;
  }
  /// Returns what the next client would read.
  std::optional<WorldKit> on_disk(std::uint8_t world) const {
    return PlayerFiles(kits, hotbars).kit_of(world_of(world));
  }

  TempFolder folder;
  std::string kits = folder / "state/worlds.toml", hotbars = folder / "state/hotbars.toml";
  PlayerFiles files{kits, hotbars};
};

}  // namespace

TEST_CASE_METHOD(FilesBench, "what a player holds is on disk soon after a change, without an end",
                 "[client]") {
  files.keep(world_of(1), kit_with(7), kStart);
  files.keep(HotbarRows{{"walls", {"brick"}}}, kStart + 1);
  CHECK(turn(kStart + PlayerFiles::kDelayUs - 1).empty());
  CHECK_FALSE(std::filesystem::exists(kits));
  CHECK(turn(kStart + PlayerFiles::kDelayUs).empty());
  CHECK(on_disk(1) == kit_with(7));
  CHECK(load_hotbars(hotbars) == HotbarRows{{"walls", {"brick"}}});
}

TEST_CASE_METHOD(FilesBench, "changes that follow each other do not put off the write",
                 "[client]") {
  TimeUs now = kStart;
  for (Material material = 1; now < kStart + PlayerFiles::kDelayUs; now += 500'000, ++material) {
    files.keep(world_of(1), kit_with(material), now);
    turn(now);
  }
  CHECK_FALSE(std::filesystem::exists(kits));
  turn(now);
  CHECK(on_disk(1) == kit_with(4));
  // Without a change no file is written.
  std::filesystem::remove(kits);
  turn(now + 10 * PlayerFiles::kDelayUs);
  CHECK_FALSE(std::filesystem::exists(kits));
}

TEST_CASE_METHOD(FilesBench, "the kit of a world that opens again is the newest, written or not",
                 "[client]") {
  CHECK(files.kit_of(world_of(1)) == std::nullopt);
  files.keep(world_of(1), kit_with(1), kStart);
  CHECK(files.kit_of(world_of(1)) == kit_with(1));
  turn(kStart + PlayerFiles::kDelayUs);
  files.keep(world_of(1), kit_with(2), kStart + PlayerFiles::kDelayUs);
  CHECK(on_disk(1) == kit_with(1));
  CHECK(files.kit_of(world_of(1)) == kit_with(2));
  CHECK(files.kit_of(world_of(2)) == std::nullopt);
}

TEST_CASE_METHOD(FilesBench, "what cannot be written is tried again later, and is not lost",
                 "[client]") {
  const std::string place = folder / "state";
  std::ofstream(place) << "not a folder";
  files.keep(world_of(1), kit_with(1), kStart);
  files.keep(world_of(2), kit_with(2), kStart);
  files.keep(HotbarRows{{"old", {}}}, kStart);
  const TimeUs failed = kStart + PlayerFiles::kDelayUs;
  CHECK(turn(failed).starts_with(kits));
  CHECK(files.kit_of(world_of(2)) == kit_with(2));
  files.keep(world_of(1), kit_with(5), failed + 1);
  files.keep(HotbarRows{{"new", {}}}, failed + 1);
  REQUIRE(std::filesystem::remove(place));
  CHECK(turn(failed + PlayerFiles::kRetryUs - 1).empty());
  CHECK_FALSE(std::filesystem::exists(kits));
  CHECK(turn(failed + PlayerFiles::kRetryUs).empty());
  CHECK(on_disk(1) == kit_with(5));
  CHECK(on_disk(2) == kit_with(2));
  CHECK(load_hotbars(hotbars) == HotbarRows{{"new", {}}});
}

TEST_CASE_METHOD(FilesBench, "an orderly end writes at once, and says why it cannot", "[client]") {
  files.keep(world_of(1), kit_with(1), kStart);
  REQUIRE(files.finish());
  CHECK(on_disk(1) == kit_with(1));
  std::filesystem::remove_all(folder / "state");
  std::ofstream(folder / "state") << "not a folder";
  files.keep(world_of(1), kit_with(2), kStart);
  const auto refused = files.finish();
  REQUIRE_FALSE(refused);
  CHECK(refused.error().starts_with(kits));
}

TEST_CASE_METHOD(FilesBench, "of two clients in one world the one that ends last leaves its kit",
                 "[client]") {
  PlayerFiles second(kits, hotbars);
  second.keep(world_of(1), kit_with(2), kStart);
  REQUIRE(second.step(kStart + PlayerFiles::kDelayUs).empty());
  while (second.is_writing()) {
    std::this_thread::yield();
    REQUIRE(second.step(kStart + PlayerFiles::kDelayUs).empty());
  }
  files.keep(world_of(1), kit_with(1), kStart);
  turn(kStart + PlayerFiles::kDelayUs);
  REQUIRE(files.finish());
  CHECK(on_disk(1) == kit_with(1));
  REQUIRE(second.finish());
  CHECK(on_disk(1) == kit_with(2));
}

TEST_CASE("a client without files for its player writes none", "[client]") {
  PlayerFiles files{"", ""};
  files.keep(world_of(1), kit_with(1), 0);
  files.keep(HotbarRows{{"walls", {}}}, 0);
  CHECK(files.step(PlayerFiles::kDelayUs).empty());
  CHECK_FALSE(files.is_writing());
  CHECK(files.finish());
  CHECK(files.kit_of(world_of(1)) == std::nullopt);
}

}  // namespace runstone::test::player_files_test
