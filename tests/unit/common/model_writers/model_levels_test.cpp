#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/builds/build_builder.hpp"
#include "common/formats/file_build.hpp"
#include "common/formats/model_formats.hpp"
#include "common/model_writers/coarser_build.hpp"
#include "common/model_writers/model_writers.hpp"
#include "tests/support/formats/file_builds.hpp"
#include "tests/support/model_writers/written_model.hpp"

namespace runstone::test {
namespace {

const std::vector<BuildMaterial> kLevelMaterials = {
    file_material("air", "", {0, 0, 0, 0}), file_material("stone", "", {120, 121, 122, 255}),
    file_material("water", "", {10, 40, 250, 100}), file_material("sand", "", {220, 210, 90, 255})};

/// Returns what a cell shows: the name of its material, or nothing if it is empty, untouched or
/// outside.
std::string shown_at(const FileBuild& build, VoxelPos cell) {
  if (!build.build->box().contains(cell)) return "";
  const auto material = build.build->at(cell);
  if (!material) return "";
  const MaterialRow& row = build.materials[*build.build->number_of(*material) - 1U].row;
  return row.visibility == Visibility::empty ? "" : row.name;
}

/// The rule of tiles, cell by cell: the most exposed of eight, then the upper one, then the one
/// with the lower x, then the one with the lower z. Faces to the outside of a tile of 256 do not
/// count.
std::string coarse_at(const FileBuild& build, VoxelPos cell) {
  int best = -1;
  std::string out;
  for (const int y : {1, 0}) {
    for (const int x : {0, 1}) {
      for (const int z : {0, 1}) {
        const VoxelPos at{2 * cell.x + x, 2 * cell.y + y, 2 * cell.z + z};
        const std::string here = shown_at(build, at);
        int exposed = 0;
        for (int d = 0; d < kDirectionCount && !here.empty(); ++d) {
          const ChunkCoord to = neighbour(ChunkCoord{at.x, at.y, at.z}, static_cast<Direction>(d));
          const auto is_same_tile = [](int a, int b) { return b >= 0 && a / 256 == b / 256; };
          if (!is_same_tile(at.x, to.x) || !is_same_tile(at.y, to.y) || !is_same_tile(at.z, to.z))
            continue;
          const std::string there = shown_at(build, {to.x, to.y, to.z});
          if (there != here && (there.empty() || there == "water")) ++exposed;
        }
        if (exposed > best) {
          best = exposed;
          out = here;
        }
      }
    }
  }
  return out;
}

FileBuild level_boxes(SplitMix64& rng, VoxelPos sides) {
  struct Box {
    VoxelBox box;
    std::uint16_t number;
  };
  std::vector<Box> boxes = {{{{0, 0, 0}, {1, 1, 1}}, 2}};
  for (int i = 0; i < 60; ++i) {
    const auto pick = [&](std::int32_t side) {
      const auto low = static_cast<std::int32_t>(rng.below(static_cast<std::uint32_t>(side)));
      return std::pair(low, low + 1 + static_cast<std::int32_t>(rng.below(6)));
    };
    const auto x = pick(sides.x), y = pick(sides.y), z = pick(sides.z);
    boxes.push_back({{{x.first, y.first, z.first}, {x.second, y.second, z.second}},
                     static_cast<std::uint16_t>(rng.below(5))});
  }
  FileBuild out = file_build(sides, kLevelMaterials, [&](VoxelPos at) {
    std::uint16_t number = 0;
    for (const Box& box : boxes) {
      if (box.box.contains(at)) number = box.number;
    }
    return number;
  });
  out.info.name = "castle";
  out.info.origin = {5, -6, 7};
  return out;
}

Bytes level_bytes(const std::string& file, const FileBuild& build, const ModelWriting& writing) {
  Bytes out;
  const auto done = write_file_build(file, build,
                                     [&](ByteView bytes) {
                                       out.insert(out.end(), bytes.begin(), bytes.end());
                                       return true;
                                     },
                                     {writing});
  INFO((done ? "" : done.error()));
  REQUIRE(done.has_value());
  return out;
}

WrittenModel gltf_levels(const std::string& ending, const FileBuild& build,
                         const ModelWriting& writing) {
  const Bytes file = level_bytes("castle" + ending, build, writing);
  return ending == ".glb" ? read_written_glb(file) : read_written_gltf(file);
}

/// A model as a set of triangles that can be compared, with places divided by `scale`.
std::vector<std::string> triangle_texts(const WrittenModel& model, double scale) {
  std::vector<std::string> out;
  for (const WrittenTriangle& t : model.triangles) {
    std::string text = t.colour;
    for (const ModelPlace& place : t.places) {
      for (const double v : place) text += " " + std::to_string(v / scale);
    }
    out.push_back(std::move(text));
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("a coarser build follows the rule of tiles", "[model_writers]") {
  SplitMix64 rng(4811);
  const VoxelPos sides[] = {{1, 1, 2},   {7, 5, 3},   {24, 17, 31},
                            {259, 3, 6}, {4, 258, 5}, {3, 4, 257}};
  for (const VoxelPos& each : sides) {
    CAPTURE(each.x, each.y, each.z);
    const FileBuild build = level_boxes(rng, each);
    REQUIRE(can_be_coarser(*build.build));
    const auto coarse = coarser_level(build);
    REQUIRE(coarse.has_value());
    const VoxelPos half = coarse->build->sides();
    CHECK(half == VoxelPos{(each.x + 1) / 2, (each.y + 1) / 2, (each.z + 1) / 2});
    CHECK(coarse->materials.size() == coarse->build->palette().size());
    std::size_t faults = 0;
    for (std::int32_t z = 0; z < half.z; ++z) {
      for (std::int32_t y = 0; y < half.y; ++y) {
        for (std::int32_t x = 0; x < half.x; ++x)
          faults += shown_at(*coarse, {x, y, z}) != coarse_at(build, {x, y, z});
      }
    }
    CHECK(faults == 0);
  }
}

TEST_CASE("a glTF holds each level as it would be written alone", "[model_writers]") {
  SplitMix64 rng(4812);
  for (const VoxelPos& sides : {VoxelPos{24, 17, 30}, VoxelPos{260, 5, 9}}) {
    const FileBuild build = level_boxes(rng, sides);
    for (const std::string ending : {".glb", ".gltf"}) {
      for (const unsigned choice : {0U, 1U, 2U, 4U, 7U}) {
        CAPTURE(ending, choice, sides.x);
        ModelWriting writing;
        writing.is_welded = (choice & 1) == 0;
        writing.closes_t_junctions = (choice & 2) != 0;
        writing.is_quantised = (choice & 4) != 0;
        writing.metres_per_voxel = choice == 7 ? 0.25 : 1;
        const WrittenModel alone = gltf_levels(ending, build, writing);
        CHECK(alone.levels.empty());
        ModelWriting with_levels = writing;
        with_levels.levels = 3;
        const WrittenModel model = gltf_levels(ending, build, with_levels);
        CHECK(triangle_texts(model, 1) == triangle_texts(alone, 1));
        REQUIRE(model.levels.size() == 3);
        FileBuild finer = build;
        for (std::size_t level = 1; level <= 3; ++level) {
          CAPTURE(level);
          auto coarser = coarser_level(finer);
          REQUIRE(coarser.has_value());
          const double width = writing.metres_per_voxel * static_cast<double>(1U << level);
          const WrittenModel& written_level = model.levels[level - 1];
          CHECK(triangle_texts(written_level, width) ==
                triangle_texts(gltf_levels(ending, *coarser, writing), writing.metres_per_voxel));
          finer = *std::move(coarser);
        }
      }
    }
  }
}

TEST_CASE("a coarse level lies over the fine one", "[model_writers]") {
  SplitMix64 rng(4813);
  const FileBuild build = level_boxes(rng, {37, 29, 45});
  ModelWriting writing;
  writing.levels = 4;
  const WrittenModel model = gltf_levels(".glb", build, writing);
  REQUIRE(model.levels.size() == 4);
  const auto bounds = [](const WrittenModel& of) {
    std::array<std::pair<double, double>, 3> out;
    out.fill({1e9, -1e9});
    for (const WrittenTriangle& t : of.triangles) {
      for (const ModelPlace& place : t.places) {
        for (std::size_t i = 0; i < 3; ++i)
          out[i] = {std::min(out[i].first, place[i]), std::max(out[i].second, place[i])};
      }
    }
    return out;
  };
  const auto fine = bounds(model);
  for (std::size_t level = 1; level <= 4; ++level) {
    const auto coarse = bounds(model.levels[level - 1]);
    const double width = static_cast<double>(1U << level);
    for (std::size_t i = 0; i < 3; ++i) {
      CAPTURE(level, i);
      CHECK(coarse[i].first <= fine[i].first);
      CHECK(coarse[i].first > fine[i].first - width);
      CHECK(coarse[i].second >= fine[i].second);
      CHECK(coarse[i].second < fine[i].second + width);
    }
  }
}

TEST_CASE("the levels of a landscape have fewer and fewer triangles", "[model_writers]") {
  SplitMix64 rng(4814);
  std::array<std::uint32_t, 64 * 64> tops{};
  for (std::uint32_t i = 0; i < 64 * 64; ++i)
    tops[i] = 8 + (i % 64) / 4 + (i / 64) / 7 + static_cast<std::uint32_t>(rng.below(3));
  const FileBuild build = file_build({64, 40, 64}, kLevelMaterials, [&](VoxelPos at) {
    const std::uint32_t top = tops[static_cast<std::size_t>(at.x + 64 * at.z)];
    return static_cast<std::uint16_t>(static_cast<std::uint32_t>(at.y) <= top ? 2 : 1);
  });
  ModelWriting writing;
  writing.levels = 4;
  const WrittenModel model = gltf_levels(".glb", build, writing);
  REQUIRE(model.levels.size() == 4);
  std::size_t triangles = model.triangles.size();
  for (const WrittenModel& level : model.levels) {
    CHECK(2 * level.triangles.size() < triangles);
    triangles = level.triangles.size();
  }
}

TEST_CASE("no level follows a single voxel", "[model_writers]") {
  const auto levels_of = [](VoxelPos sides) {
    ModelWriting writing;
    writing.levels = kModelLevelsMax;
    const FileBuild build = file_build(sides, {file_material("stone", "", {9, 9, 9, 255})},
                                       [](VoxelPos) { return std::uint16_t{1}; });
    return gltf_levels(".glb", build, writing).levels.size();
  };
  CHECK(levels_of({1, 1, 1}) == 0);
  CHECK(levels_of({2, 1, 1}) == 1);
  CHECK(levels_of({3, 5, 4}) == 3);
  CHECK(levels_of({4000, 1, 1}) == kModelLevelsMax);
}

TEST_CASE(
    "coarser levels take a shape for a cube if it fills half of its voxel, and else leave it out",
    "[model_writers][shapes]") {
  std::vector<BuildMaterial> materials = {file_material("plant", "", {10, 200, 10, 255}),
                                          file_material("slab", "", {90, 90, 90, 255}),
                                          file_material("stone", "", {50, 50, 50, 255})};
  materials[0].row.shape = {ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  materials[1].row.shape = {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  const auto number = [](VoxelPos at) {
    return static_cast<std::uint16_t>(at.y == 1 ? 3 : at.y > 3 ? 0 : at.x < 4 ? 1 : 2);
  };
  const FileBuild build = file_build({9, 5, 3}, materials, number);
  FileBuild cubes = build;
  cubes.materials[0].row = file_material("air", "", {0, 0, 0, 0}).row;
  cubes.materials[1].row.shape = {};
  ModelWriting writing;
  writing.levels = 2;
  const WrittenModel model = gltf_levels(".glb", build, writing);
  const WrittenModel of_cubes = gltf_levels(".glb", cubes, writing);
  REQUIRE(model.levels.size() == 2);
  CHECK(triangle_texts(model, 1) != triangle_texts(of_cubes, 1));
  for (std::size_t level = 0; level < 2; ++level)
    CHECK(triangle_texts(model.levels[level], 1) == triangle_texts(of_cubes.levels[level], 1));
  const auto coarser = coarser_level(build);
  REQUIRE(coarser.has_value());
  CHECK(triangle_texts(gltf_levels(".glb", *coarser, {}), 0.5) ==
        triangle_texts(model.levels[0], 1));
  const FileBuild plants = file_build({4, 4, 4}, materials, [](VoxelPos) { return 1; });
  CHECK(gltf_levels(".glb", plants, writing).levels.empty());
}

TEST_CASE("levels count for the size of a file", "[model_writers]") {
  // 300,000 separate voxels of 24 vertices, in the next level as many: 280 MB of text each.
  const FileBuild noise =
      file_build({128, 128, 128}, {file_material("stone", "", {1, 2, 3, 255})}, [](VoxelPos at) {
        return static_cast<std::uint16_t>(at.x % 4 == 0 && at.y % 4 == 0 && at.z % 4 == 0 ? 1 : 0);
      });
  auto builder = BuildBuilder::of({grid_cuts(1152, 128), grid_cuts(128, 128), grid_cuts(128, 128)});
  REQUIRE(builder.has_value());
  REQUIRE(builder->number_of(1) == 1);
  const auto cells =
      std::make_shared<const RunChunk>(cells_in(*noise.build, {{0, 0, 0}, {128, 128, 128}}));
  for (std::uint32_t x = 0; x < 9; ++x) REQUIRE(builder->put({x, 0, 0}, cells).has_value());
  const FileBuild build{{}, *builder->finish(), noise.materials};
  const auto error_of = [&](unsigned levels) {
    ModelWriting writing;
    writing.is_welded = false;
    writing.levels = levels;
    const auto done = write_file_build("a.gltf", build, [](ByteView) { return false; }, {writing});
    return done ? "" : done.error();
  };
  CHECK(error_of(0) == "a.gltf: cannot be written");
  CHECK(error_of(1).find("at most 500,000,000 bytes") != std::string::npos);
}

}  // namespace runstone::test
