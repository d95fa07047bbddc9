// ClientRig: the parts of a client from the replica to the screen, without a server and a network.
// It holds a block of a world and draws it off screen. What a real client does in a turn of its
// main thread, turn() does here. Thread: one.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "bench/worlds/voxel_world.hpp"
#include "client/display/draw_thread.hpp"
#include "client/display/mesh_pipeline.hpp"
#include "client/net/wake_up.hpp"
#include "client/replica/replica.hpp"
#include "tests/support/codec/authority_model.hpp"

namespace runstone::bench {

/// The delays of one frame, in microseconds.
struct FrameCost {
  TimeUs mesh_us = 0;    // on the main thread, between the frame before and the order
  TimeUs upload_us = 0;  // on the draw thread, since the frame before
  TimeUs draw_us = 0;    // not counted as added
  std::size_t uploads = 0, carried = 0;
  TimeUs added_us() const { return mesh_us + upload_us; }
};

struct RigOptions {
  int width = 1280, height = 720;
  Quality quality = Quality::medium;
  UploadBudget budget;
  bool watches_pixels = false;  // reads every frame back, which costs time
};

class ClientRig {
 public:
  static constexpr std::int32_t kEdge = 32, kRadius = 9;
  static constexpr std::uint8_t kRadiusV = 1;

  /// Makes the chunks of `world` around its ground, a disc of kRadius chunks, and shows them.
  /// Throws std::runtime_error if there is no OpenGL.
  ClientRig(const VoxelWorld& world, const RigOptions& options);

  /// Runs turns until the next frame was presented. The frame is ordered as soon as the one before
  /// is presented.
  FrameCost frame();
  /// Runs turns and frames until everything is on the screen.
  void finish();
  /// Returns true if an edit is not on the screen yet.
  bool has_open_edits() const { return pipeline_.recorder().open_edits() != 0; }

  /// Receives edits of another player: one in the highest voxel of the middle column of each of the
  /// `count` nearest columns of chunks.
  void receive_edits(unsigned count);
  /// Makes an edit of this client in sight of the camera: sets a voxel, or clears it again.
  void edit();
  /// Returns a number that changes if the pixels of a presented frame differ from those before.
  /// Requires watches_pixels.
  std::uint64_t pixels() const;

 private:
  class WatchedScreen;

  void load();
  void turn();
  FrameOrder order() const;

  const RigOptions options_;
  const VoxelWorld& world_;
  test::AuthorityModel authority_{kEdge, 1};
  Replica replica_;
  std::vector<ChunkCoord> columns_;  // of chunks, from near to far
  ClientSequence edits_ = 0, own_edits_ = 0;
  mutable std::mutex pixels_mutex_;
  std::uint64_t pixels_ = 0;  // guarded by it
  WakeUp wake_;
  std::unique_ptr<DrawThread> draw_thread_;
  MeshPipeline pipeline_;
  TimeUs mesh_us_ = 0;          // since the last frame was presented
  TimeUs ordered_mesh_us_ = 0;  // before the last order
};

}  // namespace runstone::bench
