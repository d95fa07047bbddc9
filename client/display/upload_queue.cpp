#include "client/display/upload_queue.hpp"

#include <algorithm>

#include "common/core/chunk_distance.hpp"
#include "common/core/tile_keys.hpp"

namespace runstone {

std::size_t gpu_bytes(const ChunkMesh& mesh, const RunChunk* voxels) {
  std::size_t light = 0;
  if (voxels != nullptr && !voxels->is_uniform())
    light = voxels->runs.byte_size() + std::size_t{voxels->extent.x} * voxels->extent.z;
  return mesh.quad_count() * sizeof(Quad) + light;
}

std::size_t gpu_bytes(const TileMesh& mesh) {
  constexpr std::size_t kLayersBytes = 1024;
  return mesh.empty() ? 0
                      : mesh.quad_count() * sizeof(Quad) + kLayersBytes * (1 + mesh.octants.size());
}

std::size_t gpu_bytes(const ChunkUpload& upload) {
  return upload.tile ? gpu_bytes(*upload.tile) : gpu_bytes(*upload.mesh, upload.voxels.get());
}

void UploadQueue::put(const ChunkKey& key, ChunkUpload upload) {
  removals_.erase(key);
  const auto [found, is_new] = uploads_.try_emplace(key);
  Entry& entry = found->second;
  if (is_new) {
    entry.since = frame_;
    ages_.emplace_back(frame_, key);
  } else {
    order_.erase(entry.rank);
    upload.urgency = std::max(upload.urgency, entry.upload.urgency);
  }
  entry.upload = std::move(upload);
  place(key, entry);
}

void UploadQueue::remove(const ChunkKey& key) {
  if (const auto found = uploads_.find(key); found != uploads_.end()) {
    order_.erase(found->second.rank);
    uploads_.erase(found);
  }
  removals_.insert(key);
}

void UploadQueue::place(const ChunkKey& key, Entry& entry) {
  constexpr int kOverdue = 1;
  int rank = entry.upload.urgency == Urgency::local_edit ? 0
             : entry.upload.urgency == Urgency::edit     ? 2
             : key.lod == 0                              ? 3
                                                         : 4;
  if (entry.is_overdue) rank = std::min(rank, kOverdue);
  entry.rank = Rank{rank, key.lod, distance_squared(key.at, tile_at(eye_, key.lod)), key};
  order_.insert(entry.rank);
}

void UploadQueue::set_eye(ChunkCoord eye) {
  if (eye == eye_) return;
  eye_ = eye;
  order_.clear();
  for (auto& [key, entry] : uploads_) place(key, entry);
}

void UploadQueue::frame_passed() {
  ++frame_;
  while (!ages_.empty() && frame_ - ages_.front().first >= kPatience) {
    const auto [since, key] = ages_.front();
    ages_.pop_front();
    const auto found = uploads_.find(key);
    // The chunk may have left the queue, and have come back since.
    if (found == uploads_.end() || found->second.since != since) continue;
    order_.erase(found->second.rank);
    found->second.is_overdue = true;
    place(key, found->second);
  }
}

std::vector<ChunkKey> UploadQueue::take_removals() {
  std::vector<ChunkKey> out(removals_.begin(), removals_.end());
  removals_.clear();
  return out;
}

std::optional<std::pair<ChunkKey, ChunkUpload>> UploadQueue::take_upload() {
  if (order_.empty()) return std::nullopt;
  const ChunkKey key = std::get<ChunkKey>(*order_.begin());
  order_.erase(order_.begin());
  auto entry = uploads_.extract(key);
  if (uploads_.empty()) ages_.clear();
  return std::pair{key, std::move(entry.mapped().upload)};
}

}  // namespace runstone
