#include "server/convert/convert_program.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "common/formats/file_build.hpp"
#include "common/formats/height_map.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/schematic_writer.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

struct Outcome {
  int code;
  std::string out, err;
};

Outcome convert(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"runstone-convert"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out, err;
  const int code = convert_program(static_cast<int>(argv.size()), argv.data(), out, err);
  return {code, out.str(), err.str()};
}

void write_bytes(const std::string& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

Bytes bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

FileBuild read_back(const std::string& file) {
  auto build = read_file_build(file, bytes_of(file), {});
  INFO((build ? "" : build.error()));
  REQUIRE(build.has_value());
  return *std::move(build);
}

/// Writes a build of random cells as an .rsb, and returns it.
FileBuild make_rsb(const std::string& file) {
  SplitMix64 rng(11);
  FileBuild build = random_file_build(rng, {40, 9, 21}, 12, true);
  Bytes bytes;
  REQUIRE(write_file_build(file, build, [&](ByteView part) {
            bytes.insert(bytes.end(), part.begin(), part.end());
            return true;
          }).has_value());
  write_bytes(file, bytes);
  return build;
}

}  // namespace

TEST_CASE("a build keeps its cells through the files of other programs", "[convert]") {
  const TempFolder folder;
  const std::string first = folder / "house.rsb";
  const FileBuild build = make_rsb(first);
  const std::string ending = GENERATE(as<std::string>(), ".schem", ".litematic", ".rsb");
  const std::string there = folder / ("there" + ending), back = folder / "back.rsb";
  const bool is_older = ending == ".schem" && GENERATE(false, true);
  const Outcome done = is_older ? convert({first, there, "--schem", "2"}) : convert({first, there});
  INFO(done.err);
  REQUIRE(done.code == 0);
  CHECK(done.out.find("40 x 9 x 21 voxels, " + std::to_string(solid_cells(build)) +
                      " of them not empty") != std::string::npos);
  REQUIRE(convert({there, back}).code == 0);
  const FileBuild read = read_back(back);
  REQUIRE(read.build->sides() == build.build->sides());
  for (std::int32_t z = 0; z < 21; ++z) {
    for (std::int32_t y = 0; y < 9; ++y) {
      for (std::int32_t x = 0; x < 40; ++x) {
        const auto name = [&](const FileBuild& of) -> std::string {
          const auto material = of.build->at({x, y, z});
          if (!material) return "-";
          const BuildMaterial& row = of.materials[*of.build->number_of(*material) - 1U];
          return row.row.name + row.states;
        };
        REQUIRE(name(read) == name(build));
      }
    }
  }
}

TEST_CASE("runstone-convert says what a file is, and lists its materials", "[convert]") {
  const TempFolder folder;
  const std::string file = folder / "house.rsb";
  const FileBuild build = make_rsb(file);
  const Outcome said = convert({file, "--list"});
  REQUIRE(said.code == 0);
  for (const BuildMaterial& material : build.materials)
    CHECK(said.out.find('\n' + material.row.name) != std::string::npos);
}

TEST_CASE("runstone-convert --only-cubes leaves out what is no whole cube, but not stairs",
          "[convert][shapes]") {
  const TempFolder folder;
  std::vector<BuildMaterial> materials;
  for (const char* name : {"minecraft:dandelion", "minecraft:oak_stairs", "minecraft:stone"}) {
    const ForeignBlock block = with_default_states({name, ""});
    materials.push_back({row_of(material_of_minecraft_block(block, true)), block.states});
  }
  const std::string file = folder / "garden.schem";
  const auto bytes = written(write_schem, file_build({3, 1, 1}, materials, [](VoxelPos at) {
                               return static_cast<std::uint16_t>(at.x + 1);
                             }));
  REQUIRE(bytes.has_value());
  write_bytes(file, *bytes);
  const Outcome all = convert({file, "--list"}), cubes = convert({file, "--only-cubes", "--list"});
  REQUIRE(all.code == 0);
  REQUIRE(cubes.code == 0);
  CHECK(all.out.find("minecraft:dandelion") != std::string::npos);
  CHECK(cubes.out.find("minecraft:dandelion") == std::string::npos);
  CHECK(cubes.out.find("minecraft:oak_stairs") != std::string::npos);
  CHECK(cubes.out.find("minecraft:stone") != std::string::npos);
}

