#include "tests/conformance/scene/scene.hpp"

#include "protocol/codec/chunk_entries.hpp"

namespace runstone::conformance {
namespace {

/// Makes chunks of many runs.
void build_town(SceneWorld& world) {
  for (std::int32_t i = 0; i < 40; ++i) {
    const VoxelPos at{i * 7 % 41 - 20, i * 5 % 13, i * 11 % 37 - 18};
    static_cast<void>(world.order(
        Stage::kOther,
        {FillSphere{at, static_cast<std::uint16_t>(i % 4)}, {}, static_cast<Material>(1 + i % 6)}));
  }
}

void play_raw(Stage& stage) {
  build_town(stage.world());
  stage.join();
  stage.wait_same_voxels("after raw chunks");
}

void play_missing(Stage& stage) {
  stage.world().damaged = {{0, 0, 0}, {0, 1, 0}, {1, -1, 0}};
  stage.join();
  stage.wait_same_voxels("with chunks that the server cannot send");
  // The answer that arrives last is the right one.
  stage.world().damaged.clear();
  stage.send_chunks({{0, 0, 0}, {0, 1, 0}, {1, -1, 0}});
  stage.wait_same_voxels("after chunks that were missing before");
}

void play_moved_view(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the move");
  const ChunkCoord before = stage.view().centre;
  stage.tell("move 200 20 -120");
  stage.wait_until([&] { return stage.view().centre != before; }, "no View after the move");
  stage.wait_same_voxels("after the move");
}

void play_fragments(Stage& stage) {
  build_town(stage.world());
  stage.answers_views = false;
  stage.join();
  stage.answers_views = true;
  // Small fragments of terrain, with a commit after each of them.
  std::vector<ChunkEntry> entries;
  for (const ChunkCoord at : {ChunkCoord{-1, 0, -1}, {-1, 0, 0}, {0, 0, 0}, {0, 0, 1}})
    entries.push_back(encode_snapshot({0, at}, stage.world().chunk(at), ChunkEncoding::raw));
  stage.player().queue(join_entries(stage.view().number, entries));
  for (std::int32_t i = 0; i < 12; ++i) {
    if (!stage.player().send_fragments(64)) break;
    const auto edit = stage.world().order(
        Stage::kOther, {SetVoxel{{i, 6, i}}, {}, static_cast<Material>(1 + i % 6)});
    stage.player().queue(encode_message(Message(stage.world().commit_of(edit))));
  }
  while (stage.player().send_fragments(64)) {
  }
  stage.answer_view();
  stage.wait_same_voxels("after fragments of two classes");
}

void play_unwanted(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the flood");
  // 80,000 chunks outside of the view, poses of 20,000 players and digests of chunks that the client
  // does not have.
  for (std::int32_t x = 0; x < 20; ++x) {
    UniformChunks far;
    far.view = stage.view().number;
    for (std::int32_t z = 0; z < 4'000; ++z)
      far.chunks.push_back({{0, {100 + x, 0, z}}, SceneWorld::kStone, {}});
    stage.player().send(Message(far));
    PlayerPoses poses;
    for (AuthorId author = 0; author < 1'000; ++author)
      poses.players.push_back({static_cast<AuthorId>(10 + author + 1'000 * x), {}});
    stage.player().send(Message(poses));
    DigestCheck check;
    for (std::int32_t z = 0; z < 1'000; ++z) check.entries.push_back({{0, {-200, x, z}}, {}, {}});
    stage.player().send(Message(check));
  }
  for (std::int32_t i = 0; i < 2'000; ++i)
    stage.commit(EditDescriptor{SetVoxel{{4'000 + i, 0, 0}}, {}, SceneWorld::kLamp});
  stage.commit(EditDescriptor{SetVoxel{{1, 8, 1}}, {}, SceneWorld::kLamp});
  stage.wait_same_voxels("after a flood");
  stage.check_no_other_voxels("after a flood");
}

}  // namespace

std::vector<Scene> terrain_scenes() {
  using enum Part;
  return {
      {"raw-chunks", "Chunk bytes", minimum, "shows raw and uniform chunks with the right voxels",
       play_raw},
      {"missing-chunks", "Unavailable chunks", minimum,
       "shows nothing where chunks are missing, until they come", play_missing},
      {"moved-view", "Views and snapshots", minimum, "moves its view and shows what is there",
       play_moved_view},
      {"fragments", "Frames", minimum, "joins fragments of messages of two classes",
       play_fragments},
      {"flood", "Views and snapshots", minimum,
       "ignores a flood of chunks, edits and poses outside of its view", play_unwanted},
  };
}

}  // namespace runstone::conformance
