// The record that sets the clock of the world: its bytes, its bounds, and what it does not touch.
#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"
#include "common/edits/descriptor/edit_record.hpp"

namespace runstone {

TEST_CASE("a descriptor that sets the clock is read back, at the bounds too", "[edits][clock]") {
  for (const WorldTime& time :
       {WorldTime{0, 0}, WorldTime{75'600'000, 20}, WorldTime{kDayMs - 1, kTimeRateMax}}) {
    const EditDescriptor edit = clock_edit(time);
    REQUIRE(validate(edit).has_value());
    const Bytes bytes = encode(edit);
    CHECK(bytes.size() <= descriptor_bytes_max(EditKind::clock));
    const auto read = decode_descriptor(bytes);
    REQUIRE(read.has_value());
    CHECK(*read == edit);
    REQUIRE(world_time_of(*read) != nullptr);
    CHECK(*world_time_of(*read) == time);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      CHECK_FALSE(decode_descriptor(ByteView(bytes).first(size)).has_value());
    Bytes longer = bytes;
    longer.push_back(0);
    CHECK_FALSE(decode_descriptor(longer).has_value());
    CHECK_FALSE(decode_voxel_edit(bytes).has_value());
  }
}

TEST_CASE("a time that is none, and a rate that is too high, are refused", "[edits][clock]") {
  CHECK_FALSE(validate(clock_edit({kDayMs, 0})).has_value());
  CHECK(validate(clock_edit({0, 1'000'000})).error().code == ErrorCode::limit_exceeded);
  // 86,400,000 and 10,001 as varints.
  CHECK_FALSE(decode_descriptor(Bytes{0x0d, 0, 0, 0x80, 0xb8, 0x99, 0x29, 0}).has_value());
  CHECK_FALSE(decode_descriptor(Bytes{0x0d, 0, 0, 0, 0x91, 0x4e}).has_value());
  CHECK(decode_descriptor(Bytes{0x0d, 0, 0, 0, 0x90, 0x4e}).has_value());
  // The fields of a clock do not decode under the tag of the kind 12 (textures).
  CHECK_FALSE(decode_descriptor(Bytes{0x0c, 0, 0, 0, 0}).has_value());
  EditDescriptor coloured = clock_edit({});
  coloured.material = 1;
  CHECK_FALSE(validate(coloured).has_value());
}

TEST_CASE("setting the clock touches no voxel", "[edits][clock]") {
  const EditDescriptor edit = clock_edit({1, 1});
  CHECK_FALSE(has_voxels(edit));
  CHECK_FALSE(changes_materials(edit));
  CHECK(touched_chunks(edit, 16).empty());
  CHECK(counted_voxels(edit) == 0);
  CHECK(memory_bytes(edit) == sizeof(EditDescriptor));
  CHECK_FALSE(changes_voxels(Cause::clock));
  CHECK(validate_fields({{1, 1}, {}, 0, Cause::clock, edit}).has_value());
  CHECK_FALSE(validate_fields({{1, 1}, {}, 0, Cause::console, edit}).has_value());
}

}  // namespace runstone
