#include <algorithm>
#include <memory>
#include <utility>

#include "common/runs/run_builder.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/key_list.hpp"
#include "tests/conformance/scene/scene.hpp"

namespace runstone::conformance {
namespace {

/// Makes a snapshot of the chunk at home at a later version, with these chunk bytes.
EncodedMessage snapshot_of(Stage& stage, const Bytes& chunk_bytes, const Digest& digest) {
  Bytes bytes;
  ByteWriter out(bytes);
  out.u8(0);
  put_version(out, {stage.world().epoch(), stage.world().head() + 1});
  put_digest(out, digest);
  out.varint(chunk_bytes.size());
  out.bytes(chunk_bytes);
  const ChunkEntry entry{{0, kHome}, std::make_shared<const Bytes>(std::move(bytes)), 1};
  return join_entries(stage.view().number, {&entry, 1});
}

/// A message that breaks a rule. The client must end the session and show nothing of it.
using Hostile = EncodedMessage (*)(Stage& stage);

Scene hostile_message(std::string name, std::string section, std::string words, Hostile make) {
  return {std::move(name), std::move(section), Part::minimum,
          "ends the session after " + std::move(words), [make](Stage& stage) {
            stage.join();
            stage.wait_same_voxels("before the message");
            stage.player().send(make(stage));
            stage.wait_end("a malformed message");
            stage.check_no_other_voxels("after a malformed message");
          }};
}

RunChunk other_chunk(Extent extent = Extent::cube(SceneWorld::kEdge)) {
  RunBuilder builder(extent, AxisOrder::xyz);
  builder.append(100, SceneWorld::kLamp);
  builder.append(100, SceneWorld::kBrick);
  builder.append(extent.volume() - 200, kEmpty);
  return builder.finish();
}

EncodedMessage truncated_chunk(Stage& stage) {
  Bytes bytes = encode_chunk(other_chunk(), ChunkEncoding::raw);
  bytes.resize(bytes.size() - 4);
  return snapshot_of(stage, bytes, digest_of(other_chunk()));
}
EncodedMessage longer_chunk(Stage& stage) {
  Bytes bytes = encode_chunk(other_chunk(), ChunkEncoding::raw);
  bytes.push_back(0);
  return snapshot_of(stage, bytes, digest_of(other_chunk()));
}
EncodedMessage equal_neighbours(Stage& stage) {
  Bytes bytes = encode_chunk(other_chunk(), ChunkEncoding::raw);
  std::copy_n(bytes.begin() + 14, 2, bytes.begin() + 18);  // the material of the first run
  return snapshot_of(stage, bytes, digest_of(other_chunk()));
}
EncodedMessage short_of_volume(Stage& stage) {
  Bytes bytes = encode_chunk(other_chunk(), ChunkEncoding::raw);
  bytes[bytes.size() - 4] ^= 1;  // the end of the last run
  return snapshot_of(stage, bytes, digest_of(other_chunk()));
}
EncodedMessage other_edge(Stage& stage) {
  const RunChunk chunk = other_chunk(Extent::cube(32));
  return snapshot_of(stage, encode_chunk(chunk, ChunkEncoding::raw), digest_of(chunk));
}
EncodedMessage large_lane(Stage& stage) {
  return snapshot_of(stage, encode_chunk(other_chunk(), ChunkEncoding::raw),
                     Digest{{(std::uint64_t{1} << 61) - 1, 0}});
}
EncodedMessage truncated_buffer(Stage& stage) {
  const EncodedMessage whole =
      snapshot_of(stage, encode_chunk(other_chunk(), ChunkEncoding::raw), digest_of(other_chunk()));
  const auto half = static_cast<std::ptrdiff_t>(whole.bytes->size() / 2);
  return {whole.kind,
          std::make_shared<const Bytes>(whole.bytes->begin(), whole.bytes->begin() + half)};
}
EncodedMessage wrong_count(Stage& stage) {
  OrderedEdit edit =
      stage.world().order(Stage::kOther, {SetVoxel{{40'000, 9, 1}}, {}, SceneWorld::kLamp});
  edit.edit = {FillBox{{{1, 9, 1}, {20, 10, 2}}}, {}, SceneWorld::kLamp};  // it touches two chunks
  return encode_message(Message(stage.world().commit_of(edit)));
}
EncodedMessage unknown_edit(Stage& stage) {
  const EditDescriptor edit{SetVoxel{{40'000, 9, 1}}, {}, SceneWorld::kLamp};
  const EncodedMessage whole =
      encode_message(Message(stage.world().commit_of(stage.world().order(Stage::kOther, edit))));
  const Bytes descriptor = encode(edit);
  Bytes bytes = *whole.bytes;
  const auto at = std::search(bytes.begin(), bytes.end(), descriptor.begin(), descriptor.end());
  if (at != bytes.end()) *at = 5;  // a kind that is not used
  return {whole.kind, std::make_shared<const Bytes>(std::move(bytes))};
}
EncodedMessage not_in_force(Stage&) {
  return encode_message(
      Message(ChatLines{{{ChatLineKind::server, 0, "", "nobody asked", 1'700'000'000'000'000}}}));
}

}  // namespace

std::vector<Scene> message_scenes() {
  return {
      hostile_message("truncated-buffer", "Messages", "a message that is cut", truncated_buffer),
      hostile_message("truncated-chunk", "Chunk bytes", "chunk bytes that are cut",
                      truncated_chunk),
      hostile_message("longer-chunk", "Chunk bytes", "chunk bytes with a byte too many",
                      longer_chunk),
      hostile_message("equal-neighbours", "Chunk bytes",
                      "a chunk with neighbouring runs of one material", equal_neighbours),
      hostile_message("short-of-volume", "Chunk bytes", "a chunk whose last end is not its volume",
                      short_of_volume),
      hostile_message("other-edge", "Messages", "a chunk of another edge than the world",
                      other_edge),
      hostile_message("large-lane", "Messages", "a digest that is out of its range", large_lane),
      hostile_message("touched-count", "Versions and commits",
                      "a commit with another number of touched chunks", wrong_count),
      hostile_message("unknown-edit", "Messages", "a commit with an edit of an unknown kind",
                      unknown_edit),
      hostile_message("not-in-force", "Features and evolution",
                      "a message whose feature is not in force", not_in_force),
  };
}

}  // namespace runstone::conformance
