// A server that must stop sooner than its changed chunks can be written. The next start has every
// edit.
#include <catch2/catch.hpp>

#include "common/edits/apply/edit_stack.hpp"
#include "server/history/base_chunk.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kBoxes = 24;

/// Returns a box of a thousand voxels by nine hundred, one voxel high, beside the others. It
/// touches 64 x 57 chunks.
EditDescriptor wide_box(std::int32_t n) {
  const std::int32_t x = n * 1024;
  return {FillBox{{{x, 5, 0}, {x + 1024, 6, 901}}}, {}, static_cast<Material>(1 + n % 5)};
}

}  // namespace

TEST_CASE("a stop with too little time leaves chunks to the next start, which has every edit",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.stop_s = 1;
  {
    const auto server = start_server(config, flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(1).has_value());
    for (std::int32_t n = 0; n < kBoxes; ++n)
      client.send(EditRequest{static_cast<ClientSequence>(n + 1), 0, wide_box(n)});
    REQUIRE(client.sees_durable(kBoxes));
    const StopReport report = server->stop();
    CHECK(report.state.is_durable());
    CHECK(report.state.chunks_left > 0);
    CHECK_FALSE(report.is_clean);
    CHECK(report.error.empty());
    CHECK(stop_line(report) ==
          "stopped seq=24 chunks_left=" + std::to_string(report.state.chunks_left) +
              " live=" + std::to_string(report.live_chunks));
  }
  const auto store = *open_world(folder / "world", StoreAccess::read_only);
  CHECK(*store->checkpoint() == 0);
  const auto generator = *make_generator(store->meta().generator, store->meta().materials);
  const auto server = start_server(config, {});
  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  for (const std::int32_t n : {0, kBoxes / 2, kBoxes - 1}) {
    const ChunkKey key{0, {n * 64 + 7, 0, 30}};
    Chunk expected = *base_chunk(*store, *generator, key);
    ApplyScratch scratch;
    const std::vector<EditDescriptor> edits = {wide_box(n)};
    apply_stack(expected.voxels, expected.digest, origin_of(key.at, 16), edits, scratch);
    client.send(View{1, key.at, 0, 0});
    const auto snapshot = client.next_of<ChunkSnapshot>();
    REQUIRE(snapshot.has_value());
    CHECK(snapshot->key == key);
    CHECK(snapshot->chunk.version == Version{1, static_cast<Sequence>(n + 1)});
    CHECK(snapshot->chunk.digest == expected.digest);
  }
  CHECK(server->stop().state.is_durable());
}

}  // namespace runstone::test
