// The server is killed with kill -9. Edits that were acknowledged as durable are kept, others are
// offered again, and none is applied twice.
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/integration/server/app/server_process.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/sql/crash_image.hpp"

namespace runstone::test {
namespace {

constexpr ClientSequence kCrashEdits = 4'000;
constexpr ClientInstance kInstance = 33;

/// Each edit sets another voxel of the chunk at the origin, above and below ground.
VoxelPos place_of(ClientSequence seq) {
  const auto n = static_cast<std::int32_t>(seq);
  return {n % 16, n / 16 % 16, n / 256 % 16};
}
Material material_of(ClientSequence seq) { return static_cast<Material>(1 + seq % 5); }
EditRequest edit(ClientSequence seq) {
  return {seq, 0, {SetVoxel{place_of(seq)}, {}, material_of(seq)}};
}

ServerConfig crash_config(const std::string& world) {
  ServerConfig config = quiet_config(world);
  return config;
}

TEST_CASE("after kill -9 durable edits are kept, and the others, offered again, are applied once",
          "[integration]") {
  const TempFolder folder;
  Sequence durable = 0;
  {
    ServerProcess process([&] { return crash_config(folder / "world"); });
    REQUIRE(process.port() != 0);
    RawClient client(process.port());
    REQUIRE(client.join(1, kInstance).has_value());
    for (ClientSequence seq = 1; seq <= kCrashEdits; ++seq) client.send(edit(seq));
    while (durable < 100) {
      const auto message = client.next_of<Durable>();
      REQUIRE(message.has_value());
      durable = message->seq;
    }
    process.kill();
  }
  {
    // After kill -9 the durable mark covers everything that was acknowledged.
    const TempFolder without_wal;
    copy_crash_image(folder / "world", without_wal.path());
    std::filesystem::remove(without_wal / "world.sqlite-wal");
    const auto lost = open_world(without_wal.path(), StoreAccess::read_only);
    REQUIRE(lost.has_value());
    REQUIRE((*lost)->loss().has_value());
    const std::string text = (*lost)->loss()->what;
    const std::string before = "but seq=";
    CAPTURE(text);
    REQUIRE(text.find(before) != std::string::npos);
    CHECK(std::stoull(text.substr(text.find(before) + before.size())) >= durable);
  }
  const auto server = start_server(crash_config(folder / "world"), flat_creation());
  RawClient client(server->port());
  const auto accepted = client.join(1, kInstance);
  REQUIRE(accepted.has_value());
  CHECK(accepted->resolved >= durable);
  CHECK(accepted->resolved == client.welcome.durable);  // every edit of the log is of one client
  CHECK(client.welcome.epoch == 2);

  // Offers again every edit that may not be durable, and some that are.
  std::thread sender([&] {
    for (ClientSequence seq = durable - 50; seq <= kCrashEdits; ++seq) client.send(edit(seq));
  });
  ClientSequence answered = durable - 51;
  Sequence last = client.welcome.durable;
  while (answered < kCrashEdits) {
    const auto message = client.next();
    REQUIRE(message.has_value());
    if (const auto* reject = std::get_if<Reject>(&*message)) {
      CHECK(reject->client_seq == ++answered);
      CHECK(reject->reason == RejectReason::already_resolved);
      CHECK(answered <= accepted->resolved);
    } else if (const auto* commit = std::get_if<Commit>(&*message)) {
      for (const OrderedEdit& e : commit->edits) {
        CHECK(e.op.seq == ++answered);
        CHECK(answered > accepted->resolved);
        ++last;
      }
    }
  }
  sender.join();
  CHECK(last == kCrashEdits);

  client.send(View{1, {0, 0, 0}, 0, 0});
  const auto snapshot = client.next_of<ChunkSnapshot>();
  REQUIRE(snapshot.has_value());
  CHECK(snapshot->chunk.version.seq == kCrashEdits);
  for (ClientSequence seq = 1; seq <= kCrashEdits; ++seq) {
    const VoxelPos at = place_of(seq);
    REQUIRE(material_at(snapshot->chunk.voxels, local_of(at, 16)) == material_of(seq));
  }
  CHECK(server->stop().is_clean);
}

}  // namespace
}  // namespace runstone::test
