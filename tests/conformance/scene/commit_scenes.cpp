#include <algorithm>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "tests/conformance/scene/scene.hpp"

namespace runstone::conformance {
namespace {

EditDescriptor ball_at(VoxelPos at, Material material) { return {FillSphere{at, 4}, {}, material}; }

void play_commits(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the edits");
  ClipboardBuilder cells({3, 2, 2});
  cells.append(5, SceneWorld::kLamp);
  cells.append(4, std::nullopt);
  cells.append(3, kEmpty);
  const Paste paste{{-1, 4, -1}, *cells.finish(), Orientation{}.rotated_about_y(1)};
  const EditDescriptor edits[] = {
      {SetVoxel{{3, 9, -3}}, {}, SceneWorld::kLamp},
      {FillBox{{{-9, 1, -9}, {9, 4, 9}}}, {MaskKind::only_solid, kEmpty}, SceneWorld::kBrick},
      {FillBox{{{-9, 2, 0}, {2, 9, 9}}}, {MaskKind::only_empty, kEmpty}, SceneWorld::kGlass},
      {FillBox{{{-20, 0, -20}, {20, 9, 20}}},
       {MaskKind::only_material, SceneWorld::kMoss},
       SceneWorld::kStone},
      ball_at({16, 16, 16}, SceneWorld::kBrick),
      {FillStroke{{{-12, 3, -12}, {12, 9, 10}, {12, 1, 20}}, 2}, {}, SceneWorld::kGlass},
      {paste, {}, kEmpty},
      ball_at({0, 0, 0}, kEmpty),
  };
  for (const EditDescriptor& edit : edits) stage.commit(edit);
  stage.wait_same_voxels("after edits of each kind");
}

void play_early_commit(Stage& stage) {
  stage.answers_views = false;
  stage.join();
  stage.answers_views = true;
  // The snapshot is of before the commits, which it meets at the client.
  const ChunkEntry entry =
      encode_snapshot({0, kHome}, stage.world().chunk(kHome), ChunkEncoding::raw);
  stage.commit(ball_at({8, 5, 8}, SceneWorld::kBrick));
  stage.commit(ball_at({6, 5, 8}, kEmpty));
  stage.wait_ms(30);
  stage.player().send(join_entries(stage.view().number, {&entry, 1}));
  std::vector<ChunkCoord> others = stage.seen();
  std::erase(others, kHome);
  stage.send_chunks(others);
  stage.wait_same_voxels("after commits before their snapshot");
}

void play_contained_commit(Stage& stage) {
  stage.answers_views = false;
  stage.join();
  stage.answers_views = true;
  const OrderedEdit first =
      stage.world().order(Stage::kOther, ball_at({8, 5, 8}, SceneWorld::kBrick));
  static_cast<void>(stage.world().order(Stage::kOther, ball_at({8, 5, 8}, kEmpty)));
  stage.answer_view();
  stage.wait_same_voxels("after snapshots that contain two edits");
  // Whoever applies it again shows the ball that the second edit has removed.
  stage.player().send(Message(stage.world().commit_of(first)));
  stage.commit(EditDescriptor{SetVoxel{{1, 9, 1}}, {}, SceneWorld::kLamp});
  stage.wait_same_voxels("after commits that the snapshots contain");
}

void play_lost_commit(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the gap");
  static_cast<void>(stage.world().order(Stage::kOther, ball_at({8, 5, 8}, SceneWorld::kBrick)));
  stage.commit(EditDescriptor{SetVoxel{{8, 5, 8}}, {}, SceneWorld::kLamp});
  stage.wait_request(kHome, "after a commit whose predecessor was lost");
  stage.commit(EditDescriptor{SetVoxel{{9, 5, 8}}, {}, SceneWorld::kGlass});
  stage.wait_same_voxels("after the gap was repaired");
}

void play_older_snapshot(Stage& stage) {
  stage.join();
  const ChunkEntry old =
      encode_snapshot({0, kHome}, stage.world().chunk(kHome), ChunkEncoding::raw);
  stage.wait_same_voxels("before the edit");
  stage.commit(ball_at({8, 5, 8}, SceneWorld::kBrick));
  stage.wait_same_voxels("after the edit");
  stage.player().send(join_entries(stage.view().number, {&old, 1}));
  // What follows in the same class tells that the old snapshot was handled.
  static_cast<void>(
      stage.world().order(Stage::kOther, {SetVoxel{{20, 9, 8}}, {}, SceneWorld::kLamp}));
  stage.send_chunks({{1, 0, 0}});
  stage.wait_same_voxels("after a snapshot that is older than the chunk");
}

void play_ignored(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the messages");
  PlayerList list;
  list.players.push_back({Stage::kAuthor, "builder", stage.hello().key, "member"});
  list.players.push_back({9, "somebody", {}, ""});
  stage.player().send(Message(list));
  stage.player().send(Message(PlayerPoses{{{9, {}}}}));
  stage.player().send(Message(Durable{stage.world().epoch(), 0, true}));
  stage.player().send(Message(Durable{stage.world().epoch(), 0, false}));
  DigestCheck check;
  check.entries.push_back({{0, kHome}, {}, stage.world().chunk(kHome).digest});
  stage.player().send(Message(check));
  stage.commit(EditDescriptor{SetVoxel{{1, 9, 1}}, {}, SceneWorld::kLamp});
  stage.wait_same_voxels("after messages that a client may ignore");
}

}  // namespace

std::vector<Scene> commit_scenes() {
  using enum Part;
  return {
      {"commits", "Versions and commits", minimum, "applies edits of each kind with each mask",
       play_commits},
      {"early-commit", "Versions and commits", minimum,
       "keeps a commit that overtakes its snapshot", play_early_commit},
      {"contained-commit", "Versions and commits", minimum,
       "drops a commit that the snapshot contains", play_contained_commit},
      {"lost-commit", "Versions and commits", minimum,
       "requests a chunk that missed an edit, and repairs it", play_lost_commit},
      {"older-snapshot", "Versions and commits", minimum,
       "ignores a snapshot that is older than its chunk", play_older_snapshot},
      {"ignored-messages", "Minimum client", minimum, "goes on after messages that it may ignore",
       play_ignored},
  };
}

}  // namespace runstone::conformance