TEST_CASE("runstone-convert writes models with the choices of its options", "[convert]") {
  const TempFolder folder;
  const std::string file = folder / "house.rsb";
  make_rsb(file);
  const auto size_with = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {file, folder / "house.glb"});
    const Outcome done = convert(options);
    INFO(done.err);
    REQUIRE(done.code == 0);
    return std::filesystem::file_size(folder / "house.glb");
  };
  const auto size = size_with({});
  CHECK(size_with({"--split"}) > size);
  CHECK(size_with({"--close-t-junctions"}) > size);
  CHECK(size_with({"--quantise"}) < size);
  CHECK(size_with({"--levels", "2"}) > size);
  CHECK(convert({file, folder / "house.glb", "--levels", "9"}).code != 0);
  REQUIRE(convert({file, folder / "house.ply", "--levels", "1"}).code == 0);
  CHECK(std::filesystem::exists(folder / "house.lod1.ply"));
  CHECK_FALSE(std::filesystem::exists(folder / "house.lod2.ply"));
  size_with({"--metres-per-voxel", "0.25"});
  const Bytes bytes = bytes_of(folder / "house.glb");
  CHECK(std::string(bytes.begin(), bytes.end()).find(R"("scale":[0.25,0.25,0.25])") !=
        std::string::npos);
  CHECK(convert({file, folder / "house.glb", "--metres-per-voxel", "0"}).code != 0);
}

TEST_CASE("runstone-convert refuses choices of models that are out of range", "[convert]") {
  const TempFolder folder;
  const auto refusal = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {folder / "statue.obj"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome done = convert(words);
    CHECK(done.code != 0);
    return done.err;
  };
  CHECK(refusal({"--voxels", "5000"})
            .find("--voxels: \"5000\": a whole number from 1 to 4096 is expected") !=
        std::string::npos);
  CHECK(refusal({"--turn", "45"}).find("\"45\": 0, 90, 180 or 270 is expected") !=
        std::string::npos);
  CHECK(refusal({"--voxels", "5", "--voxels-per-metre", "2"}).find("excludes") !=
        std::string::npos);
  CHECK(refusal({"--hollow", "--surface", "none"}).find("neither its inside") != std::string::npos);
}

TEST_CASE("runstone-convert writes the chosen version of a .schem, and of no other file",
          "[convert]") {
  const TempFolder folder;
  const std::string file = folder / "house.rsb", out = folder / "house.schem";
  make_rsb(file);
  REQUIRE(convert({file, out}).code == 0);
  const Bytes today = bytes_of(out);
  REQUIRE(convert({file, out, "--schem", "3"}).code == 0);
  CHECK(bytes_of(out) == today);
  REQUIRE(convert({file, out, "--schem", "2"}).code == 0);
  CHECK(bytes_of(out) != today);
  CHECK(convert({file, out, "--schem", "1"}).code != 0);
  const Outcome refused = convert({file, folder / "house.vox", "--schem", "2"});
  CHECK(refused.code == 1);
  CHECK(refused.err.find("house.vox: is no .schem") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "house.vox"));
}

TEST_CASE("runstone-convert maps materials, and names the rows that fit none", "[convert]") {
  const TempFolder folder;
  const std::string file = folder / "house.rsb", map = folder / "map.toml";
  make_rsb(file);
  std::ofstream(map) << "[materials]\n\"m100*\" = \"planks\"\n\"m1003\" = \"air\"\n"
                        "\"other:*\" = \"sand\"\n";
  const Outcome done = convert({file, folder / "out.rsb", "--map", map});
  INFO(done.err);
  REQUIRE(done.code == 0);
  CHECK(done.out.find(map + ": these rows fit no material: \"other:*\"\n") != std::string::npos);
  const FileBuild read = read_back(folder / "out.rsb");
  REQUIRE(read.materials.size() == 2);
  CHECK(read.materials[0].row.name == "air");
  CHECK(read.materials[1].row.name == "planks");

  std::ofstream(map) << "[materials]\na = 4\n";
  const Outcome refused = convert({file, folder / "new.rsb", "--map", map});
  CHECK(refused.code == 1);
  CHECK(refused.err.find("map.toml:2: \"a\": must be") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "new.rsb"));
}

