// UploadTracker: which meshes are on their way to the screen: queued for upload, or uploaded and in
// no frame yet. Pure. One thread. Cost: O(log chunks) per call. Memory: a number for each mesh with
// an edit since the newest upload of its chunk.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "client/replica/replica_changes.hpp"
#include "common/core/coords.hpp"

namespace runstone {

class UploadTracker {
 public:
  /// Records that a mesh was queued, in place of one of the same chunk that was not uploaded yet.
  /// `number` rises with every mesh of a chunk.
  void queued(const ChunkKey& key, std::uint64_t number, Urgency urgency);
  /// Records that the chunk will not be uploaded.
  void removed(const ChunkKey& key);
  /// Records that the mesh of this number is on the GPU. It contains what the meshes before it did.
  void uploaded(const ChunkKey& key, std::uint64_t number);
  /// Records that a frame with all meshes uploaded so far is on the screen.
  void presented();

  /// Returns true if every mesh that was queued is on the screen.
  bool empty() const { return waiting_.empty() && !has_uploaded_; }
  /// Returns true if a mesh with an edit is not on the screen.
  bool has_edits() const { return chunks_with_edits_ != 0 || first_uploaded_edit_ != kNone; }
  /// Returns true if an edit that was first in a mesh with a number up to `number` is not on the
  /// screen. Cost: O(meshes that wait).
  bool has_edits_up_to(std::uint64_t number) const;

 private:
  struct Waiting {
    std::uint64_t number = 0;          // of the newest mesh
    std::vector<std::uint64_t> edits;  // numbers of meshes with edits, ascending
  };
  static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

  std::map<ChunkKey, Waiting> waiting_;
  std::size_t chunks_with_edits_ = 0;  // of waiting_
  bool has_uploaded_ = false;
  std::uint64_t first_uploaded_edit_ = kNone;
};

}  // namespace runstone
