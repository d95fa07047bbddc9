#include "common/build_files/build_files.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

FileBuild sample_tower() {
  return file_build({3, 9, 2}, {file_material("stone", "", {90, 90, 90, 255})},
                    [](VoxelPos) { return std::uint16_t{1}; });
}

std::string error_of_read(const std::string& file, std::size_t bytes_max = kBuildFileBytesMax) {
  const auto read = read_build_of_file(file, {}, bytes_max);
  return read ? "no error" : read.error();
}

}  // namespace

TEST_CASE("a build that is written to a file is read from it, in every format", "[build_files]") {
  const TempFolder folder;
  const FileBuild build = sample_tower();
  for (const char* name : {"tower.rsb", "tower.schem", "tower.litematic", "tower.vox", "tower.npy",
                           "tower.npz", "tower.mts"}) {
    CAPTURE(name);
    const std::string file = folder / name;
    const auto bytes = write_build_to_file(file, build);
    REQUIRE(bytes);
    CHECK(*bytes == std::filesystem::file_size(file));
    const auto read = read_build_of_file(file);
    REQUIRE(read);
    CHECK(read->build->sides() == VoxelPos{3, 9, 2});
    CHECK(solid_cells(*read) == 54);
  }
  CHECK(read_build_of_file(folder / "tower.npy")->info.name == "tower");
  BuildReading reading;
  reading.foreign.name = "mill";
  CHECK(read_build_of_file(folder / "tower.npy", reading)->info.name == "mill");
}

TEST_CASE("an .obj is written with its materials beside it, and both or none", "[build_files]") {
  const TempFolder folder;
  const std::string file = folder / "tower of stone.OBJ", second = folder / "tower of stone.mtl";
  const auto bytes = write_build_to_file(file, sample_tower());
  REQUIRE(bytes);
  CHECK(*bytes == std::filesystem::file_size(file) + std::filesystem::file_size(second));
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  CHECK(text.find("\nmtllib tower of stone.mtl\n") != std::string::npos);
  CHECK(text.find("\nusemtl stone\n") != std::string::npos);

  const FileBuild air = file_build({1, 1, 1}, {file_material("air", "", {0, 0, 0, 0})},
                                   [](VoxelPos) { return std::uint16_t{1}; });
  const auto refused = write_build_to_file(folder / "air.obj", air);
  REQUIRE_FALSE(refused);
  CHECK(refused.error() == (folder / "air.obj") + ": model: build shows no face");
  CHECK_FALSE(std::filesystem::exists(folder / "air.mtl"));
  std::filesystem::create_directory(folder / "lake.mtl");
  CHECK_FALSE(write_build_to_file(folder / "lake.obj", sample_tower()));
  CHECK_FALSE(std::filesystem::exists(folder / "lake.obj"));
}

TEST_CASE("levels of detail of an .obj or .ply are files of their own", "[build_files]") {
  const TempFolder folder;
  FileWriting writing;
  writing.model.levels = 2;
  const auto text_of = [&](const std::string& name) {
    std::ifstream in(folder / name);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  const auto bytes = write_build_to_file(folder / "tower.obj", sample_tower(), writing);
  REQUIRE(bytes);
  std::uint64_t sum = 0;
  for (const char* name : {"tower.obj", "tower.mtl", "tower.lod1.obj", "tower.lod1.mtl",
                           "tower.lod2.obj", "tower.lod2.mtl"}) {
    CAPTURE(name);
    sum += std::filesystem::file_size(folder / name);
  }
  CHECK(*bytes == sum);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 6);
  // 3 x 9 x 2 voxels become 1 x 3 x 1 of 4 metres, and the corner stays.
  const std::string level = text_of("tower.lod2.obj");
  CHECK(level.find("\nmtllib tower.lod2.mtl\n") != std::string::npos);
  CHECK(level.find("\nv 4 12 4\n") != std::string::npos);
  CHECK(level.find("\nv 0 0 0\n") != std::string::npos);

  REQUIRE(write_build_to_file(folder / "tower.ply", sample_tower(), writing));
  CHECK(std::filesystem::exists(folder / "tower.lod2.ply"));
  // A .glb holds them, and other formats have none.
  REQUIRE(write_build_to_file(folder / "keep.glb", sample_tower(), writing));
  REQUIRE(write_build_to_file(folder / "keep.vox", sample_tower(), writing));
  CHECK_FALSE(std::filesystem::exists(folder / "keep.lod1.glb"));
  CHECK_FALSE(std::filesystem::exists(folder / "keep.lod1.vox"));

  // A level that cannot be written leaves the old model.
  std::filesystem::create_directory(folder / "lake.lod1.obj");
  const auto refused = write_build_to_file(folder / "lake.obj", sample_tower(), writing);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().find((folder / "lake.lod1.obj") + ": ") == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "lake.obj"));
}

TEST_CASE("files with builds that cannot be read are refused in one line", "[build_files]") {
  const TempFolder folder;
  const std::string file = folder / "tower.npy";
  const auto bytes = write_build_to_file(file, sample_tower());
  REQUIRE(bytes);
  const auto size = static_cast<std::size_t>(*bytes);
  CHECK(error_of_read(file, size) == "no error");
  CHECK(error_of_read(file, size - 1) ==
        file + ": is larger than " + std::to_string(size - 1) + " bytes");
  CHECK(error_of_read(folder / "none.npy") ==
        (folder / "none.npy") + ": cannot be read: No such file or directory");
  CHECK(error_of_read(folder / "tower.exe").find("the endings are .rsb") != std::string::npos);
  std::ofstream(folder / "bad.rsb") << "no build";
  CHECK(error_of_read(folder / "bad.rsb").find((folder / "bad.rsb") + ": ") == 0);
  // Nobody writes to it: a reader that waits for its other end does not return.
  const std::string pipe = folder / "pipe.rsb";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(error_of_read(pipe) == pipe + ": is a device, a pipe or a socket, and no file");
}

TEST_CASE("a build that cannot be written leaves the old file", "[build_files]") {
  const TempFolder folder;
  const std::string file = folder / "old.mts";
  std::ofstream(file) << "old";
  const FileBuild too_long = file_build({65'536, 1, 1}, {file_material("a", "", {1, 2, 3, 255})},
                                        [](VoxelPos) { return std::uint16_t{1}; });
  const auto refused = write_build_to_file(file, too_long);
  REQUIRE_FALSE(refused);
  CHECK(refused.error() == file + ": mts: a side of the build is longer than 65,535");
  CHECK(std::filesystem::file_size(file) == 3);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
  CHECK(write_build_to_file(folder / "a.exe", too_long).error().find("written") !=
        std::string::npos);
  std::ofstream(folder / "world.mts") << std::string("SQLite format 3\0", 16);
  CHECK(write_build_to_file(folder / "world.mts", sample_tower()).error().find("database") !=
        std::string::npos);
}

TEST_CASE("a build has the name of its file if that is a name of a build", "[build_files]") {
  CHECK(build_name_of_file("/tmp/old mill.schem") == "old mill");
  CHECK(build_name_of_file("\"mill\".schem") == "build");
  CHECK(build_name_of_file(std::string(300, 'a') + ".vox") == std::string(kBuildNameBytesMax, 'a'));
}

}  // namespace runstone::test
