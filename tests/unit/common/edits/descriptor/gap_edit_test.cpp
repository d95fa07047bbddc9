// The record that stands for a lost one: its bytes, its bounds, and what it does not touch.
#include <catch2/catch.hpp>
#include <limits>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_record.hpp"

namespace runstone {

TEST_CASE("a gap is read back, at the bounds too", "[edits][gap]") {
  for (const GapEdit& gap :
       {GapEdit{}, GapEdit{7, true}, GapEdit{std::numeric_limits<AuthorId>::max(), false}}) {
    const EditDescriptor edit = gap_edit(gap);
    REQUIRE(validate(edit).has_value());
    const Bytes bytes = encode(edit);
    CHECK(bytes.size() <= descriptor_bytes_max(EditKind::gap));
    const auto read = decode_descriptor(bytes);
    REQUIRE(read.has_value());
    REQUIRE(gap_of(*read) != nullptr);
    CHECK(*gap_of(*read) == gap);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      CHECK_FALSE(decode_descriptor(ByteView(bytes).first(size)).has_value());
    Bytes longer = bytes;
    longer.push_back(0);
    CHECK_FALSE(decode_descriptor(longer).has_value());
    CHECK_FALSE(decode_voxel_edit(bytes).has_value());
  }
  CHECK_FALSE(decode_descriptor(Bytes{0x0e, 0, 0, 2, 0}).has_value());  // unknown flags
}

TEST_CASE("a gap touches no voxel, and may begin an era", "[edits][gap]") {
  const EditDescriptor edit = gap_edit({3, false});
  CHECK_FALSE(has_voxels(edit));
  CHECK(touched_chunks(edit, 16).empty());
  CHECK_FALSE(changes_voxels(Cause::gap));
  CHECK(validate_fields({{1, 1}, {}, 0, Cause::gap, edit}).has_value());
  CHECK_FALSE(validate_fields({{1, 1}, {}, 0, Cause::player, edit}).has_value());
  CHECK_FALSE(corrects_time({{1, 1}, {}, 0, Cause::gap, edit}));
  CHECK(corrects_time({{1, 1}, {}, 0, Cause::gap, gap_edit({3, true})}));
}

}  // namespace runstone
