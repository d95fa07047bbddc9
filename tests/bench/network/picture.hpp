// The picture of a few chunks, sent in one of four forms and meshed as it comes in: what the thesis asks about.
//   dense       2 bytes a voxel, x fastest; meshed by binary greedy meshing of the grid
//   dense_zstd  the same, each chunk compressed with zstd, level 3; meshed likewise
//   raw         snapshots as the protocol has them, runs as they lie in memory; meshed by RDM
//   packed      snapshots with packed runs; meshed by RDM
// raw and packed go through the protocol's frames, decoder and digests as they do in a client.
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

/// Chunks of one edge; what is beside them and not among them is not there.
struct PictureScene {
  std::string name;
  unsigned edge = 32;  // up to 62
  std::map<ChunkCoord, RunChunk> chunks;
  std::shared_ptr<const VisibilityTable> visibility;
};

/// All chunks as a stream of bytes, in order of their coordinates.
Bytes encode_picture(const PictureScene& scene, Transfer transfer);

/// Nanoseconds of wall time, and what came out.
struct PictureTimes {
  std::uint64_t unpack_ns = 0, mesh_ns = 0;
  std::size_t quads = 0;
  std::uint64_t faces = 0;  // unit faces that the quads cover: equal for every form of one scene
};

/// Takes the stream of a scene in pieces; unpacks each chunk when it is whole, and meshes it when what is beside it is
/// here too. One thread.
class PictureReceiver {
 public:
  /// `scene` says which chunks come and how materials look; its voxels are not read. It must outlive the receiver.
  PictureReceiver(const PictureScene& scene, Transfer transfer);
  ~PictureReceiver();
  /// Fails on bytes that are no such stream.
  Result<void, std::string> feed(ByteView bytes);
  bool complete() const;
  const PictureTimes& times() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone::bench
