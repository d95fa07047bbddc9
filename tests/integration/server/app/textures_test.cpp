// Textures of a world over a real server: the list, the pictures, a second picture that is refused,
// and everything again after kill -9, compaction, backup and a copy.
#include <catch2/catch.hpp>
#include <map>
#include <sstream>
#include <string>

#include "common/textures/texture_hash.hpp"
#include "common/textures/texture_picture.hpp"
#include "common/textures/texture_table.hpp"
#include "server/admin/compact_program.hpp"
#include "server/backup/backup_program.hpp"
#include "server/replay/world_copy.hpp"
#include "server/store/world_folder.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/textures/test_png.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kLaterUs = 2'000'000'000'000'000;  // than any edit of the test

/// Joins with the feature, and fetches the list and all pictures. Returns the pictures by their
/// hash.
std::map<TextureHash, Bytes> fetched(std::uint16_t port, TextureTable& table, std::uint64_t who) {
  RawClient client(port);
  client.features = kFeatureMaterials | kFeatureTextures;
  REQUIRE(client.join(1, who).has_value());
  const auto given = client.next_of<TexturesGiven>();
  REQUIRE(given.has_value());
  REQUIRE(table.add(given->entries).has_value());
  TexturesWanted wanted;
  for (const TextureEntry& entry : table.entries()) wanted.hashes.push_back(entry.hash);
  client.send(wanted);
  std::map<TextureHash, Bytes> pictures;
  while (pictures.size() < wanted.hashes.size()) {
    const auto parts = client.next_of<TextureParts>();
    REQUIRE(parts.has_value());
    for (const TexturePart& part : parts->parts) {
      CHECK(texture_hash(part.png) == part.hash);
      CHECK(read_texture(part.png).has_value());
      pictures[part.hash] = part.png;
    }
  }
  return pictures;
}

}  // namespace

TEST_CASE("a world has its textures after kill -9, compaction, backup and copy",
          "[integration][textures]") {
  const TempFolder folder;
  const std::string world = folder / "world", pictures = folder / "pictures";
  const MaterialTable materials = default_material_table();
  write_file(pictures + "/" + materials[1].name + ".png", plain_png(16, 16, {1, 2, 3, 255}));
  write_file(pictures + "/" + materials[2].name + "_top.png", plain_png(64, 64, {4, 5, 6, 255}));
  write_file(pictures + "/" + materials[3].name + ".png", bytes_of({16'384, 16'384, 8, 6, {0}}));
  write_file(pictures + "/" + materials[4].name + ".png", {'n', 'o'});
  TextureTable table;
  std::map<TextureHash, Bytes> first;
  {
    ServerProcess process([&] { return quiet_config(world); });
    REQUIRE(process.port() != 0);
    const Answer answer = control(world, {"materials", "textures", pictures});
    INFO(answer.text);
    REQUIRE(answer.is_ok);
    CHECK(answer.text.find("2 pictures for 2 materials") != std::string::npos);
    CHECK(answer.text.find("16384 x 16384") != std::string::npos);
    first = fetched(process.port(), table, 40);
    CHECK(first.size() == 2);
    CHECK(table.number(1, Direction::neg_x) != 0);
    CHECK(table.number(2, Direction::pos_y) != 0);
    CHECK(table.number(2, Direction::pos_x) == 0);
    // A side never gets another picture.
    write_file(pictures + "/" + materials[1].name + ".png", plain_png(16, 16, {9, 9, 9, 255}));
    const Answer again = control(world, {"materials", "textures", pictures});
    CHECK(again.text.find("nothing is changed") != std::string::npos);
    // A client without the feature can join, too.
    RawClient old(process.port());
    old.features = kFeatureMaterials;
    CHECK(old.join(2, 41).has_value());
    process.kill();
  }
  const auto has_textures = [&](const std::string& place, std::uint64_t who) {
    const auto server = start_server(quiet_config(place), flat_creation());
    TextureTable present;
    CHECK(fetched(server->port(), present, who) == first);
    CHECK(present.number(2, Direction::pos_y) == table.number(2, Direction::pos_y));
    CHECK(server->stop().is_clean);
  };
  has_textures(world, 42);

  std::ostringstream out;
  const auto compacted = compact_world({world, 0, false, false, true}, kLaterUs, out);
  if (!compacted) FAIL(compacted.error());
  {
    auto store = *open_world(world, StoreAccess::read_only);
    CHECK(store->log_range()->first > 2);
    const auto generator = generator_of(*store);
    const auto copied =
        copy_world(*store, **generator, store->log_range()->last.version.seq, folder / "copy", out);
    if (!copied) FAIL(copied.error());
  }
  has_textures(world, 43);
  has_textures(folder / "copy", 44);

  const std::string backup = folder / "backup", back = folder / "back";
  REQUIRE(back_up({world, backup, false}, kLaterUs, out, {}).has_value());
  REQUIRE(restore({backup, back, false}, kLaterUs, out).has_value());
  has_textures(back, 45);
}

TEST_CASE("pictures that no material is named for change nothing", "[integration][textures]") {
  const TempFolder folder;
  const std::string world = folder / "world", pictures = folder / "pictures";
  const auto server = start_server(quiet_config(world), flat_creation());
  const Bytes png = plain_png(16, 16, {1, 2, 3, 255});
  for (int i = 0; i < 10; ++i) write_file(pictures + "/p" + std::to_string(i) + ".png", png);
  const Answer answer = control(world, {"materials", "textures", pictures});
  CHECK(answer.is_ok);
  CHECK(answer.text.find("nothing is changed") != std::string::npos);
  CHECK(server->stop().is_clean);
}

}  // namespace runstone::test
