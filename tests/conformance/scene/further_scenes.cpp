#include <algorithm>

#include "protocol/codec/chunk_entries.hpp"
#include "tests/conformance/scene/scene.hpp"

namespace runstone::conformance {
namespace {

void play_encoding(Stage& stage, ChunkEncoding encoding) {
  for (std::int32_t i = 0; i < 30; ++i) {
    const VoxelPos at{i * 7 % 41 - 20, i * 5 % 13, i * 11 % 37 - 18};
    static_cast<void>(stage.world().order(
        Stage::kOther,
        {FillSphere{at, static_cast<std::uint16_t>(i % 4)}, {}, static_cast<Material>(1 + i % 6)}));
  }
  JoinSetup setup;
  setup.encoding = encoding;
  stage.join(setup);
  stage.wait_same_voxels(std::string("after chunks in the encoding ") + name_of(encoding));
}

DigestCheck check_of(ChunkCoord at, const Version& version, const Digest& digest) {
  DigestCheck out;
  out.entries.push_back({{0, at}, version, digest});
  return out;
}

void play_digest(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the check");
  const Chunk& chunk = stage.world().chunk(kHome);
  const Digest other = chunk.digest + Digest{{1, 1}};
  stage.player().send(Message(check_of(kHome, chunk.version, other)));
  stage.wait_request(kHome, "after a digest that disagrees");
  stage.wait_same_voxels("after the chunk came again");
}

void play_digest_of_lost_commit(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the edit");
  // The commit is lost, and no other edit of the chunk shows the gap.
  static_cast<void>(
      stage.world().order(Stage::kOther, {FillSphere{{8, 5, 8}, 4}, {}, SceneWorld::kBrick}));
  const Chunk& chunk = stage.world().chunk(kHome);
  stage.player().send(Message(check_of(kHome, chunk.version, chunk.digest)));
  stage.wait_ms(50);
  stage.player().send(Message(check_of(kHome, chunk.version, chunk.digest)));
  stage.wait_request(kHome, "after two checks of a version that it does not have");
  stage.wait_same_voxels("after the chunk came again");
}

void play_claims(Stage& stage) {
  stage.join();
  stage.commit(EditDescriptor{SetVoxel{{3, 9, 3}}, {}, SceneWorld::kLamp});
  stage.player().send(Message(Durable{stage.world().epoch(), stage.world().head()}));
  stage.wait_same_voxels("before the cut");
  const Version before = stage.world().chunk(kHome).version;
  stage.cut();
  const EditDescriptor edit{FillSphere{{8, 5, 8}, 4}, {}, SceneWorld::kBrick};
  const OrderedEdit missing = stage.world().order(Stage::kOther, edit);
  stage.answers_views = false;
  JoinSetup setup;
  setup.change = [&](Welcome& welcome) { welcome.durable = welcome.head; };
  stage.join(setup);
  if (stage.claims.empty()) throw SceneUntried{"the client claims nothing"};
  // The chunk at home gets the edit that it lacks, other claims are current, the rest is sent.
  std::vector<ChunkCoord> rest;
  ChunksNotModified current;
  current.view = stage.view().number;
  for (const ChunkCoord at : stage.seen()) {
    const auto claim = std::find_if(stage.claims.begin(), stage.claims.end(),
                                    [&](const CachedChunk& c) { return c.key.at == at; });
    if (claim == stage.claims.end()) {
      rest.push_back(at);
    } else if (at == kHome) {
      if (claim->version != before) throw SceneFailed{"a claim has another version"};
      const Chunk& chunk = stage.world().chunk(at);
      const ChunkEdits edits{
          {0, at}, before.seq, chunk.version, chunk.digest, {{missing.seq, edit}}};
      const ChunkEntry entry = encode_chunk_edits(edits);
      stage.player().send(join_entries(stage.view().number, {&entry, 1}));
    } else if (claim->version == stage.world().chunk(at).version) {
      if (claim->digest != claim_digest(stage.world().chunk(at).digest))
        throw SceneFailed{"a claim has another digest"};
      current.chunks.push_back({{0, at}, claim->version.seq});
    } else {
      rest.push_back(at);
    }
  }
  if (!current.chunks.empty()) stage.player().send(Message(current));
  if (!rest.empty()) stage.send_chunks(rest);
  stage.wait_same_voxels("after answers to its claims");
}

void play_receive_ack(Stage& stage) {
  JoinSetup setup;
  setup.features = kFeatureReceiveAck;
  stage.connect();
  if ((stage.hello().features & kFeatureReceiveAck) == 0)
    throw SceneUntried{"the client does not offer it"};
  stage.welcome(setup);
  stage.accept(setup);
  stage.wait_until([&] { return stage.has_view(); }, "no View");
  stage.wait_until([&] { return stage.acknowledged == stage.player().chunk_bytes_sent(); },
                   "the client does not acknowledge all terrain");
  stage.wait_same_voxels("after terrain that it acknowledged");
}

}  // namespace

std::vector<Scene> further_scenes() {
  using enum Part;
  return {
      {"packed-chunks", "Chunk bytes", further, "shows packed chunks",
       [](Stage& stage) { play_encoding(stage, ChunkEncoding::packed); }},
      {"coded-chunks", "Chunk bytes", further, "shows coded chunks",
       [](Stage& stage) { play_encoding(stage, ChunkEncoding::coded); }},
      {"digest", "Digest checks", further, "requests a chunk whose digest disagrees", play_digest},
      {"digest-of-lost-commit", "Digest checks", further,
       "requests a chunk that stays below the version of two checks", play_digest_of_lost_commit},
      {"claims", "Cached chunks", further, "claims its chunks after a lost connection",
       play_claims},
      {"receive-ack", "Pacing", further, "acknowledges terrain", play_receive_ack},
  };
}

}  // namespace runstone::conformance
