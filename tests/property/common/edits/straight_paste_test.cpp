#include "common/edits/descriptor/straight_paste.hpp"

#include <catch2/catch.hpp>
#include <variant>

#include "common/edits/apply/edit_stack.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

TEST_CASE("a straight paste has the effect of the turned one", "[edits][property]") {
  SplitMix64 rng{17 + Catch::rngSeed()};
  ApplyScratch scratch;
  int turned = 0, changed = 0;
  for (int round = 0; round < 60'000 && turned < 600; ++round) {
    const Extent extent = Extent::cube(16);
    const VoxelPos origin{-16, 0, 32};
    const EditDescriptor edit = random_edit_near(rng, origin, extent);
    const auto* const paste = std::get_if<Paste>(&edit.shape);
    if (paste == nullptr || paste->orientation == Orientation{}) continue;
    CAPTURE(Catch::rngSeed(), round);
    const auto straight = straight_paste(*paste);
    if (!straight) continue;  // too long in every axis order
    ++turned;
    REQUIRE(straight->orientation == Orientation{});
    const EditDescriptor other{*straight, edit.mask, edit.material};
    REQUIRE(validate(other).has_value());
    RunChunk a = random_chunk(rng, extent, random_order(rng), 4), b = a;
    Digest digest_a = digest_of(a), digest_b = digest_a;
    changed += apply_stack(a, digest_a, origin, {&edit, 1}, scratch).changed ? 1 : 0;
    apply_stack(b, digest_b, origin, {&other, 1}, scratch);
    REQUIRE(a == b);
    REQUIRE(digest_a == digest_b);
  }
  CHECK(turned == 600);
  CHECK(changed > 100);
}

}  // namespace runstone::test
