#include "server/runtime/disk_usage.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

TEST_CASE("the usage of a disk is measured at the world's files", "[server]") {
  const TempFolder folder;
  const DiskUsage none = disk_usage_of(folder / "world");
  CHECK_FALSE(none.world_bytes.has_value());
  CHECK_FALSE(none.free_bytes.has_value());
  std::filesystem::create_directory(folder / "world");
  std::ofstream(folder / "world/world.sqlite") << std::string(1234, 'x');
  const DiskUsage closed = disk_usage_of(folder / "world");
  CHECK(closed.world_bytes == 1234);
  CHECK_FALSE(closed.wal_bytes.has_value());
  CHECK(closed.free_bytes.value_or(0) > 0);
  std::ofstream(folder / "world/world.sqlite-wal") << std::string(77, 'x');
  CHECK(disk_usage_of(folder / "world").wal_bytes == 77);
}

TEST_CASE("a world in a database has no usage of a disk", "[server]") {
  const DiskUsage usage = disk_usage_of("postgresql://host/world");
  CHECK_FALSE(usage.free_bytes.has_value());
  CHECK_FALSE(usage.world_bytes.has_value());
}

}  // namespace runstone::test
