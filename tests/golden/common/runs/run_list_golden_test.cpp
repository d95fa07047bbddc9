// The memory of a run list is the body of the `raw` wire encoding on a little-endian machine. These
// tests pin it.
#include <bit>
#include <catch2/catch.hpp>
#include <cstring>

#include "common/core/bytes.hpp"
#include "common/runs/run_list.hpp"

using namespace runstone;

namespace {

template <class T>
Bytes memory_of(std::span<const T> items) {
  Bytes out(items.size_bytes());
  std::memcpy(out.data(), items.data(), out.size());
  return out;
}

}  // namespace

TEST_CASE("narrow runs are pairs of end and material, 4 bytes each", "[runs][golden]") {
  static_assert(std::endian::native == std::endian::little);
  RunList list(512);
  list.push_back({1, 0x0203});
  list.push_back({0x0200, 0});
  list.visit([](const auto& runs) {
    if constexpr (requires { runs.packed(); }) {
      CHECK(memory_of(runs.packed()) == Bytes{0x01, 0x00, 0x03, 0x02, 0x00, 0x02, 0x00, 0x00});
    } else {
      FAIL("512 voxels take the narrow form");
    }
  });
}

TEST_CASE("wide runs are a row of 4-byte ends and a row of 2-byte materials", "[runs][golden]") {
  RunList list(0x00040000);
  list.push_back({1, 0x0203});
  list.push_back({0x00040000, 0});
  list.visit([](const auto& runs) {
    if constexpr (requires { runs.ends(); }) {
      CHECK(memory_of(runs.ends()) == Bytes{0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x04, 0x00});
      CHECK(memory_of(runs.materials()) == Bytes{0x03, 0x02, 0x00, 0x00});
    } else {
      FAIL("262,144 voxels take the wide form");
    }
  });
}
