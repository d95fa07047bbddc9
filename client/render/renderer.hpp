// Renderer: draws chunk meshes with sun, sky and fog, and transparent materials in a blended pass.
// Quads are packed into 8 bytes, drawn as instances and unpacked in the vertex shader. Requires
// OpenGL 3.3 core or newer. The position of the eye is subtracted from chunk positions in double
// precision before they become floats, so that places far from the origin do not jitter. Thread:
// all calls on the one thread whose context is current.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "client/render/image.hpp"
#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

/// The axes are right-handed with y up. Angles are in radians. Yaw 0 looks along +z and grows
/// towards +x. Pitch is positive upward.
struct Camera {
  double x = 0, y = 0, z = 0;  // eye, voxels
  double yaw = 0, pitch = 0;
  double fov_y = 1.2;  // vertical field of view
  double near = 0.1, far = 1000;
};

struct RenderStats {
  std::uint32_t chunks_drawn = 0, chunks_culled = 0;
  std::uint64_t quads_drawn = 0;
  std::uint64_t gpu_bytes = 0;
};

/// A box in world voxels: the outline of the picked voxel, or the body of another player.
struct Marker {
  double x = 0, y = 0, z = 0;  // smallest corner
  double size_x = 1, size_y = 1, size_z = 1;
  std::uint8_t r = 255, g = 255, b = 255;
  bool filled = false;  // false: edges only
};

/// A function that returns a GL function by name. eglGetProcAddress, OSMesaGetProcAddress and
/// glfwGetProcAddress have this type.
using GlContextLoader = void (*(*)(const char*))();

class Renderer {
 public:
  /// Compiles the shaders. Throws std::runtime_error with the driver's log on failure.
  explicit Renderer(GlContextLoader loader);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void set_materials(const MaterialTable& materials);
  /// Replaces the chunk's quads on the GPU. An empty mesh removes the chunk. `edge` is in voxels.
  void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh);
  void remove(const ChunkKey& key);

  /// Draws into the renderer's off-screen target of width x height pixels.
  RenderStats draw(const Camera& camera, int width, int height,
                   std::span<const Marker> markers = {});
  /// Waits for a fence after the commands that draw() queued. Off screen this is the moment at
  /// which a frame is presented. Throws std::runtime_error if the fence does not come within 30 s
  /// or the GPU has no memory left.
  void finish();
  /// Returns the last frame. Requires a draw() before.
  Image read_image();
  /// Copies the last frame to the window's default framebuffer.
  void present(int window_width, int window_height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
