#include "client/display/screen.hpp"

#include <utility>

#include "client/render/renderer.hpp"

namespace runstone {
namespace {

class GlScreen final : public Screen {
 public:
  explicit GlScreen(std::unique_ptr<GlContext> context)
      : context_(std::move(context)), renderer_(context_->loader()) {}

  const char* name() const override { return context_->name(); }
  void set_materials(const MaterialTable& materials, const ShapeTablePtr& shapes) override {
    renderer_.set_materials(materials, shapes);
  }
  void set_textures(const DrawnTexturesPtr& textures) override { renderer_.set_textures(textures); }
  void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
              const RunChunk* voxels) override {
    renderer_.upload(key, edge, mesh, voxels);
  }
  void upload_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh) override {
    renderer_.upload_tile(key, edge, mesh);
  }
  void remove(const ChunkKey& key) override { renderer_.remove(key); }
  void set_overlay(std::shared_ptr<const OverlayFrame> overlay) override {
    overlay_ = std::move(overlay);
  }
  RenderStats draw(const Camera& camera, int width, int height,
                   const FrameContents& contents) override {
    const RenderStats stats = renderer_.draw(camera, width, height, contents);
    if (overlay_) renderer_.draw_overlay(*overlay_);
    if (context_->is_window()) renderer_.present(width, height);
    if (context_->can_wait()) renderer_.finish();
    context_->swap();
    return stats;
  }
  Image read_image() override { return renderer_.read_image(); }

 private:
  std::unique_ptr<GlContext> context_;
  Renderer renderer_;  // destroyed before its context
  std::shared_ptr<const OverlayFrame> overlay_;
};

}  // namespace

std::unique_ptr<Screen> make_screen(std::unique_ptr<GlContext> context) {
  return std::make_unique<GlScreen>(std::move(context));
}

}  // namespace runstone
