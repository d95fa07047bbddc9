// Terrain: the chunks on the GPU, and the passes that draw them: shadows, opaque faces, transparent
// faces and ghosts. Thread: the GL thread.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "client/render/day_light.hpp"
#include "client/render/frame_look.hpp"
#include "client/render/ghost.hpp"
#include "client/render/material_textures.hpp"
#include "client/render/opacity_map.hpp"
#include "client/render/quad_buffer.hpp"
#include "client/render/quad_spans.hpp"
#include "client/render/shadow_maps.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The view of a frame.
struct FrameView {
  glm::dvec3 eye{0};  // world voxels
  glm::mat4 clip{1};  // clip space from eye-relative space
  double near = 0.1, far = 1000;
  DayLight light;
  FrameLook look;
};

struct TerrainStats {
  std::uint32_t chunks_drawn = 0, chunks_culled = 0;
  std::uint64_t quads_drawn = 0;
};

class Terrain {
 public:
  /// Throws std::runtime_error with the driver's log if a shader does not compile.
  Terrain();
  void set_materials(const MaterialTable& materials);
  void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
              const RunChunk* voxels);
  void remove(const ChunkKey& key);

  /// Draws the shadow maps that need it. Leaves another framebuffer bound.
  void draw_shadows(const FrameView& view);
  TerrainStats draw_opaque(const FrameView& view);
  /// Returns true if transparent quads are in view. Valid after draw_opaque().
  bool has_transparent() const { return has_transparent_; }
  /// Draws the transparent quads from far to near. `scene_depth` is a texture with the depth of the
  /// opaque ones. If the quality is not low, it is read and must not be bound for drawing.
  void draw_transparent(const FrameView& view, GLuint scene_depth);
  void draw_ghosts(const FrameView& view, std::span<const GhostChunk> ghosts);
  std::uint64_t quad_bytes() const { return quads_.used_bytes(); }
  std::uint64_t gpu_bytes() const;

 private:
  struct Chunk {
    std::int32_t edge = 0;  // voxels
    QuadSpan quads;         // of both passes
    QuadSpans opaque, transparent;
  };
  struct Visible {
    const Chunk* chunk;
    glm::vec3 origin, pattern;    // origin minus eye; origin modulo kPattern
    std::array<double, 3> eye{};  // relative to the origin
    float distance2;
  };
  /// The quads of a ghost's mesh, kept as long as frames show it.
  struct GhostQuads {
    std::shared_ptr<const ChunkMesh> mesh;
    QuadSpan quads;
    bool is_used = false;
  };

  Chunk add_quads(std::int32_t edge, const ChunkMesh& mesh);
  void find_visible(const FrameView& view, TerrainStats& stats);
  void use(const GlProgram& program, const FrameView& view);
  /// Sets the shadow map of a chunk, unless it is `cascade`, which is replaced.
  void place_in_shadow(const GlProgram& program, const FrameView& view, const Visible& chunk,
                       int& cascade) const;
  static void place(const GlProgram& program, const Visible& chunk);
  void draw_depth(const glm::mat4& clip, const glm::dvec3& middle);
  const GlProgram& program(Quality quality, bool transparent);
  QuadSpan ghost_quads(const std::shared_ptr<const ChunkMesh>& mesh);

  std::array<std::array<GlProgram, 2>, 3> programs_;  // by quality, then opaque and transparent
  GlProgram depth_program_, ghost_program_;
  MaterialTextures materials_;
  OpaqueMaterials opaque_;
  QuadBuffer quads_;
  OpacityMap opacity_;
  ShadowMaps shadows_;
  std::map<ChunkKey, Chunk> chunks_;  // those with quads
  std::map<const ChunkMesh*, GhostQuads> ghosts_;
  std::vector<Visible> visible_;  // of the present frame, from near to far
  std::vector<QuadSpan> spans_;   // scratch
  bool has_transparent_ = false;
  std::int32_t edge_ = 16;  // of the largest chunk so far, voxels
};

}  // namespace runstone
