#include "bench/client/gl/client_rig.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <utility>

#include "bench/worlds/seeded_worlds.hpp"
#include "client/replica/surface.hpp"
#include "common/core/assert.hpp"
#include "common/core/chunk_distance.hpp"
#include "common/core/hash.hpp"
#include "common/os/steady_clock.hpp"
#include "tests/support/codec/chunks_message.hpp"

namespace runstone::bench {
namespace {

constexpr AuthorId kOther = 9;
constexpr double kEyeHeight = 12;  // voxels above the ground
/// The own edits change this voxel, so many voxels before the camera.
constexpr std::int32_t kEditAhead = 6;

std::uint64_t hash_of(const Image& image) {
  std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a
  for (const std::uint8_t byte : image.rgb) hash = (hash ^ byte) * 1099511628211ULL;
  return hash;
}

}  // namespace

/// A screen that reads back each frame.
class ClientRig::WatchedScreen final : public Screen {
 public:
  WatchedScreen(std::unique_ptr<Screen> screen, ClientRig& rig)
      : screen_(std::move(screen)), rig_(rig) {}
  const char* name() const override { return screen_->name(); }
  void set_materials(const MaterialTable& materials, const ShapeTablePtr& shapes) override {
    screen_->set_materials(materials, shapes);
  }
  void set_textures(const DrawnTexturesPtr& textures) override { screen_->set_textures(textures); }
  void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
              const RunChunk* voxels) override {
    screen_->upload(key, edge, mesh, voxels);
  }
  void upload_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh) override {
    screen_->upload_tile(key, edge, mesh);
  }
  void remove(const ChunkKey& key) override { screen_->remove(key); }
  void set_overlay(std::shared_ptr<const OverlayFrame> overlay) override {
    screen_->set_overlay(std::move(overlay));
  }
  RenderStats draw(const Camera& camera, int width, int height,
                   const FrameContents& contents) override {
    const RenderStats stats = screen_->draw(camera, width, height, contents);
    const std::uint64_t hash = hash_of(screen_->read_image());
    const std::lock_guard lock(rig_.pixels_mutex_);
    rig_.pixels_ = hash;
    return stats;
  }
  Image read_image() override { return screen_->read_image(); }

 private:
  std::unique_ptr<Screen> screen_;
  ClientRig& rig_;
};

ClientRig::ClientRig(const VoxelWorld& world, const RigOptions& options)
    : options_(options),
      world_(world),
      draw_thread_(std::make_unique<DrawThread>(
          [this]() -> std::unique_ptr<Screen> {
            if (!options_.watches_pixels) return make_screen(make_headless_context());
            return std::make_unique<WatchedScreen>(make_screen(make_headless_context()), *this);
          },
          DrawPriority::normal, [this] { wake_.notify(); }, options.budget)),
      pipeline_(replica_, draw_thread_.get(), true, 1, [this] { wake_.notify(); }) {
  // Frames are those of a window. Where pixels are compared, nothing else may change them.
  pipeline_.look().set_exact(options.watches_pixels);
  pipeline_.look().set_quality(options.quality);
  pipeline_.set_materials(seeded_materials());
  load();
}

void ClientRig::load() {
  replica_.set_view({1, {0, 0, 0}, kRadius, kRadiusV});
  static_cast<void>(replica_.open({kEdge, 5, 77, 1, 0, 0, 0}));
  for (std::int32_t x = -kRadius; x <= kRadius; ++x) {
    for (std::int32_t z = -kRadius; z <= kRadius; ++z) {
      if (!replica_.view()->contains({x, 0, z})) continue;
      columns_.push_back({x, 0, z});
      for (std::int32_t y = -kRadiusV; y <= kRadiusV; ++y) {
        const ChunkCoord at{x, y, z};
        authority_.put(at, chunk_of_world(world_, origin_of(at, kEdge), kEdge));
        replica_.receive(test::chunks_of(authority_.snapshot(at)), {});
      }
    }
  }
  std::sort(columns_.begin(), columns_.end(), [](ChunkCoord a, ChunkCoord b) {
    const std::int64_t near = distance_squared(a, {}), far = distance_squared(b, {});
    return near != far ? near < far : a < b;
  });
  finish();
}

FrameOrder ClientRig::order() const {
  FrameOrder out;
  const auto ground = surface_of(replica_, 0, 0);
  out.camera.x = 0.5;
  out.camera.y = ground.value_or(0) + kEyeHeight;
  out.camera.z = 0.5;
  out.camera.pitch = -0.9;
  out.camera.far = (kRadius + 1.5) * kEdge;
  out.width = options_.width;
  out.height = options_.height;
  return out;
}

void ClientRig::turn() {
  const auto mesh = [this] {
    const TimeUs start_us = steady_now_us();
    pipeline_.mesh();
    mesh_us_ += steady_now_us() - start_us;
  };
  pipeline_.take(replica_.drain_changes(), ClockOffset{}, steady_now_us());
  const std::uint64_t presented = pipeline_.frames_presented();
  pipeline_.take_drawn();
  // A mesh made while the frame before was in progress delays no frame.
  if (pipeline_.frames_presented() != presented) mesh_us_ = 0;
  mesh();  // a client flushes twice a turn
  mesh();
  const TimeUs now_us = steady_now_us();
  if (!pipeline_.is_frame_due(now_us)) return;
  pipeline_.draw(now_us, order());
  ordered_mesh_us_ = std::exchange(mesh_us_, 0);
}

FrameCost ClientRig::frame() {
  pipeline_.set_frame_interval(0);
  const std::uint64_t presented = pipeline_.frames_presented();
  while (pipeline_.frames_presented() == presented) {
    pipeline_.moved();
    // A mesh made after this turn took the frame belongs to the next frame.
    const TimeUs before_us = ordered_mesh_us_;
    turn();
    if (pipeline_.frames_presented() != presented) {
      const FrameDone& done = pipeline_.recent_frames().back();
      return {before_us, done.upload_us, done.presented_us - done.started_us, done.uploads,
              done.carried};
    }
    wake_.wait(std::chrono::milliseconds(2));
  }
  return {};
}

void ClientRig::finish() {
  while (!pipeline_.is_up_to_date()) frame();
  frame();
}

void ClientRig::receive_edits(unsigned count) {
  RUNSTONE_ASSERT(count <= columns_.size());
  std::vector<std::pair<OperationId, EditDescriptor>> edits;
  for (unsigned i = 0; i < count; ++i) {
    const VoxelPos origin = origin_of(columns_[i], kEdge);
    const std::int32_t x = origin.x + kEdge / 2, z = origin.z + kEdge / 2;
    const auto ground = surface_of(replica_, x, z);
    if (!ground) continue;
    edits.push_back({{kOther, 1, ++edits_}, {SetVoxel{{x, *ground, z}}, {}, kEmpty}});
  }
  const auto taken = replica_.receive(authority_.commit(edits), {});
  RUNSTONE_ASSERT(taken);
}

void ClientRig::edit() {
  const std::int32_t y = surface_of(replica_, 0, kEditAhead).value_or(0);
  const bool is_set = own_edits_++ % 2 == 1;
  const VoxelPos at{0, is_set ? y : y + 1, kEditAhead};
  const Material material = is_set ? kEmpty : id_of(Block::brick);
  const auto submitted =
      replica_.predict({SetVoxel{at}, {}, material}, steady_now_us(), steady_now_us());
  RUNSTONE_ASSERT(submitted);
}

std::uint64_t ClientRig::pixels() const {
  const std::lock_guard lock(pixels_mutex_);
  return pixels_;
}

}  // namespace runstone::bench
