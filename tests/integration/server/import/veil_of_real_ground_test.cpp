// The veil of a world of another program, against the oracle.
#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <utility>

#include "common/materials/veil_visibility.hpp"
#include "common/veil/veil.hpp"
#include "server/import/import_luanti.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/veil/veil_oracle.hpp"

namespace runstone::test {

TEST_CASE("real ground has the veil of the oracle at all edges", "[veil]") {
  VeilScratch scratch;
  for (const std::int32_t edge : {16, 32, 64, 128}) {
    std::map<ChunkCoord, RunChunk> chunks;
    const auto report = import_luanti(RUNSTONE_SOURCE_DIR "/tests/data/luanti_v7_small",
                                      {.edge = edge, .only_cubes = true},
                                      {[](const MaterialTable&) {},
                                       [&](const ChunkKey& key, RunChunk&& chunk) {
                                         chunks.emplace(key.at, std::move(chunk));
                                         return true;
                                       },
                                       {}});
    REQUIRE(report.has_value());
    const VisibilityTable covers(veil_visibilities(report->materials));
    const VeilMaterials materials{covers, veil_filler(covers)};
    const VeilOracleRules rules{
        [&covers](Material material) { return covers[material] == Visibility::opaque; }, true,
        materials.filler};
    std::size_t before = 0, after = 0, tested = 0;
    for (const auto& [at, chunk] : chunks) {
      // A few chunks of each edge, because the oracle is slow.
      if (chunk.is_uniform() || ++tested > 192u / static_cast<unsigned>(edge)) continue;
      std::array<const RunChunk*, kDirectionCount> beyond{};
      for (std::size_t d = 0; d < beyond.size(); ++d) {
        const auto found = chunks.find(neighbour(at, static_cast<Direction>(d)));
        if (found != chunks.end()) beyond[d] = &found->second;
      }
      const RunChunk veil = veil_of(chunk, beyond, materials, scratch);
      CAPTURE(edge, at.x, at.y, at.z);
      REQUIRE(DenseChunk::of(veil) ==
              oracle_veil(DenseScene::of(chunk, beyond), kVeilOrder, rules));
      before += chunk.runs.size();
      after += veil.runs.size();
    }
    CHECK(before > after);
  }
}

}  // namespace runstone::test
