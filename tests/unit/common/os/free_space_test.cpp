#include "common/os/free_space.hpp"

#include <catch2/catch.hpp>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

TEST_CASE("the free space of a folder is known, and that of no folder is not", "[os]") {
  const TempFolder folder;
  const auto free = free_bytes(folder.path());
  REQUIRE(free.has_value());
  CHECK(*free > 0);
  CHECK_FALSE(free_bytes(folder / "nothing").has_value());
}

}  // namespace runstone::test
