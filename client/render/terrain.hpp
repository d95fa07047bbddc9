// Terrain: the chunks and tiles on the GPU, and the passes that draw them: shadows, opaque faces,
// transparent faces and ghosts. Tiles cast and receive no shadows, and the light on them is that of
// the open sky. Thread: the GL thread.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "client/far/far_cover.hpp"
#include "client/far/far_fades.hpp"
#include "client/far/tile_mesh.hpp"
#include "client/render/day_light.hpp"
#include "client/render/depth_range.hpp"
#include "client/render/frame_look.hpp"
#include "client/render/frustum.hpp"
#include "client/render/ghost.hpp"
#include "client/render/inspection_painter.hpp"
#include "client/render/lamp_glow.hpp"
#include "client/render/light_field.hpp"
#include "client/render/light_texture.hpp"
#include "client/render/material_textures.hpp"
#include "client/render/noise_texture.hpp"
#include "client/render/quad_buffer.hpp"
#include "client/render/quad_spans.hpp"
#include "client/render/shadow_maps.hpp"
#include "client/render/texture_array.hpp"
#include "client/render/transparent_tree.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// The view of a frame.
struct FrameView {
  glm::dvec3 eye{0};         // world voxels
  glm::mat4 clip{1};         // clip space from eye-relative space
  double far = 1000;         // what is farther is not drawn
  double shadow_far = 1000;  // what is farther is in no shadow
  DepthRange depth;
  double pixel = 0.002;  // the side of a pixel at distance 1
  DayLight light{};
  FrameLook look{};
};

struct TerrainStats {
  std::uint32_t chunks_drawn = 0, chunks_culled = 0;
  std::uint64_t quads_drawn = 0;
  std::uint32_t tile_parts_drawn = 0;  // of chunks_drawn
};

