// Added materials after kill -9, in a compacted world, in an exported log and in a backup.
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

}  // namespace runstone::test
