// FarWorld: a generated landscape with its tiles, made as a server makes them. FarScene: a view of
// it on a renderer, through FarTiles and FarPlanner, as MeshPipeline does it.
#pragma once
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "client/far/far_planner.hpp"
#include "client/far/far_tiles.hpp"
#include "client/far/tile_mesh.hpp"
#include "client/render/renderer.hpp"
#include "common/core/tile_keys.hpp"
#include "common/generate/generator.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"
#include "common/tiles/veil.hpp"
#include "protocol/codec/view_tiles.hpp"

namespace runstone::test {

/// Says if the server sends its tiles with a veil.
enum class TileVeil { veiled, none };

class FarWorld {
 public:
  /// `parameters` are the parameters of the generator.
  FarWorld(std::int32_t edge, const MaterialTable& materials, const std::string& parameters,
           TileVeil veil = TileVeil::veiled, const std::string& generator = "terrain")
      : edge_(edge),
        veil_(veil),
        materials_(materials),
        visibility_(visibilities(materials)),
        generator_(*make_generator({generator, 1, 7, parameters}, materials)) {}

  std::int32_t edge() const { return edge_; }
  const MaterialTable& materials() const { return materials_; }
  const VisibilityTable& visibility() const { return visibility_; }
  const Generator& generator() const { return *generator_; }

  TilePtr chunk(ChunkCoord at) const {
    return std::make_shared<const RunChunk>(
        generator_->generate(origin_of(at, edge_), Extent::cube(static_cast<unsigned>(edge_))));
  }
  /// Returns the tile before its veil. Null is empty.
  TilePtr built(const ChunkKey& key) {
    const std::int32_t high = (key.at.y + 1) * edge_ << key.lod, low = key.at.y * edge_ << key.lod;
    if (high <= generator_->y_min() || low >= generator_->y_max()) return nullptr;
    if (key.lod == 0) return chunk(key.at);
    auto [found, is_new] = tiles_.try_emplace(key);
    if (!is_new) return found->second;
    std::array<TilePtr, 8> children;
    TileChildren pointers{};
    bool has_ground = false;
    for (unsigned i = 0; i < kTileChildren; ++i) {
      children[i] = built(tile_child(key, i));
      pointers[i] = children[i].get();
      has_ground = has_ground || (children[i] && !is_empty(*children[i]));
    }
    TilePtr out;
    if (has_ground) {
      out = std::make_shared<const RunChunk>(build_tile(pointers, static_cast<unsigned>(edge_),
                                                        kTileOrder, visibility_, tile_scratch_));
    }
    tiles_[key] = out;
    return out;
  }
  /// Returns the tile as a server sends it.
  RunChunk sent(const ChunkKey& key) {
    const TilePtr tile = built(key);
    if (!tile) return uniform_chunk(Extent::cube(static_cast<unsigned>(edge_)), kEmpty);
    if (veil_ == TileVeil::none) return *tile;
    return veiled(*tile, visibility_, veil_scratch_).value_or(*tile);
  }

 private:
  const std::int32_t edge_;
  const TileVeil veil_;
  const MaterialTable materials_;
  const VisibilityTable visibility_;
  const std::unique_ptr<Generator> generator_;
  std::map<ChunkKey, TilePtr> tiles_;
  TileScratch tile_scratch_;
  VeilScratch veil_scratch_;
};

class FarScene {
 public:
  FarScene(FarWorld& world, Renderer& renderer) : world_(world), renderer_(renderer) {
    renderer_.set_materials(world.materials());
    planner_.set_visibility(world.visibility());
  }

