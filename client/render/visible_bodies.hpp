// VisibleBodies: the chunks and parts of tiles in view of a frame, from near to far, and the
// variants of the programs that draw them. Thread: that of the TerrainBodies.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "client/render/frame_view.hpp"
#include "client/render/frustum.hpp"
#include "client/render/terrain_bodies.hpp"
#include "client/render/terrain_programs.hpp"
#include "common/core/coords.hpp"

namespace runstone {

struct TerrainStats {
  std::uint32_t chunks_drawn = 0, chunks_culled = 0;
  std::uint64_t quads_drawn = 0;
  std::uint32_t tile_parts_drawn = 0;  // of chunks_drawn
};

struct VisibleBody {
  const TerrainBody* body;
  glm::vec3 origin, pattern;    // origin minus eye; origin in voxels modulo kPatternPeriod
  std::array<double, 3> eye{};  // relative to the origin, in voxels of its level
  float distance2;
  float scale = 1;  // the side of a voxel
  /// Variants of the programs of both passes, opaque first, and the pixels that the variants with
  /// TerrainVariant::kFade draw (RUNSTONE_FADE_GLSL).
  std::array<unsigned, 2> variants{};
  glm::vec2 drawn{0, 1};
  std::uint8_t joined_sides = 0;  // of a part of a tile, see VisibleBodies::joined_sides()
  ChunkKey key{};
};

class VisibleBodies {
 public:
  /// Finds what is in view, and counts it. `field` is the box of the light field, in world voxels.
  /// `is_textured`: the world has textures. `bodies` must stay as they are while all() is used.
  void find(const FrameView& view, const TerrainBodies& bodies, const VoxelBox& field,
            bool is_textured, TerrainStats& stats);

  /// Returns the bodies in view, from near to far.
  const std::vector<VisibleBody>& all() const { return visible_; }
  /// Returns true if a body is drawn by this variant of a pass.
  bool has_variant(bool is_transparent, unsigned variant) const {
    return has_variant_[is_transparent ? 1 : 0][variant];
  }
  bool has_transparent() const { return has_transparent_; }

 private:
  /// Adds a body. `variant` has no TerrainVariant::kFade; `gone` is that of an octant.
  void add(VisibleBody body, unsigned variant, float gone);
  void find_chunks(const FrameView& view, const Frustum& frustum, const VoxelBox& field,
                   TerrainStats& stats);
  void find_tiles(const FrameView& view, const Frustum& frustum, TerrainStats& stats);
  /// Returns a bit for each lateral Direction in which ground of the same level continues the part.
  /// Water has no waterline there. `octants` are those that the part covers.
  std::uint8_t joined_sides(const ChunkKey& key, std::uint8_t octants) const;

  const TerrainBodies* bodies_ = nullptr;  // of the present frame
  bool is_textured_ = false;
  std::vector<VisibleBody> visible_;
  std::array<std::array<bool, TerrainVariant::kCount>, 2> has_variant_{};  // by pass
  bool has_transparent_ = false;
};

}  // namespace runstone
