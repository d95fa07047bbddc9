// A build becomes a model, and the model a build again, through runstone-read-model.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "common/build_files/build_files.hpp"
#include "common/builds/build_transforms.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

constexpr VoxelPos kHouseSides{9, 7, 6};

/// A house of two colours with a room, a door and a step. No two parts touch at an edge alone.
FileBuild sample_house() {
  const auto cell = [](VoxelPos at) -> std::uint16_t {
    if (at.x == 8) return at.y == 0 ? 1 : 0;  // the step
    const bool is_roof = at.y >= 5;
    const bool is_room = at.x >= 2 && at.x <= 5 && at.y >= 1 && at.y <= 3 && at.z >= 1 && at.z <= 4;
    const bool is_door = at.x > 5 && at.y >= 1 && at.y <= 2 && at.z >= 2 && at.z <= 3;
    if (is_room || is_door) return 0;
    return is_roof ? 2 : 1;
  };
  return file_build(
      kHouseSides,
      {file_material("air", "", {0, 0, 0, 0}), file_material("stone", "", {90, 100, 110, 255}),
       file_material("tiles", "", {200, 60, 40, 255})},
      [cell](VoxelPos at) { return static_cast<std::uint16_t>(cell(at) + 1); });
}

/// Returns the colour of a voxel, or nullopt where nothing is.
std::optional<MaterialColour> colour_at(const FileBuild& build, VoxelPos at) {
  const auto material = build.build->at(at);
  if (!material) return std::nullopt;
  const auto palette = build.build->palette();
  for (std::size_t i = 0; i < palette.size(); ++i) {
    if (palette[i] != *material) continue;
    const MaterialRow& row = build.materials[i].row;
    if (row.visibility == Visibility::empty) return std::nullopt;
    return row.colour;
  }
  return std::nullopt;
}

BuildReading model_reading() {
  BuildReading reading;
  reading.model.voxels = 9;
  reading.model.file.program = RUNSTONE_READ_MODEL_PROGRAM;
  return reading;
}

}  // namespace

TEST_CASE("a build that is written as a model is read as the same voxels", "[build_files]") {
  const TempFolder folder;
  const FileBuild house = sample_house();
  for (const char* name : {"house.glb", "house.gltf", "house.obj", "house.ply"}) {
    CAPTURE(name);
    const std::string file = folder / name;
    ModelWriting writing;
    writing.levels = 2;  // only the finest one is read
    REQUIRE(write_build_to_file(file, house, {writing}));
    std::vector<std::string> notices;
    BuildReading reading = model_reading();
    reading.notice = [&](const std::string& line) { notices.push_back(line); };
    const auto read = read_build_of_file(file, reading);
    INFO((read ? "" : read.error()));
    REQUIRE(read);
    CHECK(read->info.name == "house");
    REQUIRE(read->build->sides() == kHouseSides);
    for (std::int32_t z = 0; z < kHouseSides.z; ++z) {
      for (std::int32_t y = 0; y < kHouseSides.y; ++y) {
        for (std::int32_t x = 0; x < kHouseSides.x; ++x) {
          CAPTURE(x, y, z);
          REQUIRE(colour_at(*read, {x, y, z}) == colour_at(house, {x, y, z}));
        }
      }
    }
  }
}

TEST_CASE("a model is turned as a build is", "[build_files]") {
  const TempFolder folder;
  const std::string file = folder / "house.glb";
  REQUIRE(write_build_to_file(file, sample_house()));
  const auto plain = read_build_of_file(file, model_reading());
  REQUIRE(plain);
  for (int quarters = 0; quarters < 4; ++quarters) {
    CAPTURE(quarters);
    BuildReading reading = model_reading();
    reading.model.quarters = quarters;
    const auto read = read_build_of_file(file, reading);
    REQUIRE(read);
    FileBuild wanted;
    wanted.materials = plain->materials;
    wanted.build = *turned(*plain->build, Orientation{}.rotated_about_y(quarters));
    const VoxelPos sides = wanted.build->sides();
    REQUIRE(read->build->sides() == sides);
    CHECK(read->info.sides.x == static_cast<std::uint32_t>(sides.x));
    for (std::int32_t z = 0; z < sides.z; ++z) {
      for (std::int32_t y = 0; y < sides.y; ++y) {
        for (std::int32_t x = 0; x < sides.x; ++x) {
          CAPTURE(x, y, z);
          REQUIRE(colour_at(*read, {x, y, z}) == colour_at(wanted, {x, y, z}));
        }
      }
    }
  }
}

TEST_CASE("the making of voxels tells its progress, and stops when it is not wanted",
          "[build_files]") {
  const TempFolder folder;
  const std::string file = folder / "house.glb";
  REQUIRE(write_build_to_file(file, sample_house()));
  BuildReading reading = model_reading();
  reading.model.voxels = 256;
  std::vector<double> shares;
  reading.model.progress = [&](double share) { shares.push_back(share); };
  REQUIRE(read_build_of_file(file, reading));
  REQUIRE(shares.size() > 4);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.front() > 0);
  CHECK(shares.back() == 1);

  reading.model.file.should_continue = [&] { return shares.size() < 3; };
  shares.clear();
  const auto stopped = read_build_of_file(file, reading);
  REQUIRE_FALSE(stopped);
  CHECK(stopped.error() == file + ": the work is not wanted any more");
  CHECK(shares.size() == 3);
}

TEST_CASE("a model is refused with what is wrong, and says what was done", "[build_files]") {
  const TempFolder folder;
  const std::string file = folder / "open.obj";
  std::ofstream(file)
      << "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 2 4\nf 1 2 3 4\nf 1 2 5\nf 2 3 5\n";
  std::vector<std::string> notices;
  BuildReading reading = model_reading();
  reading.notice = [&](const std::string& line) { notices.push_back(line); };
  REQUIRE(read_build_of_file(file, reading));
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].find("the surface is open") != std::string::npos);

  reading.model.is_solid = false;
  reading.model.surface = SurfaceMode::none;
  CHECK(read_build_of_file(file, reading).error() ==
        file + ": neither its inside nor its surface is wanted");
  reading = model_reading();
  reading.model.voxels_per_metre = 1e5;
  CHECK(read_build_of_file(file, reading).error().find("4,096") != std::string::npos);
  CHECK(file_refusal("a.exe", false).find(".glb") != std::string::npos);
  CHECK(file_refusal("a.stl", false).empty());
  CHECK_FALSE(file_refusal("a.stl", true).empty());
}

}  // namespace runstone::test
