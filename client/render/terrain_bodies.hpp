// TerrainBodies: the chunks and tiles on the GPU, which of them are shown in the place of others,
// and the fades between them. Thread: the GL thread.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "client/far/far_cover.hpp"
#include "client/far/far_fades.hpp"
#include "client/far/tile_mesh.hpp"
#include "client/render/frame_view.hpp"
#include "client/render/quad_buffer.hpp"
#include "client/render/terrain_body.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

class TerrainBodies {
 public:
  /// Sets the shapes of the materials. Requires a table.
  void set_shapes(ShapeTablePtr shapes);
  /// Sets the materials whose faces mirror nothing, by id. If a material was in the old list and is
  /// not in the new one, all earlier bodies count as bodies that mirror.
  void set_matt(const std::vector<bool>& materials);
  void put_chunk(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh);
  /// Requires a key of level 1 or more.
  void put_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh);
  /// Removes a chunk or tile. Returns the edge of a chunk that had quads, otherwise nullopt.
  std::optional<std::int32_t> remove(const ChunkKey& key);
  /// Ends the fades whose time is over, or whose other body is gone.
  void step_fades(const FrameView& view);

  /// Return the chunks and tiles with quads.
  const std::map<ChunkKey, TerrainBody>& chunks() const { return chunks_; }
  const std::map<ChunkKey, TerrainTile>& tiles() const { return tiles_; }
  /// Returns the quads of removed chunks and tiles whose octant appears.
  const std::map<ChunkKey, TerrainBody>& leaving() const { return leaving_; }
  const FarCover& cover() const { return cover_; }
  const FarFades& fades() const { return fades_; }
  /// Returns true if a child of the tile is being replaced by its octant.
  bool has_appearing_octant(const ChunkKey& key, const TerrainTile& tile) const;
  QuadBuffer& quads() { return quads_; }
  const QuadBuffer& quads() const { return quads_; }

 private:
  /// Copy a mesh to the GPU. The transparent quads of a chunk are ordered by a tree if they are not
  /// too many, and those of a tile by their layers. Require at least one quad, in a tile that of
  /// the whole.
  TerrainBody add_chunk(std::int32_t edge, const ChunkMesh& mesh);
  TerrainTile add_tile(std::int32_t edge, const TileMesh& mesh);
  void remove_quads(const TerrainTile& tile);
  /// Records in the cover that a chunk or tile is there, and begins a fade if it replaces its
  /// octant.
  void cover_with(const ChunkKey& key, bool is_open);
  /// Returns true if its parent is drawn in the place of a chunk or tile.
  bool is_octant_drawn(const ChunkKey& key) const;
  /// Returns true if a chunk or tile is drawn, all of it.
  bool is_drawn_whole(const ChunkKey& key) const;
  /// Ends a fade, and removes the quads of what has left.
  void end_fade(const ChunkKey& key);
  bool has_octants(const ChunkKey& tile) const;
  /// Returns true if a quad has a material that mirrors. Cost: O(quads).
  bool is_glossy(std::span<const Quad> quads) const;

  QuadBuffer quads_;
  ShapeTablePtr shapes_;      // of the materials
  std::vector<bool> matt_;    // by material; those beyond are not
  std::vector<Quad> staged_;  // on their way to the GPU; kept for its capacity
  std::map<ChunkKey, TerrainBody> chunks_;
  std::map<ChunkKey, TerrainTile> tiles_;
  FarCover cover_;  // of all chunks and tiles
  FarFades fades_;
  std::map<ChunkKey, TerrainBody> leaving_;
  bool has_fades_ = false;  // the last frame was one with fades
};

}  // namespace runstone
