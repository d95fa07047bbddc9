// Transfer scenes: a few chunks, sent in one of four forms and meshed as they arrive. This is the
// thesis' question about networks.
//   dense       2 bytes a voxel, x fastest; meshed by binary greedy meshing of the grid
//   dense_zstd  the same, each chunk compressed with zstd, level 3; meshed likewise
//   raw         the protocol's snapshots with runs as in memory; meshed by RDM
//   packed      the protocol's snapshots with packed runs; meshed by RDM
// raw and packed go through the protocol's frames, decoder and digests, as in a client.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::bench {

enum class Transfer : std::uint8_t { dense, dense_zstd, raw, packed };
inline constexpr std::array kTransfers = {Transfer::dense, Transfer::dense_zstd, Transfer::raw,
                                          Transfer::packed};
const char* name_of(Transfer transfer);

/// Chunks of one edge. There is nothing around them.
struct TransferScene {
  std::string name;
  unsigned edge = 32;  // up to 62
  std::map<ChunkCoord, RunChunk> chunks;
  std::shared_ptr<const VisibilityTable> visibility;
};

/// Returns all chunks as a stream of bytes, in order of their coordinates.
Bytes encode_scene(const TransferScene& scene, Transfer transfer);

/// Times in ns of wall time, and counts of the result.
struct TransferTimes {
  std::uint64_t unpack_ns = 0, mesh_ns = 0;
  std::size_t quads = 0;
  std::uint64_t faces = 0;  // unit faces that the quads cover: equal for every form of a scene
};

/// Reads the stream of a scene in pieces. Unpacks each chunk when it is complete, and meshes it
/// when its neighbours have arrived, too. Thread: one.
class SceneReceiver {
 public:
  /// `scene` gives the coordinates of the chunks and the visibility of materials; its voxels are
  /// not read. It must outlive the receiver.
  SceneReceiver(const TransferScene& scene, Transfer transfer);
  ~SceneReceiver();
  /// Fails on bytes that are no such stream.
  Result<void, std::string> feed(ByteView bytes);
  bool complete() const;
  const TransferTimes& times() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone::bench
