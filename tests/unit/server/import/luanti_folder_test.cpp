#include "server/import/luanti_folder.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"

using namespace runstone;

namespace {

struct Folder : test::TempFolder {
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(*this / name).parent_path());
    std::ofstream(*this / name) << text;
  }
  std::string refusal(const std::string& name = "world") const {
    const auto found = find_luanti_map(*this / name);
    return found ? "" : found.error().message();
  }
};

bool says(const std::string& text, const std::string& words) {
  INFO(text);
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE_METHOD(Folder, "world.mt decides where the map is, whatever map.sqlite lies there",
                 "[server][import]") {
  const std::string backend =
      GENERATE(as<std::string>{}, "postgresql", "redis", "dummy", "cassandra");
  const bool has_map = GENERATE(false, true);
  CAPTURE(backend, has_map);
  write("world/world.mt", "gameid = minetest\nbackend = " + backend +
                              "\npgsql_connection = host=127.0.0.1 password=geheim\n");
  if (has_map) write("world/map.sqlite", "rows of long ago");
  const std::string words = refusal();
  CHECK(says(words, "world: world.mt says backend = " + backend));
  CHECK_FALSE(says(words, "geheim"));
  const bool can_be_moved = backend != "dummy" && backend != "cassandra";
  CHECK(says(words, "--migrate sqlite3") == can_be_moved);
  CHECK(says(words, "map.sqlite is from before that") == (can_be_moved && has_map));
}

TEST_CASE_METHOD(Folder, "a world with the backend sqlite3, or without one, has map.sqlite",
                 "[server][import]") {
  const std::string text = GENERATE(as<std::string>{}, "", "gameid = minetest\n",
                                    "\xEF\xBB\xBF"
                                    "backend = sqlite3\r\nx = y\r\n",
                                    "# backend = redis\nbackend=redis\nbackend = sqlite3\n");
  CAPTURE(text);
  write("world/map.sqlite", "rows");
  if (!text.empty()) write("world/world.mt", text);
  const auto found = find_luanti_map(*this / "world");
  REQUIRE(found.has_value());
  CHECK(found->map == *this / "world/map.sqlite");
  CHECK_FALSE(found->has_seed_map);
}

TEST_CASE_METHOD(Folder, "a world with the backend leveldb has map.db", "[server][import]") {
  write("world/map.sqlite", "rows of long ago");
  write("world/world.mt", "backend = leveldb\nreadonly_backend = sqlite3\n");
  CHECK(says(refusal(), "world/map.db: does not exist"));
  write("world/map.db/CURRENT", "x");
  const auto found = find_luanti_map(*this / "world");
  REQUIRE(found.has_value());
  CHECK(found->map == *this / "world/map.db");
  CHECK(found->backend == LuantiBackend::leveldb);
  CHECK(found->has_seed_map);
}

TEST_CASE_METHOD(Folder, "a second map and blocks of another size are known from world.mt",
                 "[server][import]") {
  write("world/map.sqlite", "rows");
  write("world/world.mt", "backend = sqlite3\nreadonly_backend = sqlite3\n");
  const auto found = find_luanti_map(*this / "world");
  REQUIRE(found.has_value());
  CHECK(found->has_seed_map);
  write("world/world.mt", "backend = sqlite3\nblocksize = 32\n");
  CHECK(says(refusal(), "blocksize = 32"));
}

TEST_CASE_METHOD(Folder, "a world without a map, and a map that is no file, are refused with words",
                 "[server][import]") {
  write("world/world.mt", "backend = sqlite3\n");
  CHECK(says(refusal(), "world/map.sqlite: does not exist"));
  std::filesystem::create_directory(*this / "world/map.sqlite");
  CHECK(says(refusal(), "world/map.sqlite: is a folder"));
  std::filesystem::remove(*this / "world/map.sqlite");
  write("world/map.sqlite", "");
  CHECK(says(refusal(), "world/map.sqlite: has no bytes"));
  std::filesystem::remove(*this / "world/map.sqlite");
  REQUIRE(::mkfifo((*this / "world/map.sqlite").c_str(), 0600) == 0);
  CHECK(says(refusal(), "world/map.sqlite: is a device, a pipe or a socket"));
  CHECK(says(refusal("world/map.sqlite"), "give the folder that holds it"));
  REQUIRE(::mkfifo((*this / "pipe").c_str(), 0600) == 0);
  CHECK(says(refusal("pipe"), "pipe: is a device, a pipe or a socket: give the folder"));
}

TEST_CASE_METHOD(Folder, "what is no Luanti world is named, with what can be done",
                 "[server][import]") {
  CHECK(says(refusal("nowhere"), "nowhere: does not exist"));
  write("castle.vox", "VOX \x96");
  CHECK(says(refusal("castle.vox"), "castle.vox: is a model of MagicaVoxel"));
  CHECK(says(refusal("castle.vox"), "Convert it to a Luanti world"));
  write("house.schem", "\x1f\x8b");
  CHECK(says(refusal("house.schem"), "is a schematic of Minecraft"));
  write("java/level.dat", "\x1f\x8b");
  write("java/region/r.0.0.mca", "");
  CHECK(says(refusal("java"), "java: is a Minecraft world"));
  CHECK(says(refusal("java/level.dat"), "is a file of a Minecraft world"));
  CHECK(says(refusal("java/region/r.0.0.mca"), "is a region of a Minecraft world"));
  write("bedrock/level.dat", "x");
  write("bedrock/db/CURRENT", "x");
  CHECK(says(refusal("bedrock"), "is a world of Minecraft Bedrock"));
  write("ours/world.sqlite", "x");
  CHECK(says(refusal("ours"), "is a world of Runstone already"));
  write("level/map.db/CURRENT", "x");
  CHECK(says(refusal("level"), "LevelDB"));
  write("worlds/valley/world.mt", "backend = sqlite3\n");
  write("worlds/valley/map.sqlite", "rows");
  CHECK(says(refusal("worlds"), "give " + *this / "worlds" + "/valley"));
  CHECK(says(refusal("worlds/valley/map.sqlite"), "give the folder that holds it"));
  write("notes/readme.txt", "x");
  CHECK(says(refusal("notes"), "is no Luanti world"));
}
