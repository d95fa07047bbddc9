// Screen: where frames go: a window, or an off-screen target. Made, used and destroyed by one thread, which
// is DrawThread's; a window is made, polled and destroyed by the main thread around that.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "client/platform/window.hpp"
#include "client/render/image.hpp"
#include "client/render/renderer.hpp"
#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

class Screen {
 public:
  Screen() = default;
  virtual ~Screen() = default;
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Of the OpenGL context; the text lives for ever.
  virtual const char* name() const = 0;
  virtual void set_materials(const MaterialTable& materials) = 0;
  /// As Renderer::upload() and remove().
  virtual void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh) = 0;
  virtual void remove(const ChunkKey& key) = 0;
  /// Draws and waits until the picture is done: off screen the fence after the frame, else the swap. Pixels.
  /// Throws std::runtime_error if the driver gave up.
  virtual RenderStats draw(const Camera& camera, int width, int height,
                           std::span<const Marker> markers) = 0;
  /// What the last draw() made. Requires a draw() before.
  virtual Image read_image() = 0;
};

/// Throw std::runtime_error if there is no OpenGL of that kind.
std::unique_ptr<Screen> make_headless_screen();
/// `window` must outlive the screen.
std::unique_ptr<Screen> make_window_screen(Window& window);

}  // namespace runstone
