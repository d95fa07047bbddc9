#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/mesh/visibility.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"
#include "common/tiles/veil.hpp"
#include "tests/conformance/vectors/vector_values.hpp"

namespace runstone::conformance {
namespace {

constexpr unsigned kEdge = 16;

struct NamedChildren {
  std::string name;
  std::array<RunChunk, 8> chunks;
  std::array<bool, 8> are_there{true, true, true, true, true, true, true, true};
};

ChunkCoord child_at(std::size_t i) {
  return {static_cast<std::int32_t>(i & 1), static_cast<std::int32_t>(i >> 1 & 1),
          static_cast<std::int32_t>(i >> 2)};
}

NamedChildren ground_children(const std::string& name, ChunkCoord first, AxisOrder order) {
  NamedChildren out;
  out.name = name;
  for (std::size_t i = 0; i < 8; ++i) {
    const ChunkCoord at = child_at(i);
    out.chunks[i] = ground_chunk({first.x + at.x, first.y + at.y, first.z + at.z}, kEdge, order);
  }
  return out;
}

Json entry_of(const NamedChildren& named, const VisibilityTable& visibility) {
  Json children = Json::array();
  TileChildren pointers{};
  for (std::size_t i = 0; i < 8; ++i) {
    if (named.are_there[i]) pointers[i] = &named.chunks[i];
    children.push_back(named.are_there[i] ? Json(raw_hex(named.chunks[i])) : Json());
  }
  TileScratch scratch;
  VeilScratch veil_scratch;
  const RunChunk tile = build_tile(pointers, kEdge, kTileOrder, visibility, scratch);
  const auto veil = veiled(tile, visibility, veil_scratch);
  return {{"name", named.name},
          {"children", std::move(children)},
          {"tile", raw_hex(tile)},
          {"digest", json_of(digest_of(tile))},
          {"veiled", raw_hex(veil ? *veil : tile)}};
}

}  // namespace

Json tile_vectors() {
  // Material 3 is transparent, as water is; material 4 is empty for tiles, as a plant is.
  const std::array<Visibility, 5> materials = {Visibility::empty, Visibility::opaque,
                                               Visibility::opaque, Visibility::transparent,
                                               Visibility::empty};
  const VisibilityTable visibility(materials);
  std::vector<NamedChildren> all;
  all.push_back(ground_children("ground", {0, 0, 0}, AxisOrder::yxz));
  all.push_back(ground_children("ground at negative keys", {-2, -1, -4}, AxisOrder::zyx));
  NamedChildren some = ground_children("four children are empty", {0, 0, 0}, AxisOrder::xyz);
  for (const std::size_t i : {2U, 3U, 6U, 7U}) some.are_there[i] = false;
  all.push_back(some);
  NamedChildren solid;
  solid.name = "eight materials";
  for (std::size_t i = 0; i < 8; ++i)
    solid.chunks[i] = uniform_chunk(Extent::cube(kEdge), static_cast<Material>(10 + i));
  all.push_back(solid);
  Json tiles = Json::array();
  for (const NamedChildren& named : all) tiles.push_back(entry_of(named, visibility));
  Json words = Json::array();
  for (const Visibility each : materials) words.push_back(static_cast<int>(each));
  return {{"format", "runstone tile vectors 1"},
          {"tile_rules", kTileRules},
          {"order", name_of(kTileOrder)},
          {"visibility", std::move(words)},
          {"tiles", std::move(tiles)}};
}

}  // namespace runstone::conformance
