#include "common/veil/veil_patch_bytes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>
#include <vector>

#include "common/core/hash.hpp"
#include "common/veil/veil.hpp"

namespace runstone::test {
namespace {

constexpr Extent kBytesExtent = Extent::cube(8);

VeilPatch spans_of(std::vector<VeilSpan> spans) {
  return {kBytesExtent, kVeilOrder, std::move(spans)};
}

Bytes bytes_of(const VeilPatch& patch) {
  Bytes out;
  ByteWriter writer(out);
  write_patch_bytes(patch, writer);
  return out;
}

ErrorCode fault_of(const Bytes& bytes) {
  const auto result = read_patch_bytes(bytes, kBytesExtent);
  REQUIRE_FALSE(result.has_value());
  return result.error().code;
}

}  // namespace

TEST_CASE("the bytes of a patch are pinned", "[veil]") {
  CHECK(bytes_of(spans_of({})) == Bytes{0});
  const VeilPatch patch = spans_of({{0, 1, 7}, {3, 2, 7}, {5, 300, 512}, {511, 1, 0}});
  const Bytes pinned = {4,                             // spans
                        0,    0,    7,                 // one voxel of 7 at 0
                        2,    3,                       // two more at 3
                        0,    0xd6, 0x04, 0x80, 0x04,  // 300 of 512 behind them
                        0xce, 0x01, 0,    0};          // the last voxel is empty
  CHECK(bytes_of(patch) == pinned);
  const auto read = read_patch_bytes(pinned, kBytesExtent);
  REQUIRE(read.has_value());
  CHECK(*read == patch);
}

TEST_CASE("bytes of a patch that are cut, longer or not canonical are refused", "[veil]") {
  const Bytes good = bytes_of(spans_of({{0, 1, 7}, {3, 2, 7}, {5, 300, 512}, {511, 1, 0}}));
  for (std::size_t size = 0; size < good.size(); ++size)
    CHECK_FALSE(read_patch_bytes(ByteView(good).first(size), kBytesExtent).has_value());
  Bytes longer = good;
  longer.push_back(0);
  CHECK(fault_of(longer) == ErrorCode::trailing_bytes);
  CHECK(fault_of({1, 0, 1}) == ErrorCode::bad_value);                  // the first has no material
  CHECK(fault_of({2, 0, 0, 7, 1, 0, 7}) == ErrorCode::not_canonical);  // repeated
  CHECK(fault_of({2, 0, 0, 7, 0, 1}) == ErrorCode::not_canonical);     // touch
  CHECK(fault_of({1, 0x80, 0x04, 0, 7}) == ErrorCode::bad_value);      // begins behind the chunk
  CHECK(fault_of({1, 0xff, 0x03, 2, 7}) == ErrorCode::bad_value);      // ends behind it
  CHECK(fault_of({2, 0xff, 0x03, 0, 7, 0, 0, 8}) == ErrorCode::bad_value);
  CHECK(fault_of({1, 0, 0, 0x80, 0x80, 0x04}) == ErrorCode::bad_value);  // material 65,536
  CHECK(fault_of({0xff, 0x03, 0, 0, 7}) == ErrorCode::truncated);
}

TEST_CASE("random bytes of patches come back or are refused", "[veil]") {
  SplitMix64 rng{3};
  for (int step = 0; step < 500; ++step) {
    VeilPatch patch = spans_of({});
    for (std::uint32_t at = rng.below(20); at < 512; at += rng.below(30)) {
      const std::uint32_t count = std::min(1 + rng.below(9), 512 - at);
      const auto material = static_cast<Material>(rng.below(3) * 300);
      const bool touches =
          !patch.empty() && patch.spans.back().first + patch.spans.back().count == at;
      if (!touches || patch.spans.back().material != material)
        patch.spans.push_back({at, count, material});
      at = patch.spans.back().first + patch.spans.back().count;
    }
    REQUIRE(validate(patch));
    Bytes bytes = bytes_of(patch);
    const auto read = read_patch_bytes(bytes, kBytesExtent);
    REQUIRE(read.has_value());
    CHECK(*read == patch);
    // A patch that is accepted has these bytes and no others.
    bytes[rng.below(static_cast<std::uint32_t>(bytes.size()))] ^=
        static_cast<std::uint8_t>(1 + rng.below(255));
    const auto other = read_patch_bytes(bytes, kBytesExtent);
    if (!other) continue;
    REQUIRE(validate(*other));
    CHECK(bytes_of(*other) == bytes);
  }
}

}  // namespace runstone::test
