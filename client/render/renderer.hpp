// Renderer: draws chunk meshes by instancing packed quads (8 bytes each, unpacked in the vertex shader), with
// sun, sky, fog and a blended pass for transparent materials. OpenGL 4.5 core where there, 3.3 core as the
// floor. All calls from the one thread whose context is current. Chunk positions are subtracted from the eye
// in integers and doubles before they become floats, so far-away worlds do not jitter.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "client/render/image.hpp"
#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

/// Right-handed, y up. yaw 0 looks along +z and grows towards +x; pitch is positive upward. Angles in
/// radians.
struct Camera {
  double x = 0, y = 0, z = 0;  // eye, voxels
  double yaw = 0, pitch = 0;
  double fov_y = 1.2;  // radians
  double near = 0.1, far = 1000;
};

struct RenderStats {
  std::uint32_t chunks_drawn = 0, chunks_culled = 0;
  std::uint64_t quads_drawn = 0;
  std::uint64_t gpu_bytes = 0;
};

/// A box to outline (picked voxel) or a coloured marker (another player), in world voxels.
struct Marker {
  double x = 0, y = 0, z = 0;  // smallest corner
  double size_x = 1, size_y = 1, size_z = 1;
  std::uint8_t r = 255, g = 255, b = 255;
  bool filled = false;  // filled box, or edges only
};

/// Finds a GL function by name; what eglGetProcAddress, OSMesaGetProcAddress and glfwGetProcAddress are.
using GlContextLoader = void (*(*)(const char*))();

class Renderer {
 public:
  /// Compiles shaders; throws std::runtime_error with the driver's log on failure.
  explicit Renderer(GlContextLoader loader);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void set_materials(const MaterialTable& materials);
  /// Replaces the chunk's quads on the GPU; an empty mesh removes it. `edge` in voxels.
  void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh);
  void remove(const ChunkKey& key);

  /// Draws into an own off-screen target of width x height.
  RenderStats draw(const Camera& camera, int width, int height,
                   std::span<const Marker> markers = {});
  /// Blocks until the GPU has finished what draw() queued (a fence): the "presented" moment of a headless
  /// client. Throws std::runtime_error if it never does, or has no memory left.
  void finish();
  /// What the last draw() made. Requires a draw() before.
  Image read_image();
  /// Copies the last draw() to the window's default framebuffer.
  void present(int window_width, int window_height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