TEST_CASE("runstone-convert takes the colours of a height map from a second file", "[convert]") {
  const TempFolder folder;
  const std::string land = folder / "land.png", colours = folder / "colours.png";
  const FileBuild build = file_build(
      {3, 2, 2},
      {file_material("a", "", {255, 0, 0, 255}), file_material("b", "", {0, 255, 0, 255})},
      [](VoxelPos at) { return static_cast<std::uint16_t>(at.x == 0 ? 1 : 2); });
  write_bytes(land, *written(write_height_map, build));
  write_bytes(colours, *written(write_colour_map, build));
  const Outcome done = convert({land, folder / "out.rsb", "--colours", colours});
  INFO(done.err);
  REQUIRE(done.code == 0);
  const FileBuild read = read_back(folder / "out.rsb");
  const auto name = [&](VoxelPos at) {
    return read.materials[*read.build->number_of(*read.build->at(at)) - 1U].row.name;
  };
  CHECK(name({0, 0, 0}) == "colour #ff0000");
  CHECK(name({2, 1, 1}) == "colour #00ff00");

  const auto refusal = [&](const std::string& file, const std::string& picture) {
    const Outcome refused = convert({file, folder / "new.rsb", "--colours", picture});
    CHECK(refused.code == 1);
    CHECK_FALSE(std::filesystem::exists(folder / "new.rsb"));
    return refused.err;
  };
  make_rsb(folder / "house.rsb");
  CHECK(refusal(folder / "house.rsb", colours).find("house.rsb: is no height map (.png)") !=
        std::string::npos);
  CHECK(refusal(land, folder / "none.png").find("none.png") != std::string::npos);
  write_bytes(folder / "empty.png", {});
  CHECK(refusal(land, folder / "empty.png").find("empty.png: has no bytes") != std::string::npos);
  write_bytes(folder / "bad.png", {1, 2, 3});
  CHECK(refusal(land, folder / "bad.png")
            .find("land.png with the colours of " + (folder / "bad.png")) != std::string::npos);
  const FileBuild narrow = file_build({1, 2, 2}, {file_material("a", "", {255, 0, 0, 255})},
                                      [](VoxelPos) { return std::uint16_t{1}; });
  write_bytes(folder / "narrow.png", *written(write_colour_map, narrow));
  CHECK(refusal(land, folder / "narrow.png").find("the colour map has another size") !=
        std::string::npos);
}

TEST_CASE("a schematic that runstone-convert turns four times is equal, states included",
          "[convert]") {
  const TempFolder folder;
  const std::string states = "facing=east,half=top,shape=outer_left,waterlogged=false";
  const MaterialRow stairs =
      row_of(material_of_minecraft_block({"minecraft:oak_stairs", states}, true));
  const MaterialRow log =
      row_of(material_of_minecraft_block({"minecraft:oak_log", "axis=z"}, true));
  const FileBuild build =
      file_build({3, 2, 4}, {{stairs, states}, {log, "axis=z"}}, [](VoxelPos at) {
        return static_cast<std::uint16_t>(at.x == 2 ? 2 : at.z == 0 ? 1 : 0);
      });
  write_bytes(folder / "made.schem", *written(write_schem, build));
  REQUIRE(convert({folder / "made.schem", folder / "0.schem"}).code == 0);
  for (int i = 0; i < 4; ++i) {
    const auto name = [&](int number) { return folder / (std::to_string(number) + ".schem"); };
    const Outcome done = convert({name(i), name(i + 1), "--turn", "90"});
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(done.out.find("no state") == std::string::npos);
  }
  const FileBuild once = read_back(folder / "1.schem");
  CHECK(once.build->sides() == VoxelPos{4, 2, 3});
  // East goes to north.
  CHECK(cell_texts(once)[0].find("|axis=x|") != std::string::npos);
  CHECK(once.materials[1].states == "facing=north,half=top,shape=outer_left,waterlogged=false");
  CHECK(bytes_of(folder / "4.schem") == bytes_of(folder / "0.schem"));
  CHECK(bytes_of(folder / "1.schem") != bytes_of(folder / "0.schem"));
  REQUIRE(convert({folder / "1.schem", folder / "back.schem", "--turn", "270"}).code == 0);
  CHECK(bytes_of(folder / "back.schem") == bytes_of(folder / "0.schem"));
  CHECK(convert({folder / "0.schem", folder / "bad.schem", "--turn", "45"}).code != 0);
}

TEST_CASE("runstone-convert refuses with the file and the reason, and keeps an old file",
          "[convert]") {
  const TempFolder folder;
  const std::string file = folder / "house.rsb", old = folder / "old.schem";
  make_rsb(file);
  write_bytes(old, {1, 2, 3});

  Outcome refused = convert({file, folder / "house.exe"});
  CHECK(refused.code == 1);
  CHECK(
      refused.err.find("house.exe: no format of this ending is written; the endings are .rsb, ") !=
      std::string::npos);

  Bytes damaged = bytes_of(file);
  damaged[damaged.size() / 2] ^= 1;
  write_bytes(folder / "damaged.rsb", damaged);
  refused = convert({folder / "damaged.rsb", old});
  CHECK(refused.code == 1);
  CHECK(refused.err.find("damaged.rsb: ") != std::string::npos);
  CHECK(bytes_of(old) == Bytes{1, 2, 3});

  refused = convert({old, folder / "new.rsb"});
  CHECK(refused.code == 1);
  CHECK(refused.err.find("old.schem: ") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "new.rsb"));

  refused = convert({folder / "none.rsb", old});
  CHECK(refused.code == 1);
  CHECK(refused.err.find("none.rsb") != std::string::npos);
}

}  // namespace runstone::test
