// Renderer: draws chunk meshes with sun, sky and haze, and transparent materials in a blended pass.
// A quad takes 8 bytes; the vertex shader reads and unpacks it (quad_glsl.hpp). Requires OpenGL 3.3
// core, OpenGL ES 3.0, or newer. The position of the eye is subtracted from chunk positions in
// double precision before they become floats, so that places far from the origin do not jitter.
// Thread: all calls on the one thread whose context is current.
#pragma once
#include <cstdint>
#include <memory>

#include "client/far/tile_mesh.hpp"
#include "client/render/drawn_textures.hpp"
#include "client/render/frame_contents.hpp"
#include "client/render/gl_functions.hpp"
#include "client/render/image.hpp"
#include "client/render/overlay_frame.hpp"
#include "common/core/coords.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// The axes are right-handed with y up. Angles are in radians. Yaw 0 looks along +z and grows
/// towards +x. Pitch is positive upward.
struct Camera {
  double x = 0, y = 0, z = 0;  // eye, voxels
  double yaw = 0, pitch = 0;
  double fov_y = 1.2;  // vertical field of view
  double near = 0.1, far = 1000;
  /// How far the chunks reach, if tiles reach farther: ground beyond it is in no shadow, and fog
  /// begins nearer. 0: there are no tiles.
  double shadow_far = 0;
};

struct RenderStats {
  std::uint32_t chunks_drawn = 0, chunks_culled = 0;  // bodies of tiles included
  std::uint64_t quads_drawn = 0;
  std::uint64_t quad_bytes = 0;  // on the GPU, of all chunks
  std::uint64_t gpu_bytes = 0;   // those, the light field, the shadow maps and the textures
  /// True if the frame shows transparent faces or ghosts, which move with FrameLook::seconds.
  /// Clouds move with it, too, but so slowly that a still frame may show them.
  bool is_animated = false;
  bool lacks_msaa = false;              // FXAA replaced the MSAA that was wanted
  std::uint32_t tile_parts_drawn = 0;   // tiles that are drawn whole, and octants of the others
  std::uint64_t texture_bytes = 0;      // of gpu_bytes
  std::uint32_t textures_left_out = 0;  // see TextureArray::left_out()
};

class Renderer {
 public:
  /// Compiles the shaders. Throws std::runtime_error with the driver's log on failure.
  explicit Renderer(GlContextLoader loader);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Sets the materials of the world. `shapes` are their shapes; null: they are made here.
  void set_materials(const MaterialTable& materials, ShapeTablePtr shapes = nullptr);
  /// Sets the textures of the world; null: none.
  void set_textures(const DrawnTexturesPtr& textures);
  /// Replaces the chunk's quads on the GPU. `edge` is in voxels. `voxels` are the runs that were
  /// meshed, from which light and dark corners are computed. If `voxels` is null, the chunk counts
  /// as empty there.
  void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
              const RunChunk* voxels = nullptr);
  /// Replaces the quads of a tile on the GPU. `edge` is in voxels of the tile. Tiles and chunks
  /// replace each other as FarCover says. Requires a key of level 1 or more.
  void upload_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh);
  /// Removes a chunk or tile.
  void remove(const ChunkKey& key);

  /// Draws into the renderer's off-screen target of width x height pixels.
  RenderStats draw(const Camera& camera, int width, int height, const FrameContents& contents = {});
  /// Draws the user interface over the last frame. Requires a draw() before.
  void draw_overlay(const OverlayFrame& overlay);
  /// Waits for a fence after the commands that draw() queued. Off screen this is the moment at
  /// which a frame is presented. Throws std::runtime_error if the fence does not come within 30 s
  /// or the GPU has no memory left.
  void finish();
  /// Returns the last frame, with what was drawn over it. Requires a draw() before.
  Image read_image();
  /// Copies the last frame to the window's default framebuffer.
  void present(int window_width, int window_height) { present(0, 0, window_width, window_height); }
  /// Copies the last frame to a rectangle, in pixels from the lower left corner of the window.
  void present(int left, int bottom, int width, int height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
