// Terrain: the chunks and tiles on the GPU, and the passes that draw them: shadows, opaque faces,
// transparent faces and ghosts. Tiles cast and receive no shadows, and the light on them is that of
// the open sky. Thread: the GL thread.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "client/far/tile_mesh.hpp"
#include "client/render/frame_view.hpp"
#include "client/render/ghost.hpp"
#include "client/render/ghost_painter.hpp"
#include "client/render/inspection_painter.hpp"
#include "client/render/lamp_glow.hpp"
#include "client/render/light_field.hpp"
#include "client/render/light_texture.hpp"
#include "client/render/material_textures.hpp"
#include "client/render/noise_texture.hpp"
#include "client/render/shadow_casters.hpp"
#include "client/render/shadow_maps.hpp"
#include "client/render/terrain_bodies.hpp"
#include "client/render/terrain_programs.hpp"
#include "client/render/texture_array.hpp"
#include "client/render/visible_bodies.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

class Terrain {
 public:
  /// Throws std::runtime_error with the driver's log if a shader does not compile.
  Terrain();
  /// Sets the materials of the world. `shapes` are their shapes; null: they are made here.
  void set_materials(const MaterialTable& materials, ShapeTablePtr shapes);
  /// Sets the textures of the world; null: none.
  void set_textures(const DrawnTexturesPtr& textures);
  std::uint64_t texture_bytes() const { return textures_.byte_size(); }
  /// Returns TextureArray::left_out().
  std::size_t textures_left_out() const { return textures_.left_out(); }
  void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
              const RunChunk* voxels);
  /// Requires a key of level 1 or more.
  void upload_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh) {
    bodies_.put_tile(key, edge, mesh);
  }
  /// Removes a chunk or tile.
  void remove(const ChunkKey& key);

  /// Draws the shadow maps and computes the light that need it. Leaves another framebuffer bound.
  void update_light(const FrameView& view);
  /// Returns the light at a place in world voxels: red, green and blue of lamps (linear), and the
  /// share of the sky, 0 .. 1. Outside the light field, and at low quality, it is that of the open.
  glm::vec4 light_at(const FrameView& view, const glm::dvec3& at) const;
  /// Returns the glows of the lamps in the chunks.
  const LampGlows& glows() const { return glows_; }
  /// Draws the opaque faces. `noise` tints natural ground by its place.
  TerrainStats draw_opaque(const FrameView& view, const NoiseTexture& noise);
  /// Returns true if transparent quads are in view. Valid after draw_opaque().
  bool has_transparent() const { return visible_.has_transparent(); }
  /// Draws the transparent quads from far to near. `scene_depth` is a texture with the depth of the
  /// opaque ones. If the quality is not low, it is read and must not be bound for drawing.
  void draw_transparent(const FrameView& view, GLuint scene_depth);
  void draw_ghosts(const FrameView& view, std::span<const GhostChunk> ghosts) {
    ghosts_.draw(view, ghosts, materials_, bodies_.quads());
  }
  /// Draws an inspection over the faces in view. Valid after draw_opaque(). Costs nothing if no
  /// mode is on.
  void draw_inspection(const FrameView& view, const Inspection& inspection);
  std::uint64_t quad_bytes() const { return bodies_.quads().used_bytes(); }
  std::uint64_t gpu_bytes() const;

 private:
  /// Records that the silhouettes of plants or the holes of pictures may have changed. Cost:
  /// O(chunks).
  void surfaces_changed();
  /// Records that a chunk casts other shadows than before.
  void shadows_changed(const ChunkKey& key, std::int32_t edge);
  /// Sets the uniforms of a pass in its programs. `set` sets those that only this pass has.
  void begin_pass(const FrameView& view, bool is_transparent,
                  const std::function<void(const GlProgram& program)>& set);
  /// Uses the program for a body and sets its uniforms. Requires begin_pass() before.
  void use_for(const VisibleBody& body, const FrameView& view, bool is_transparent);

  TerrainPrograms programs_;
  MaterialTextures materials_;
  TextureArray textures_;
  LightCodes light_codes_;
  LightField field_;
  LampGlows glows_;
  LightTexture field_texture_;
  std::vector<VoxelBox> relit_;  // scratch
  TerrainBodies bodies_;
  ShadowMaps shadows_;
  ShadowCasters casters_;
  GhostPainter ghosts_;
  std::optional<InspectionPainter> inspection_;  // while a mode is on
  VisibleBodies visible_;                        // in the present frame
  const TerrainProgram* in_use_ = nullptr;
  std::vector<QuadSpan> spans_;  // scratch
  std::int32_t edge_ = 16;       // of the largest chunk so far, voxels
};

}  // namespace runstone
