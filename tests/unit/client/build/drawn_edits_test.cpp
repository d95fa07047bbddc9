#include "client/build/drawn_edits.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/edits/clipboard/clipboard_builder.hpp"

namespace runstone::test {
namespace {

EditDescriptor fill(const VoxelBox& box, Material material) { return {FillBox{box}, {}, material}; }

}  // namespace

TEST_CASE("edits are drawn over each other, without their masks and whatever is there",
          "[client][build]") {
  std::vector<EditDescriptor> edits = {fill({{10, 0, 0}, {13, 1, 1}}, 4),
                                       fill({{12, 0, 0}, {14, 1, 1}}, kEmpty)};
  edits[0].mask = {MaskKind::only_material, 9};
  const auto untouched = unused_material(edits);
  REQUIRE(untouched == Material{1});
  ApplyScratch scratch;
  const DrawnEdits drawn = draw_edits(edits, {{9, 0, 0}, {14, 2, 1}}, *untouched, scratch);
  CHECK(drawn.cells.extent == Extent{5, 2, 1});
  CHECK_FALSE(drawn.is_uniform());
  const auto clipboard = drawn.clipboard();
  REQUIRE(clipboard);
  ClipboardBuilder expected({5, 2, 1});
  expected.append(1, std::nullopt);
  expected.append(2, Material{4});
  expected.append(2, kEmpty);
  expected.append(5, std::nullopt);
  CHECK(**clipboard == **expected.finish());
  CHECK(draw_edits(edits, {{10, 0, 0}, {12, 1, 1}}, *untouched, scratch).is_uniform());
  CHECK_FALSE(draw_edits(edits, {{0, 5, 0}, {3, 8, 3}}, *untouched, scratch).clipboard());
}

TEST_CASE("a material that no edit writes is found, if there is one", "[client][build]") {
  const VoxelBox box{{0, 0, 0}, {1, 1, 1}};
  CHECK(unused_material({}) == Material{0});
  std::vector<EditDescriptor> edits = {fill(box, 2), fill(box, 0), fill(box, 1), fill(box, 1)};
  CHECK(unused_material(edits) == Material{3});
  ClipboardBuilder pasted({2, 1, 1});
  pasted.append(1, Material{3});
  pasted.append(1, Material{5});
  edits.push_back({Paste{{0, 0, 0}, *pasted.finish(), {}}, {}, kEmpty});
  CHECK(unused_material(edits) == Material{4});
  for (std::size_t material = 0; material < kMaterialCountMax; ++material)
    edits.push_back(fill(box, static_cast<Material>(material)));
  CHECK_FALSE(unused_material(edits));
}

}  // namespace runstone::test
