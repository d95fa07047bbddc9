// MeshPool: threads that mesh. Jobs go in from and results come out to one thread (the client's main thread).
// Bounded: at most `capacity` jobs wait or run; push() answers false then, and the planner keeps the work,
// joined. With no workers a job is meshed inside push(): for tests and machines with one core.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "client/schedule/mesh_planner.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone {

struct MeshResult {
  ChunkKey key;
  std::uint64_t number = 0, serial = 0;  // of the job
  std::int32_t edge = 0;                 // voxels
  MeshPtr mesh;              // of its own, or the one that all chunks without quads share
  bool layers_only = false;  // the mesh before served for the rest
  std::int64_t mesh_ns = 0;  // from the job to the mesh
  TimeUs meshed_us = 0;      // when it was done
};

class MeshPool {
 public:
  using ClockNs = std::function<std::int64_t()>;  // steady, nanoseconds; called from workers
  using Wake = std::function<void()>;             // called from a worker after each result

  MeshPool(VisibilityTable visibility, unsigned workers, ClockNs clock, Wake wake);
  /// Drops jobs that wait, lets running ones end.
  ~MeshPool();
  MeshPool(const MeshPool&) = delete;
  MeshPool& operator=(const MeshPool&) = delete;

  bool push(MeshJob job);
  /// Meshes on the calling thread, the one that pushes.
  MeshResult mesh_here(const MeshJob& job) { return mesh(job, own_scratch_); }
  /// Results so far, in the order they were done.
  std::vector<MeshResult> take_results();
  /// Jobs that wait or run, and results not taken.
  std::size_t in_flight() const;
  std::size_t capacity() const { return capacity_; }

 private:
  struct Scratch {
    RdmScratch rdm;
    ChunkMesh mesh;  // grows; what is kept of it is a copy of the right size
  };
  void work(const std::stop_token& stop);
  MeshResult mesh(const MeshJob& job, Scratch& scratch) const;

  const VisibilityTable visibility_;
  const ClockNs clock_;
  const Wake wake_;
  const std::size_t capacity_;
  const MeshPtr empty_ = std::make_shared<const ChunkMesh>();
  mutable std::mutex mutex_;
  std::condition_variable_any work_there_;
  std::deque<MeshJob> jobs_;  // guarded by mutex_, as are the next two
  std::vector<MeshResult> results_;
  std::size_t in_flight_ = 0;
  Scratch own_scratch_;  // of the thread that pushes
  std::vector<std::jthread> threads_;
};

}  // namespace runstone
