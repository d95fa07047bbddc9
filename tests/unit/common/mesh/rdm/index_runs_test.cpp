#include "common/mesh/rdm/index_runs.hpp"

#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/core/hash.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

// Makes runs of materials of [0, kinds), of which the higher ones occur from the middle on.
RunList draw_runs(SplitMix64& rng, std::size_t count, std::uint32_t kinds, bool narrow) {
  std::vector<PackedRun> packed;
  std::vector<std::uint32_t> ends;
  std::vector<Material> materials;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t drawn = i < count / 2 ? (kinds + 1) / 2 : kinds;
    const auto material = static_cast<Material>(rng.below(drawn));
    packed.push_back({static_cast<std::uint16_t>(i + 1), material});
    ends.push_back(i + 1);
    materials.push_back(material);
  }
  return narrow ? RunList::of_narrow(std::move(packed))
                : RunList::of_wide(std::move(ends), std::move(materials));
}

TEST_CASE("runs get the same indices a vector at a time as one by one", "[mesh]") {
  const VisibilityTable visibility(
      visibilities(many_materials()));  // 1 to 149 opaque, 150 to 299 transparent
  SplitMix64 rng(20261126);
  rdm::ChunkPalette plain, palette;
  for (const bool narrow : {true, false}) {
    for (const std::uint32_t kinds : {1u, 2u, 5u, 15u, 16u, 17u, 40u, 200u}) {
      for (const std::size_t count : {0u, 1u, 31u, 32u, 33u, 63u, 64u, 65u, 1000u}) {
        INFO("narrow " << narrow << ", " << kinds << " materials, " << count << " runs");
        const RunList runs = draw_runs(rng, count, kinds, narrow);
        std::vector<rdm::BytePaletteIndex> expected(count), indices(count);
        plain.clear();
        palette.clear();
        runs.visit([&](const auto& view) {
          plain.list(view, 0, count, visibility, expected.data());
          rdm::index_runs(view, visibility, palette, indices.data());
        });
        CHECK(indices == expected);
        CHECK(palette.solid_count() == plain.solid_count());
        CHECK(palette.transparent_count() == plain.transparent_count());
        CHECK(std::vector(palette.seen().begin(), palette.seen().end()) ==
              std::vector(plain.seen().begin(), plain.seen().end()));
      }
    }
  }
}

}  // namespace
}  // namespace runstone::test
