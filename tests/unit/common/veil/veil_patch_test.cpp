#include "common/veil/veil_patch.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>
#include <vector>

#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr Extent kPatchExtent = Extent::cube(8);

VeilPatch patch_of(std::vector<VeilSpan> spans) {
  return {kPatchExtent, AxisOrder::xyz, std::move(spans)};
}

}  // namespace

TEST_CASE("a patch from outside is checked", "[veil]") {
  CHECK(validate(patch_of({})));
  CHECK(validate(patch_of({{0, 3, 1}, {3, 1, 2}, {10, 502, 2}})));
  const auto fault = [](std::vector<VeilSpan> spans) {
    const auto result = validate(patch_of(std::move(spans)));
    REQUIRE_FALSE(result.has_value());
    return std::pair{result.error().code, result.error().offset};
  };
  using Fault = std::pair<ErrorCode, std::uint64_t>;
  const auto broken = [](std::uint64_t at) { return Fault{ErrorCode::broken_invariant, at}; };
  CHECK(fault({{1, 1, 1}, {5, 0, 1}}) == broken(1));
  CHECK(fault({{5, 3, 1}, {7, 1, 2}}) == broken(1));
  CHECK(fault({{5, 3, 1}, {2, 1, 2}}) == broken(1));
  CHECK(fault({{5, 3, 1}, {8, 1, 1}}) == broken(1));
  CHECK(fault({{512, 1, 1}}) == broken(0));
  CHECK(fault({{0, 513, 1}}) == broken(0));
  CHECK(fault({{511, 0xffffffff, 1}}) == broken(0));
  VeilPatch flat = patch_of({});
  flat.extent.y = 0;
  CHECK(validate(flat).error().code == ErrorCode::bad_value);
}

TEST_CASE("a patch in another axis order changes the same voxels", "[veil]") {
  SplitMix64 rng{7};
  for (int step = 0; step < 200; ++step) {
    const Extent extent = random_extent(rng, 20);
    VeilPatch patch{extent, random_order(rng), {}};
    const std::uint32_t count_max = step % 4 == 0 ? extent.volume() / 2 : 40;
    for (std::uint32_t at = rng.below(50); at < extent.volume(); at += 1 + rng.below(90)) {
      const std::uint32_t count = std::min(1 + rng.below(count_max), extent.volume() - at);
      patch.spans.push_back({at, count, static_cast<Material>(rng.below(4))});
      at += count;
    }
    REQUIRE(validate(patch));
    const RunChunk before = random_chunk(rng, extent, random_order(rng), 4);
    DenseChunk expected = DenseChunk::of(before);
    bool is_changed = false;
    for (const VeilSpan& span : patch.spans)
      is_changed = expected.fill(patch.order, span.first, span.count, span.material) || is_changed;
    CAPTURE(step);
    const VeilPatch turned = in_order(patch, before.order);
    REQUIRE(validate(turned));
    CHECK(in_order(turned, patch.order) == patch);
    RunChunk after = before;
    REQUIRE(apply_patch(patch, after) == is_changed);
    REQUIRE(validate(after));
    REQUIRE(DenseChunk::of(after) == expected);
  }
}

}  // namespace runstone::test
