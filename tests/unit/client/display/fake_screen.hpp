// FakeScreen: a screen without OpenGL that records its calls. A test can hold its frames.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "client/display/screen.hpp"

namespace runstone::test {

/// The state that a test and its screen share. Thread: any.
class FakeScreenLog {
 public:
  void write(std::string line) {
    const std::lock_guard lock(mutex_);
    lines_.push_back(std::move(line));
  }
  std::vector<std::string> lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
  }
  /// After this call a frame ends only with release().
  void hold() {
    const std::lock_guard lock(mutex_);
    held_ = true;
  }
  /// After this call an upload ends only with release(). Its line is written when it begins.
  void hold_uploads() {
    const std::lock_guard lock(mutex_);
    uploads_held_ = true;
  }
  void release() {
    {
      const std::lock_guard lock(mutex_);
      held_ = uploads_held_ = false;
    }
    changed_.notify_all();
  }
  void release_uploads() {
    {
      const std::lock_guard lock(mutex_);
      uploads_held_ = false;
    }
    changed_.notify_all();
  }
  void wait_until_uploading() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return uploading_; });
  }
  void wait_until_drawing() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return drawing_; });
  }
  /// Makes the next frame throw.
  void fail_next() {
    const std::lock_guard lock(mutex_);
    fails_ = true;
  }

  void upload(std::string line) {
    std::unique_lock lock(mutex_);
    lines_.push_back(std::move(line));
    uploading_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !uploads_held_; });
    uploading_ = false;
  }
  void draw() {
    std::unique_lock lock(mutex_);
    lines_.emplace_back("draw");
    drawing_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !held_; });
    drawing_ = false;
    if (fails_) throw std::runtime_error("the cable is out");
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> lines_;
  bool held_ = false, drawing_ = false, fails_ = false;
  bool uploads_held_ = false, uploading_ = false;
};

class FakeScreen final : public Screen {
 public:
  explicit FakeScreen(FakeScreenLog& screen_log) : log_(screen_log) {}
  ~FakeScreen() override { log_.write("gone"); }

  const char* name() const override { return "fake"; }
  void set_materials(const MaterialTable& materials, const ShapeTablePtr& shapes) override {
    const bool has_shapes = shapes != nullptr && !shapes->empty();
    log_.write("materials " + std::to_string(materials.size()) +
               (has_shapes ? " shapes " + std::to_string(shapes->serial()) : ""));
  }
  void set_textures(const DrawnTexturesPtr& textures) override {
    log_.write("textures " + std::to_string(textures ? textures->pictures.size() : 0));
  }
  void upload(const ChunkKey& key, std::int32_t /*edge*/, const ChunkMesh& mesh,
              const RunChunk* /*voxels*/) override {
    log_.upload("upload " + std::to_string(key.at.x) + " quads " +
                std::to_string(mesh.quad_count()));
  }
  void upload_tile(const ChunkKey& key, std::int32_t /*edge*/, const TileMesh& mesh) override {
    log_.upload("tile " + std::to_string(key.lod) + " " + std::to_string(key.at.x) + " quads " +
                std::to_string(mesh.whole.quad_count()));
  }
  void remove(const ChunkKey& key) override { log_.write("remove " + std::to_string(key.at.x)); }
  void set_overlay(std::shared_ptr<const OverlayFrame> overlay) override {
    if (overlay) log_.write("overlay " + std::to_string(overlay->vertices.size()));
  }
  RenderStats draw(const Camera& /*camera*/, int width, int height,
                   const FrameContents& /*contents*/) override {
    width_ = width;
    height_ = height;
    log_.draw();
    return {};
  }
  Image read_image() override {
    return {width_, height_,
            std::vector<std::uint8_t>(static_cast<std::size_t>(width_) *
                                      static_cast<std::size_t>(height_) * 3)};
  }

 private:
  FakeScreenLog& log_;
  int width_ = 0, height_ = 0;
};

inline std::function<std::unique_ptr<Screen>()> fake_screen_on(FakeScreenLog& screen_log) {
  return [&screen_log] { return std::make_unique<FakeScreen>(screen_log); };
}

}  // namespace runstone::test
