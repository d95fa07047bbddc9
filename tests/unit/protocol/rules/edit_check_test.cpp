#include "protocol/rules/edit_check.hpp"

#include <catch2/catch.hpp>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

EditLimits limits() {
  EditLimits l;
  l.chunk_edge = 16;
  l.material_count = 8;
  l.volume_max = 50'000;
  return l;
}

TEST_CASE("edits beyond the limits are rejected with their reason", "[rules]") {
  const auto reason = [](const EditDescriptor& edit) { return check_edit(edit, limits()); };
  CHECK_FALSE(reason({FillSphere{{0, 0, 0}, 20}, {}, 1}).has_value());
  CHECK(reason({FillSphere{{0, 0, 0}, 30}, {}, 1}) == RejectReason::too_large);  // volume
  CHECK(reason({FillBox{{{0, 0, 0}, {4096, 1, 4096}}}, {}, 1}) ==
        RejectReason::too_large);                                                     // chunks
  CHECK(reason({FillBox{{{0, 0, 0}, {0, 1, 1}}}, {}, 1}) == RejectReason::bad_edit);  // empty
  const auto stroke = [&](std::int32_t length, std::uint16_t radius) {
    return reason({FillStroke{{{0, 0, 0}, {length, 0, 0}}, radius}, {}, 1});
  };
  CHECK_FALSE(stroke(1024, 2).has_value());           // counts 1,029 layers of 5 x 5
  CHECK(stroke(1024, 3) == RejectReason::too_large);  // 1,031 of 7 x 7
  CHECK(stroke(0, 2) == RejectReason::bad_edit);      // one point twice
  CHECK(stroke(1025, 2) == RejectReason::bad_edit);
  CHECK(reason({FillStroke{{{0, 0, 0}, {1024, 1024, 1024}}, 1}, {}, 1}) ==
        RejectReason::too_large);  // chunks
  CHECK(reason({SetVoxel{{kWorldLimit, 0, 0}}, {}, 1}) == RejectReason::bad_edit);
  CHECK(reason({SetVoxel{{0, 0, 0}}, {}, 8}) == RejectReason::unknown_material);
  CHECK(reason({SetVoxel{{0, 0, 0}}, {MaskKind::only_material, 8}, 1}) ==
        RejectReason::unknown_material);
  CHECK_FALSE(reason({SetVoxel{{0, 0, 0}}, {MaskKind::only_material, 7}, 1}).has_value());
}

TEST_CASE("a paste is checked by its touched chunks and each of its materials", "[rules]") {
  EditLimits l = limits();
  l.heights = {0, 8};
  const auto paste = [](VoxelPos at, Material high, std::uint32_t touched) {
    ClipboardBuilder cells({128, 1, 128}, AxisOrder::xzy);
    cells.append(touched, Material{1});
    cells.append(1, high);
    cells.append(128 * 128 - 1 - touched, std::nullopt);
    return EditDescriptor{Paste{at, *cells.finish(), {}}, {}, kEmpty};
  };
  CHECK_FALSE(check_edit(paste({0, 7, 0}, 7, 900), l).has_value());
  CHECK(check_edit(paste({0, 7, 0}, 8, 900), l) == RejectReason::unknown_material);
  CHECK(check_edit(paste({0, 8, 0}, 7, 900), l) == RejectReason::outside_world);
  l.volume_max = 901;
  CHECK_FALSE(check_edit(paste({0, 7, 0}, 7, 900), l).has_value());
  CHECK(check_edit(paste({0, 7, 0}, 7, 901), l) == RejectReason::too_large);
  l.touched_chunks_max = 8;  // a row along x
  CHECK_FALSE(check_edit(paste({0, 7, 0}, 7, 127), l).has_value());
  CHECK(check_edit(paste({1, 7, 0}, 7, 127), l) == RejectReason::too_large);
}

