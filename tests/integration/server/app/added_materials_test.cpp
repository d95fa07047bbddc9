// Added materials after kill -9, in a compacted world, in an exported log and in a backup.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "server/admin/compact_program.hpp"
#include "server/backup/backup_program.hpp"
#include "server/replay/rlog_file.hpp"
#include "server/replay/world_copy.hpp"
#include "server/store/world_folder.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/replay/run_replay.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kCompactedUs = 2'000'000'000'000'000;  // later than any edit of the test
const auto kLime = static_cast<Material>(default_material_table().size());

void write_wool(const std::string& file, const std::string& name) {
  std::ofstream(file) << "[[material]]\nname = \"" + name + "\"\ncolour = \"#80ff20\"\n";
}

MaterialTable table_of(const std::string& world) {
  auto store = open_world(world, StoreAccess::read_only);
  if (!store) FAIL(store.error().message());
  return *(*store)->materials();
}

std::string verified_digest(const std::string& world) {
  const ReplayOutcome replay = run_replay({"verify", "--world", world});
  INFO(replay.out << replay.err);
  REQUIRE(replay.code == 0);
  const std::size_t at = replay.out.find("digest ");
  return replay.out.substr(at, replay.out.find('\n', at) - at);
}

template <class T>
void succeed(const Result<T, std::string>& result) {
  if (!result) FAIL(result.error());
}

/// Requires that a server on the world takes an edit of lime.
void build_with_lime(const std::string& world, ClientSequence seq) {
  const auto server = start_server(quiet_config(world), flat_creation());
  RawClient client(server->port());
  REQUIRE(client.join(1, 40 + seq).has_value());
  CHECK(client.welcome.materials.find("lime") == kLime);
  client.send(EditRequest{1, 0, {SetVoxel{{3, 70, static_cast<std::int32_t>(seq)}}, {}, kLime}});
  CHECK(client.next_of<Commit>().has_value());
  CHECK(server->stop().is_clean);
}

}  // namespace

TEST_CASE("added materials survive kill -9, export, import, compaction and backup",
          "[integration][materials]") {
  const TempFolder folder;
  const std::string world = folder / "world", wool = folder / "wool.toml";
  write_wool(wool, "lime");
  {
    ServerProcess process([&] { return quiet_config(world); });
    REQUIRE(process.port() != 0);
    RawClient client(process.port());
    client.features = kFeatureMaterials;
    REQUIRE(client.join(1).has_value());
    REQUIRE(control(world, {"materials", "add", wool}).is_ok);
    std::vector<Message> before;
    client.send(EditRequest{1, 0, {SetVoxel{{3, 70, 3}}, {}, kLime}});
    REQUIRE(client.next_of<Commit>(&before).has_value());
    const auto is_added = [](const Message& m) {
      return std::get_if<MaterialsAdded>(&m) != nullptr;
    };
    CHECK(std::count_if(before.begin(), before.end(), is_added) == 1);
    REQUIRE(client.sees_durable(2));
    process.kill();
  }
  build_with_lime(world, 4);
  const std::string digest = verified_digest(world);

  const std::string file = folder / "log.rlog", imported = folder / "imported";
  {
    auto store = *open_world(world, StoreAccess::read_only);
    REQUIRE(export_rlog(*store, file, kSequenceMax).has_value());
  }
  std::ostringstream out;
  const auto done = import_rlog({imported, file}, out);
  INFO((done ? "" : done.error()));
  REQUIRE(done.has_value());
  CHECK(done->stopped.empty());
  CHECK(verified_digest(imported) == digest);
  CHECK(table_of(imported) == table_of(world));

  // A copy of the world that is older than the materials regains them from the file.
  const std::string older = folder / "older";
  {
    auto store = *open_world(world, StoreAccess::read_only);
    const std::string early = folder / "early.rlog";
    REQUIRE(export_rlog(*store, early, 0).has_value());
    REQUIRE(import_rlog({older, early}, out).has_value());
    CHECK(table_of(older) == default_material_table());
  }
  REQUIRE(import_rlog({older, file}, out).has_value());
  CHECK(verified_digest(older) == digest);
  CHECK(table_of(older) == table_of(world));

  succeed(compact_world({world, 0, false, false, true}, kCompactedUs, out));
  {
    auto store = *open_world(world, StoreAccess::read_only);
    CHECK(store->log_range()->first > 1);
    CHECK(store->meta().materials.find("lime") == kLime);
    const auto generator = generator_of(*store);
    succeed(copy_world(*store, **generator, store->log_range()->last.version.seq, folder / "copy",
                       out));
  }
  CHECK(table_of(folder / "copy") == table_of(world));
  build_with_lime(world, 5);
  CHECK(verified_digest(world) != digest);

  const std::string copy = folder / "backup", back = folder / "back";
  REQUIRE(back_up({world, copy, false}, kCompactedUs, out, {}).has_value());
  REQUIRE(restore({copy, back, false}, kCompactedUs, out).has_value());
  CHECK(table_of(back) == table_of(world));
  build_with_lime(back, 6);
}