  /// Shows a view. Chunks and tiles that were shown before stay if the view has them.
  void show(const View& view) {
    view_ = view;
    const std::int32_t edge = world_.edge();
    const CoordLimit limit = CoordLimit::of(edge);
    tiles_.set_view(view, edge);
    for (std::uint8_t level = tile_levels(view); level > 0; --level) {
      for_each_key(level, kTileRadiusV, [&](const ChunkKey& key) {
        if (!has_key(view, limit, key) || tiles_.find(key)) return;
        const bool has_empty_parent =
            level < tile_levels(view) &&
            (!tiles_.find(tile_parent(key)) || is_empty(*tiles_.find(tile_parent(key))));
        if (!has_empty_parent) REQUIRE(tiles_.receive(key, Chunk{world_.sent(key), {}, {}}));
      });
    }
    std::map<ChunkCoord, TilePtr> chunks;
    for_each_key(0, view.radius_v, [&](const ChunkKey& key) {
      if (!has_key(view, limit, key)) return;
      const auto found = chunks_.find(key.at);
      chunks.emplace(key.at, found != chunks_.end() ? found->second : world_.chunk(key.at));
    });
    for (const auto& [at, chunk] : chunks_) {
      if (!chunks.contains(at)) remove(at);
    }
    for (const auto& [at, chunk] : chunks) planner_.set_chunk(at, true);
    chunks_ = std::move(chunks);
    for (const auto& [at, chunk] : chunks_) upload(at);
    mesh_tiles();
  }
  /// Takes one chunk off the screen, as if it had not arrived.
  void take_away(ChunkCoord at) {
    if (chunks_.erase(at) == 0) return;
    remove(at);
    for (int d = 0; d < kDirectionCount; ++d) {
      const ChunkCoord beside = neighbour(at, static_cast<Direction>(d));
      if (chunks_.contains(beside)) upload(beside);
    }
    mesh_tiles();
  }
  /// Meshes and uploads the tiles that changed.
  void mesh_tiles() {
    planner_.take(tiles_.drain_changes());
    for (const ChunkKey& key : planner_.take_removals()) renderer_.remove(key);
    while (const auto job = planner_.next()) {
      REQUIRE(planner_.finish(job->key, job->number));
      const FarMeshResult made = mesh_tile(*job, world_.visibility(), scratch_);
      quads_ += made.mesh->quad_count();
      renderer_.upload_tile(job->key, made.edge, *made.mesh);
    }
  }
  std::size_t tile_count() const { return tiles_.solid_count(); }
  std::size_t tile_bytes() const { return tiles_.bytes(); }
  std::size_t tile_quads() const { return quads_; }

 private:
  template <class Act>
  void for_each_key(std::uint8_t level, std::int32_t radius_v, Act act) const {
    const ChunkCoord centre = tile_at(view_.centre, level);
    const std::int32_t r = view_.radius_h;
    for (std::int32_t x = -r; x <= r; ++x) {
      for (std::int32_t y = -radius_v; y <= radius_v; ++y) {
        for (std::int32_t z = -r; z <= r; ++z)
          act(ChunkKey{level, {centre.x + x, centre.y + y, centre.z + z}});
      }
    }
  }
  void upload(ChunkCoord at) {
    MeshNeighbours beside{};
    std::uint8_t open_sides = 0;
    for (int d = 0; d < kDirectionCount; ++d) {
      const auto found = chunks_.find(neighbour(at, static_cast<Direction>(d)));
      if (found != chunks_.end()) {
        beside[static_cast<std::size_t>(d)] = found->second.get();
      } else {
        open_sides = static_cast<std::uint8_t>(open_sides | 1U << d);
      }
    }
    mesh_rdm(*chunks_.at(at), beside, world_.visibility(), scratch_, mesh_);
    drop_water_walls(mesh_, world_.edge(), open_sides);
    renderer_.upload({0, at}, world_.edge(), mesh_, chunks_.at(at).get());
  }
  void remove(ChunkCoord at) {
    renderer_.remove({0, at});
    planner_.set_chunk(at, false);
  }

  FarWorld& world_;
  Renderer& renderer_;
  View view_;
  FarTiles tiles_;
  FarPlanner planner_{tiles_};
  std::map<ChunkCoord, TilePtr> chunks_;
  RdmScratch scratch_;
  ChunkMesh mesh_;
  std::size_t quads_ = 0;
};

}  // namespace runstone::test
