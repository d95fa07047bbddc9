#include "server/store/durable_mark.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/crash_image.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr std::uintmax_t kSecondSlot = 4096;

std::optional<DurableState> mark_in(const TempFolder& folder) {
  const auto read = DurableMark(folder.path(), sample_meta().world_id, "").read();
  REQUIRE(read.has_value());
  return *read;
}

void write_mark(const TempFolder& folder, const DurableState& state) {
  DurableMark mark(folder.path(), sample_meta().world_id, "");
  REQUIRE(mark.read().has_value());
  REQUIRE(mark.write(state).has_value());
  REQUIRE(mark.sync().has_value());
}

}  // namespace

TEST_CASE("a mark holds the newest state, across writers", "[store][mark][sqlite]") {
  const TempFolder folder;
  CHECK(mark_in(folder) == std::nullopt);
  CHECK(std::filesystem::is_empty(folder.path()));  // reading makes no file
  for (Sequence seq = 1; seq <= 5; ++seq) {
    write_mark(folder, {1, seq, 3});
    CHECK(mark_in(folder) == DurableState{1, seq, 3});
  }
  write_mark(folder, {1, 4, 9});  // older
  CHECK(mark_in(folder) == DurableState{1, 5, 3});
  write_mark(folder, {2, 4, 3});  // a shorter log of a newer start
  CHECK(mark_in(folder) == DurableState{2, 4, 3});
}

TEST_CASE("one damaged slot of a mark leaves the other, and two are reported",
          "[store][mark][sqlite]") {
  const TempFolder folder;
  const std::string file = folder / "world.durable";
  write_mark(folder, {1, 7, 1});  // in the first slot
  write_mark(folder, {1, 8, 1});  // in the second one
  const auto bytes = std::filesystem::file_size(file);
  for (std::uintmax_t at = kSecondSlot; at < bytes; ++at) {
    CAPTURE(at);
    flip_bit(file, at);
    CHECK(mark_in(folder) == DurableState{1, 7, 1});
    flip_bit(file, at);
  }
  CHECK(mark_in(folder) == DurableState{1, 8, 1});
  for (std::uintmax_t size = kSecondSlot; size < bytes; ++size) {
    CAPTURE(size);
    const TempFolder cut;
    std::filesystem::copy_file(file, cut / "world.durable");
    std::filesystem::resize_file(cut / "world.durable", size);
    CHECK(mark_in(cut) == DurableState{1, 7, 1});
  }
  flip_bit(file, 20);
  CHECK(mark_in(folder) == DurableState{1, 8, 1});
  flip_bit(file, kSecondSlot + 20);
  const auto read = DurableMark(folder.path(), sample_meta().world_id, "").read();
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error().kind == StoreError::Kind::corrupt);
  CHECK(read.error().file == file);
}

TEST_CASE("the next write repairs a damaged slot and keeps the sound one",
          "[store][mark][sqlite]") {
  const TempFolder folder;
  write_mark(folder, {1, 7, 1});
  write_mark(folder, {1, 8, 1});
  flip_bit(folder / "world.durable", kSecondSlot + 20);
  write_mark(folder, {1, 9, 1});
  CHECK(mark_in(folder) == DurableState{1, 9, 1});
  flip_bit(folder / "world.durable", kSecondSlot + 20);
  CHECK(mark_in(folder) == DurableState{1, 7, 1});
}

TEST_CASE("an empty mark and the mark of another world count as none", "[store][mark][sqlite]") {
  const TempFolder folder;
  std::ofstream(folder / "world.durable").flush();
  CHECK(mark_in(folder) == std::nullopt);
  std::filesystem::resize_file(folder / "world.durable", 8192);  // zeros, as a power loss leaves it
  CHECK(mark_in(folder) == std::nullopt);
  WorldId other = sample_meta().world_id;
  other[0] ^= 1;
  {
    DurableMark mark(folder.path(), other, "");
    REQUIRE(mark.read().has_value());
    REQUIRE(mark.write({5, 100, 5}).has_value());
  }
  CHECK(mark_in(folder) == std::nullopt);
  write_mark(folder, {1, 2, 3});
  CHECK(mark_in(folder) == DurableState{1, 2, 3});
}
