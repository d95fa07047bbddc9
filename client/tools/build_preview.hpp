// BuildPreview: large builds as ghosts. A build is drawn as it is, without a comparison with
// the world, by cells of the level of detail at which it has at most kQuadsMax quads: a cell of level
// L is 2^L voxels wide, made by the rule of tiles (common/tiles). The meshes belong to the build and
// not to its place, so moving a paste makes nothing again. Work is divided over turns: step() does a
// bounded part. No dense grid is made. One thread. No clock.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "client/render/ghost.hpp"
#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesher.hpp"
#include "common/mesh/mesh_materials.hpp"
#include "common/tiles/tile_builder.hpp"

namespace runstone {

/// A build to show. If it is removed, its ghost is that of voxels that an edit would clear.
struct ShownBuild {
  BuildPtr build;
  VoxelPos at;
  bool is_removed = false;
  /// The touched cells are exactly the voxels that change.
  bool is_difference = false;
  friend bool operator==(const ShownBuild&, const ShownBuild&) = default;
};

class BuildPreview {
 public:
  /// The largest number of quads of one build.
  static constexpr std::size_t kQuadsMax = 150'000;
  /// Tiles along each axis of the first level that is meshed, at most.
  static constexpr std::int32_t kTilesMax = 4;
  static constexpr std::int32_t kTileEdge = 64;
  /// The builds that are shown at a time: a paste and its mirrored copies.
  static constexpr std::size_t kBuildsMax = 4;

  /// Shows these builds from the next step() on, at most the first kBuildsMax. Empty: shows nothing at
  /// once. A build that is shown already keeps its meshes.
  void set(std::vector<ShownBuild> builds);
  /// Sets the materials of the world. Makes all ghosts again.
  void set_materials(MeshMaterialsPtr materials);

  /// Makes a part of the ghosts: reads and meshes at most `tiles_max` cubes of 64 cells. Returns true
  /// if ghosts() changed. Cost: O(runs and lines of these cubes + quads).
  bool step(std::size_t tiles_max);
  /// Returns true if ghosts() shows all builds.
  bool is_complete() const;

  const std::vector<GhostChunk>& ghosts() const { return ghosts_; }
  const std::vector<ShownBuild>& builds() const { return shown_; }
  /// Returns the number of voxels that the builds set, and that they clear. They are upper bounds
  /// unless is_exact(), because masks and present voxels are ignored.
  std::uint64_t placed_voxels() const;
  std::uint64_t removed_voxels() const;
  /// Returns true if all builds are differences.
  bool is_exact() const;
  /// Returns the width of the coarsest cells that are shown, in voxels, or 0 before there are any.
  std::int32_t cell_voxels() const;

 private:
  struct TilePos {
    std::int32_t x = 0, y = 0, z = 0;
    friend auto operator<=>(const TilePos&, const TilePos&) = default;
  };
  struct MeshedTile {
    TilePos at;
    std::shared_ptr<const ChunkMesh> mesh;
  };
  /// One build on its way to meshes.
  struct Model {
    enum class Stage : std::uint8_t { read, mesh, complete };
    BuildPtr build;
    unsigned level = 0;
    TilePos counts;  // tiles of the level along each axis
    Stage stage = Stage::read;
    std::uint64_t next = 0;  // tile of the stage; of `read`: cube in the tile, too
    std::uint64_t cube = 0;
    std::vector<std::vector<RunChunk>> halves;  // by level: the children of the tile that is made
    std::map<TilePos, RunChunk> tiles;          // those with a voxel that is not empty
    std::size_t quads = 0;
    std::vector<MeshedTile> meshed;
  };

  void begin(Model& model) const;
  /// Reads one cube of the build, or passes cubes outside of it. Returns false if that was cheap.
  bool read_cube(Model& model);
  void mesh_tile(Model& model);
  void coarsen(Model& model);
  void collect();

  std::vector<ShownBuild> shown_;
  std::vector<Model> models_;  // of the builds of shown_, each once
  std::vector<GhostChunk> ghosts_;
  bool is_changed_ = false;  // ghosts_ does not fit shown_ and models_
  MeshMaterialsPtr materials_ = std::make_shared<const MeshMaterials>();
  TileScratch tiler_;
  ChunkMeshScratch mesher_;
};

}  // namespace runstone