class Terrain {
 public:
  /// Throws std::runtime_error with the driver's log if a shader does not compile.
  Terrain();
  /// Sets the materials of the world. `shapes` are their shapes; null: they are made here.
  void set_materials(const MaterialTable& materials, ShapeTablePtr shapes);
  /// Sets the textures of the world; null: none.
  void set_textures(const DrawnTexturesPtr& textures) { textures_.set(textures); }
  /// Returns TextureArray::left_out().
  std::size_t textures_left_out() const { return textures_.left_out(); }
  void upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
              const RunChunk* voxels);
  /// Requires a key of level 1 or more.
  void upload_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh);
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
  bool has_transparent() const { return has_transparent_; }
  /// Draws the transparent quads from far to near. `scene_depth` is a texture with the depth of the
  /// opaque ones. If the quality is not low, it is read and must not be bound for drawing.
  void draw_transparent(const FrameView& view, GLuint scene_depth);
  void draw_ghosts(const FrameView& view, std::span<const GhostChunk> ghosts);
  /// Draws an inspection over the faces in view. Valid after draw_opaque(). Costs nothing if no
  /// mode is on.
  void draw_inspection(const FrameView& view, const Inspection& inspection);
  std::uint64_t quad_bytes() const { return quads_.used_bytes(); }
  std::uint64_t gpu_bytes() const;

 private:
  struct Chunk {
    std::int32_t edge = 0;  // voxels
    QuadSpan quads;         // of both passes
    QuadSpan transparent;   // of cubes and shapes
    QuadSpans opaque;       // of cubes
    QuadSpan shapes;        // the opaque ones
    /// The order of the transparent quads; nullopt if they are too many for a tree.
    std::optional<TransparentTree> tree;
    QuadSpans layers;             // of the transparent quads of cubes, without a tree
    QuadSpan transparent_shapes;  // without a tree
    /// Appends the spans of the opaque quads whose faces may be seen from `eye`, and all of shapes.
    void append_opaque(const std::array<double, 3>& eye, std::vector<QuadSpan>& out) const {
      opaque.append_facing(eye, out);
      if (shapes.count != 0) out.push_back(shapes);
    }
  };
  struct Tile {
    Chunk whole;
    std::vector<Chunk> octants;  // as in TileMesh
  };
  struct Visible {
    const Chunk* chunk;
    glm::vec3 origin, pattern;    // origin minus eye; origin in voxels modulo kPattern
    std::array<double, 3> eye{};  // relative to the origin, in voxels of its level
    float distance2;
    float scale = 1;  // the side of a voxel
    /// Variants of the programs of both passes, opaque first, and the pixels that the variants with
    /// kFade draw (RUNSTONE_FADE_GLSL).
    std::array<unsigned, 2> variants{};
    glm::vec2 drawn{0, 1};
    std::uint8_t joined_sides = 0;  // of a part of a tile, see joined_sides()
    ChunkKey key{};
  };
  /// The quads of a ghost's mesh, kept as long as frames show it.
  struct GhostQuads {
    std::shared_ptr<const ChunkMesh> mesh;
    QuadSpan quads;
    bool is_used = false;
  };

  /// Copy a mesh to the GPU. The transparent quads of a chunk are ordered by a tree if they are not
  /// too many, and those of a tile by their layers. Require at least one quad, in a tile that of
  /// the whole.
  Chunk add_chunk(std::int32_t edge, const ChunkMesh& mesh);
  Tile add_tile(std::int32_t edge, const TileMesh& mesh);
  void remove_quads(const Tile& tile);
  /// Records in the cover that a chunk or tile is there, and begins a fade if it replaces its
  /// octant.
  void cover(const ChunkKey& key, bool is_open);
  /// Returns true if its parent is drawn in the place of a chunk or tile.
  bool is_octant_drawn(const ChunkKey& key) const;
  /// Returns true if a chunk or tile is drawn, all of it.
  bool is_drawn_whole(const ChunkKey& key) const;
  /// Ends a fade, and removes the quads of what has left.
  void end_fade(const ChunkKey& key);
  /// Ends the fades whose time is over, or whose other body is gone.
  void step_fades(const FrameView& view);
  bool has_octants(const ChunkKey& tile) const;
  /// Returns true if a child of the tile is being replaced by its octant.
  bool has_appearing_octant(const ChunkKey& key, const Tile& tile) const;
  /// Adds a body to those of this frame. `variant` has no kFade; `gone` is that of an octant.
  void add_visible(Visible body, unsigned variant, float gone);
  void find_visible(const FrameView& view, TerrainStats& stats);
  /// Returns a bit for each lateral Direction in which ground of the same level continues the part.
  /// Water has no waterline there. `octants` are those that the part covers.
  std::uint8_t joined_sides(const ChunkKey& key, std::uint8_t octants) const;
  void find_visible_tiles(const FrameView& view, const Frustum& frustum, TerrainStats& stats);
  /// The variants of a program: bits that add what not every chunk needs.
  static constexpr unsigned kInField = 1;    // it reads the light field
  static constexpr unsigned kFine = 2;       // grain and joints are seen
  static constexpr unsigned kInFog = 4;      // a part of the chunk is in the fog
  static constexpr unsigned kTile = 8;       // it is a part of a tile, without shadows
  static constexpr unsigned kFade = 16;      // it appears or dissolves
  static constexpr unsigned kTextured = 32;  // the world has textures
  static constexpr unsigned kHoles = 64;     // shapes, whose faces may have holes
  static constexpr std::size_t kVariants = 128;
  struct Program {
    GlProgram gl;
    // The uniforms of a chunk. `edge` is that of a part of a tile.
    GLint origin = -1, pattern = -1, scale = -1, edge = -1, drawn = -1;
    GLint first_vertex = -1;  // as QuadBuffer::draw() takes it
    int cascade = -1;         // of the last chunk in this pass; -1: none
  };
  /// Sets the uniforms of a pass in its programs. `set` sets those that only this pass has.
  void begin_pass(const FrameView& view, bool is_transparent,
                  const std::function<void(const GlProgram& program)>& set);
  /// Uses the program for a chunk and sets its uniforms. Requires begin_pass() before.
  void use_for(const Visible& chunk, const FrameView& view, bool is_transparent);
  /// Returns the program of a pass of shadows, by the bits kDepth*.
  const GlProgram& depth_program(unsigned variant);
  /// Uses a program and sets the uniforms of a pass. Returns what QuadBuffer::draw() takes.
  GLint begin_depth(const GlProgram& program, const ShadowPass& pass);
  bool draw_depth(ShadowPass& pass, std::size_t quads_max);
  /// Draws the shapes that draw_depth() has put into shapes_in_pass_.
  void draw_depth_of_shapes(const ShadowPass& pass);
  Program& program(Quality quality, bool is_transparent, unsigned variant);
  QuadSpan ghost_quads(const std::shared_ptr<const ChunkMesh>& mesh);

  std::array<std::array<std::array<Program, kVariants>, 2>, 3> programs_;  // by quality and pass
  static constexpr unsigned kDepthHoles = 1, kDepthTextured = 2;
  std::array<GlProgram, 4> depth_programs_;  // by these bits, made when first used
  /// The shapes of a chunk: its origin minus the middle of the pass, and in voxels modulo kPattern.
  struct ShapesInPass {
    QuadSpan shapes;
    glm::vec3 at, pattern;
  };
  std::vector<ShapesInPass> shapes_in_pass_;  // scratch
  GlProgram ghost_program_;
  MaterialTextures materials_;
  TextureArray textures_;
  LightCodes light_codes_;
  LightField field_;
  LampGlows glows_;
  LightTexture field_texture_;
  std::vector<VoxelBox> relit_;  // scratch
  QuadBuffer quads_;
  ShapeTablePtr shapes_;      // of the materials
  std::vector<Quad> staged_;  // on their way to the GPU; kept for its capacity
  ShadowMaps shadows_;
  std::map<ChunkKey, Chunk> chunks_;  // those with quads
  std::map<ChunkKey, Tile> tiles_;    // those with quads
  FarCover cover_;                    // of all chunks and tiles
  FarFades fades_;
  std::map<ChunkKey, Chunk> leaving_;  // quads of removed chunks and tiles whose octant appears
  bool has_fades_ = false;             // the last frame was one with fades
  std::map<const ChunkMesh*, GhostQuads> ghosts_;
  std::optional<InspectionPainter> inspection_;  // while a mode is on
  std::vector<Visible> visible_;                 // of the present frame, from near to far
  std::array<std::array<bool, kVariants>, 2> has_variant_{};  // by pass: one of them is drawn by it
  const Program* in_use_ = nullptr;
  std::vector<QuadSpan> spans_;  // scratch
  bool has_transparent_ = false;
  std::int32_t edge_ = 16;  // of the largest chunk so far, voxels
};

}  // namespace runstone