TEST_CASE("materials of a later record follow those that a compaction kept",
          "[integration][materials]") {
  const TempFolder folder;
  const std::string world = folder / "world", wool = folder / "wool.toml";
  for (const char* name : {"lime", "teal", "plum"}) {
    write_wool(wool, name);
    {
      const auto server = start_server(quiet_config(world), flat_creation());
      CHECK(control(world, {"materials", "add", wool}).is_ok);
      CHECK(server->stop().is_clean);
    }
    std::ostringstream out;
    if (std::string(name) != "plum")
      succeed(compact_world({world, 0, false, false, true}, kCompactedUs, out));
  }
  const MaterialTable table = table_of(world);
  CHECK(table.find("lime") == kLime);
  CHECK(table.find("teal") == kLime + 1);
  CHECK(table.find("plum") == kLime + 2);
  CHECK(run_replay({"verify", "--world", world}).code == 0);
}

TEST_CASE("clients with the feature have the shapes of a world, live and after a restart",
          "[integration][materials][shapes]") {
  const TempFolder folder;
  const std::string world = folder / "world", file = folder / "shapes.toml";
  std::ofstream(file) << "[[material]]\nname = \"half\"\ncolour = \"#80ff20\"\n"
                         "shape = [[0,0,0,16,8,16]]\n"
                         "[[material]]\nname = \"minecraft:oak_slab\"\ncolour = \"#806040\"\n";
  const Shape half{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  const auto slab = static_cast<Material>(kLime + 1);
  const auto welcome_of = [](RawClient& client, std::uint64_t features, std::uint8_t who) {
    client.features = features;
    REQUIRE(client.join(who, 40 + who).has_value());
    return client.welcome.materials;
  };
  {
    const auto server = start_server(quiet_config(world), flat_creation());
    RawClient shaped(server->port()), plain(server->port());
    MaterialTable table = welcome_of(shaped, kFeatureMaterials | kFeatureShapes, 1);
    welcome_of(plain, kFeatureMaterials, 2);
    REQUIRE(control(world, {"materials", "add", file}).is_ok);
    const auto added = shaped.next_of<MaterialsAdded>();
    REQUIRE(added.has_value());
    CHECK(added->rows[0].shape.is_cube());
    REQUIRE(table.append(added->first, added->rows).has_value());
    const auto first = shaped.next_of<ShapesGiven>();
    REQUIRE(first.has_value());
    CHECK(first->given == GivenShapes{{{kLime, half}}});
    const auto preview = control(world, {"materials", "shapes", "preview"});
    CHECK(preview.text.find("1 material would get a shape") != std::string::npos);
    REQUIRE(control(world, {"materials", "shapes"}).is_ok);
    const auto second = shaped.next_of<ShapesGiven>();
    REQUIRE(second.has_value());
    REQUIRE(second->given.rows.size() == 1);
    CHECK(second->given.rows[0].material == slab);
    // The other client hears of the rows alone.
    plain.send(EditRequest{1, 0, {SetVoxel{{3, 70, 3}}, {}, kLime}});
    std::vector<Message> before;
    REQUIRE(plain.next_of<Commit>(&before).has_value());
    CHECK(std::none_of(before.begin(), before.end(),
                       [](const Message& m) { return std::holds_alternative<ShapesGiven>(m); }));
    CHECK(server->stop().is_clean);
  }
  const auto check_restarted = [&] {
    const auto server = start_server(quiet_config(world), flat_creation());
    RawClient shaped(server->port()), plain(server->port());
    const MaterialTable table = welcome_of(shaped, kFeatureMaterials | kFeatureShapes, 1);
    CHECK(table[kLime].shape == half);
    CHECK_FALSE(table[slab].shape.is_cube());
    CHECK(welcome_of(plain, kFeatureMaterials, 2)[kLime].shape.is_cube());
    CHECK(server->stop().is_clean);
  };
  check_restarted();
  std::ostringstream out;
  const std::string log = folder / "log.rlog", imported = folder / "imported";
  {
    auto store = *open_world(world, StoreAccess::read_only);
    REQUIRE(export_rlog(*store, log, kSequenceMax).has_value());
  }
  const auto done = import_rlog({imported, log}, out);
  REQUIRE(done.has_value());
  CHECK(table_of(imported) == table_of(world));
  succeed(compact_world({world, 0, false, false, true}, kCompactedUs, out));
  check_restarted();
  auto store = *open_world(world, StoreAccess::read_only);
  CHECK(store->meta().materials[kLime].shape == half);
}

}  // namespace runstone::test
