// Screen: the target of frames, a window or an off-screen buffer. Thread: one thread, that of
// DrawThread, makes, uses and destroys it. The main thread makes the window before the screen,
// polls it, and destroys it after the screen.
#pragma once
#include <cstdint>
#include <memory>

#include "client/far/tile_mesh.hpp"
#include "client/platform/gl_context.hpp"
#include "client/render/drawn_textures.hpp"
#include "client/render/image.hpp"
#include "client/render/overlay_frame.hpp"
#include "client/render/renderer.hpp"
#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

class Screen {
 public:
  Screen() = default;
  virtual ~Screen() = default;
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Returns the name of the OpenGL context, a static string.
  virtual const char* name() const = 0;
  /// Passes its arguments to Renderer::set_materials().
  virtual void set_materials(const MaterialTable& materials, const ShapeTablePtr& shapes) = 0;
  /// Passes its argument to Renderer::set_textures().
  virtual void set_textures(const DrawnTexturesPtr& textures) = 0;
  /// See Renderer::upload(), upload_tile() and remove().
  virtual void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
                      const RunChunk* voxels) = 0;
  virtual void upload_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh) = 0;
  virtual void remove(const ChunkKey& key) = 0;
  /// Sets the user interface that the next frames have on top; null: none.
  virtual void set_overlay(std::shared_ptr<const OverlayFrame> overlay) = 0;
  /// Draws a frame of width x height pixels. Waits for the fence after the frame off screen, for
  /// the swap in a window, and for nothing in a page. Throws std::runtime_error if the driver
  /// fails.
  virtual RenderStats draw(const Camera& camera, int width, int height,
                           const FrameContents& contents) = 0;
  /// Returns the last frame. Requires a draw() before.
  virtual Image read_image() = 0;
};

/// Returns a screen on which a Renderer draws. Requires that the context is current. Throws
/// std::runtime_error if the driver rejects a shader.
std::unique_ptr<Screen> make_screen(std::unique_ptr<GlContext> context);

}  // namespace runstone