TEST_CASE("an edit that reaches above or below the world is rejected as a whole", "[rules]") {
  EditLimits l = limits();
  l.heights = {-8, 8};
  const auto reason = [&](const EditShape& shape) { return check_edit({shape, {}, 1}, l); };
  CHECK_FALSE(reason(SetVoxel{{0, -8, 0}}).has_value());
  CHECK_FALSE(reason(SetVoxel{{0, 7, 0}}).has_value());
  CHECK(reason(SetVoxel{{0, 8, 0}}) == RejectReason::outside_world);
  CHECK(reason(SetVoxel{{0, -9, 0}}) == RejectReason::outside_world);
  CHECK_FALSE(reason(FillBox{{{0, -8, 0}, {1, 8, 1}}}).has_value());
  CHECK(reason(FillBox{{{0, 0, 0}, {1, 9, 1}}}) == RejectReason::outside_world);
  CHECK_FALSE(reason(FillStroke{{{0, -6, 0}, {9, 5, 0}}, 2}).has_value());
  CHECK(reason(FillStroke{{{0, -6, 0}, {9, 6, 0}}, 2}) == RejectReason::outside_world);
  CHECK_FALSE(reason(FillSphere{{0, 2, 0}, 5}).has_value());
  CHECK(reason(FillSphere{{0, 3, 0}, 5}) == RejectReason::outside_world);
}

TEST_CASE("words about a refusal name the limit, its value and what to do", "[rules]") {
  EditLimits l;
  l.chunk_edge = 16;
  l.heights = {-64, 200};
  l.volume_max = 1'000'000;
  l.material_count = 5;
  const auto words = [&](const EditDescriptor& edit) {
    const auto reason = check_edit(edit, l);
    REQUIRE(reason.has_value());
    std::string text = refusal_words(*reason, edit, l);
    CHECK(text.size() <= kTextBytesMax);
    return text;
  };
  CHECK(words({FillBox{{{0, 0, 0}, {128, 128, 128}}}, {}, 1}) ==
        "the edit has 2097152 voxels, and one edit may have 1000000: fill, replace or paste a "
        "selection, which is sent in parts");
  l.volume_max = 10'000'000;
  CHECK(words({FillBox{{{0, 0, 0}, {4'096, 1, 2'048}}}, {}, 1}) ==
        "the edit touches 32768 chunks, and one edit may touch 4096: fill, replace or paste a "
        "selection, which is sent in parts");
  CHECK(words({FillBox{{{0, 190, 0}, {1, 210, 1}}}, {}, 1}) ==
        "the edit reaches from y = 190 to 209, and the world takes edits from -64 to 199");
  CHECK(words({SetVoxel{{0, 0, 0}}, {}, 9}) ==
        "the edit uses material 9, and the world has those below 5");
  CHECK(refusal_words(RejectReason::bad_edit, {SetVoxel{{0, 0, 0}}, {}, 9}, l).empty());
}

TEST_CASE("reach is measured to the farthest voxel of the bounding box", "[rules]") {
  const EditDescriptor voxel{SetVoxel{{10, 0, 0}}, {}, 1};
  CHECK(within_reach(voxel, {10.5, 0.5, 0.5}, 0));
  CHECK(within_reach(voxel, {4.5, 0.5, 0.5}, 6));
  CHECK_FALSE(within_reach(voxel, {4.4, 0.5, 0.5}, 6));
  CHECK(within_reach(voxel, {13.5, 4.5, 0.5}, 5));
  CHECK_FALSE(within_reach(voxel, {13.5, 4.6, 0.5}, 5));

  const EditDescriptor box{FillBox{{{0, 0, 0}, {101, 1, 1}}}, {}, 1};
  CHECK(within_reach(box, {0.5, 0.5, 0.5}, 100));
  CHECK_FALSE(within_reach(box, {0.5, 0.5, 0.5}, 99));  // it begins where the player stands
  CHECK(within_reach(box, {50.5, 0.5, 0.5}, 50));
  CHECK_FALSE(within_reach(box, {50.5, 0.5, 0.5}, 49));
}

}  // namespace
}  // namespace runstone
