#include "common/model_writers/model_writers.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <tuple>

#include "common/builds/build_builder.hpp"
#include "common/formats/file_build.hpp"
#include "tests/support/formats/file_builds.hpp"
#include "tests/support/model_writers/model_checks.hpp"
#include "tests/support/model_writers/written_model.hpp"

namespace runstone::test {
namespace {

const std::vector<std::string>& kModelEndings = model_endings_written();

const std::vector<BuildMaterial> kModelMaterials = {
    file_material("air", "", {0, 0, 0, 0}), file_material("stone", "", {120, 121, 122, 255}),
    file_material("red bricks", "", {200, 10, 3, 255}),
    file_material("water", "", {10, 40, 250, 100}),
    file_material("glass", "half=top", {240, 250, 255, 50})};

std::uint16_t random_number(SplitMix64& rng, std::uint16_t count) {
  return static_cast<std::uint16_t>(rng.below(count + 1U));
}

/// Returns boxes of materials 0 (untouched) .. `count`.
FileBuild model_boxes(SplitMix64& rng, VoxelPos sides, std::uint16_t first, std::uint16_t count) {
  struct Box {
    VoxelBox box;
    std::uint16_t number;
  };
  std::vector<Box> boxes = {{{{0, 0, 0}, {1, 1, 1}}, 2}};
  for (int i = 0; i < 40; ++i) {
    const auto pick = [&](std::int32_t side) {
      const auto low = static_cast<std::int32_t>(rng.below(static_cast<std::uint32_t>(side)));
      const auto length = static_cast<std::int32_t>(
          1 + rng.below(static_cast<std::uint32_t>(std::min(side - low, 1 + side / 3))));
      return std::pair(low, low + length);
    };
    const auto x = pick(sides.x), y = pick(sides.y), z = pick(sides.z);
    const bool is_hole = rng.below(4) == 0;
    const auto number =
        static_cast<std::uint16_t>(is_hole ? 0 : first + rng.below(count - first + 1U));
    boxes.push_back({{{x.first, y.first, z.first}, {x.second, y.second, z.second}}, number});
  }
  return file_build(sides, kModelMaterials, [&](VoxelPos at) {
    std::uint16_t number = 0;
    for (const Box& box : boxes) {
      if (box.box.contains(at)) number = box.number;
    }
    return number;
  });
}

}  // namespace

TEST_CASE("one voxel is twelve triangles in every format", "[model_writers]") {
  const FileBuild build = file_build({1, 1, 1}, {file_material("stone", "", {9, 200, 77, 255})},
                                     [](VoxelPos) { return std::uint16_t{1}; });
  for (const std::string& ending : kModelEndings) {
    CAPTURE(ending);
    const WrittenModel model = model_of(ending, build);
    CHECK(model.triangles.size() == 12);
    CHECK(model.vertex_count == (ending == ".obj" ? 8U : 24U));
    check_faces(build, model);
    CHECK(open_edges_by_place(model) == 0);
  }
}

TEST_CASE("a model covers each exposed face once, with all choices", "[model_writers]") {
  SplitMix64 rng(4801);
  const VoxelPos sides[] = {{7, 5, 3}, {129, 3, 5}, {6, 130, 2}, {2, 5, 131}, {40, 20, 30}};
  for (const VoxelPos& each : sides) {
    const bool is_noise = each.x == 7 || each.x == 129;
    const FileBuild build =
        is_noise ? file_build(each, kModelMaterials,
                              [&](VoxelPos at) {
                                return at == VoxelPos{} ? std::uint16_t{2} : random_number(rng, 5);
                              })
                 : model_boxes(rng, each, 1, 5);
    for (const std::string& ending : kModelEndings) {
      for (const unsigned choice : {0U, 1U, 2U, 3U, 4U, 7U}) {
        CAPTURE(ending, choice, each.x, each.y, each.z);
        ModelWriting writing;
        writing.is_welded = (choice & 1) == 0;
        writing.closes_t_junctions = (choice & 2) != 0;
        writing.is_quantised = (choice & 4) != 0;
        writing.metres_per_voxel = choice == 3 ? 0.25 : choice == 7 ? 0.1 : 1;
        check_faces(build, model_of(ending, build, writing), writing.metres_per_voxel);
      }
    }
  }
}

TEST_CASE("with closed T-junctions every edge of a solid build meets its opposite",
          "[model_writers]") {
  SplitMix64 rng(4802);
  const VoxelPos sides[] = {{20, 20, 20}, {140, 9, 133}, {130, 131, 5}};
  std::size_t open_before = 0;
  for (const VoxelPos& each : sides) {
    const FileBuild build = model_boxes(rng, each, 2, 3);  // opaque materials and holes
    open_before += open_edges_by_place(model_of(".glb", build));
    for (const bool is_welded : {true, false}) {
      ModelWriting writing;
      writing.closes_t_junctions = true;
      writing.is_welded = is_welded;
      for (const std::string& ending : kModelEndings) {
        CAPTURE(ending, is_welded, each.x);
        const WrittenModel model = model_of(ending, build, writing);
        CHECK(open_edges_by_place(model) == 0);
        if (ending == ".obj" && is_welded) CHECK(open_edges_by_vertex(model) == 0);
      }
    }
  }
  CHECK(open_before > 0);  // otherwise the test shows nothing
}

TEST_CASE("equal places share a vertex if vertices are welded, and none otherwise",
          "[model_writers]") {
  SplitMix64 rng(4803);
  const FileBuild build = model_boxes(rng, {30, 20, 40}, 1, 5);
  ModelWriting split;
  split.is_welded = false;
  for (const std::string ending : {".glb", ".ply"}) {
    const WrittenModel welded = model_of(ending, build), apart = model_of(ending, build, split);
    CHECK(welded.triangles.size() == apart.triangles.size());
    CHECK(apart.vertex_count == 2 * apart.triangles.size());
    std::set<std::tuple<ModelPlace, ModelPlace, std::string>> different;
    for (const WrittenTriangle& t : welded.triangles) {
      for (const ModelPlace& place : t.places) different.insert({place, t.normal, t.colour});
    }
    CHECK(welded.vertex_count == different.size());
  }
  const WrittenModel obj = model_of(".obj", build);
  std::set<ModelPlace> places;
  for (const WrittenTriangle& t : obj.triangles) places.insert(t.places.begin(), t.places.end());
  CHECK(obj.vertex_count == places.size());
}

TEST_CASE("transparent materials are blended and come after opaque ones", "[model_writers]") {
  const FileBuild build = file_build({3, 1, 1}, kModelMaterials, [](VoxelPos at) {
    return static_cast<std::uint16_t>(at.x == 0 ? 4 : at.x == 1 ? 2 : 5);
  });
  const WrittenModel model = model_of(".glb", build);
  check_faces(build, model);
  // The stone shows its faces to water and glass, and they show none to it.
  std::vector<bool> is_blended;
  for (const WrittenTriangle& t : model.triangles) is_blended.push_back(t.is_blended);
  CHECK(std::is_sorted(is_blended.begin(), is_blended.end()));
  CHECK(std::count(is_blended.begin(), is_blended.end(), false) == 12);
  CHECK(std::count(is_blended.begin(), is_blended.end(), true) == 20);
  CHECK(model.material_names == std::vector<std::string>{"stone", "water", "glass[half=top]"});
}

TEST_CASE("names of an .obj are words, and all different", "[model_writers]") {
  const std::vector<BuildMaterial> materials = {
      file_material("a b", "", {1, 0, 0, 255}), file_material("a_b", "", {2, 0, 0, 255}),
      file_material("#a\tb\"\\", "", {3, 0, 0, 255}), file_material("a b_2", "", {4, 0, 0, 255})};
  const FileBuild build = file_build(
      {4, 1, 1}, materials, [](VoxelPos at) { return static_cast<std::uint16_t>(at.x + 1); });
  for (const std::string& ending : kModelEndings) check_faces(build, model_of(ending, build));
  CHECK(model_of(".glb", build).material_names ==
        std::vector<std::string>{"a b", "a_b", "#a\tb\"\\", "a b_2"});
}

TEST_CASE("a model has as many materials as a build", "[model_writers]") {
  std::vector<BuildMaterial> materials;
  for (unsigned i = 0; i < 65'535; ++i) {
    materials.push_back(
        file_material("m" + std::to_string(i), "",
                      {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 7, 255}));
  }
  const FileBuild build = file_build({257, 1, 255}, materials, [](VoxelPos at) {
    return static_cast<std::uint16_t>(at.x + 257 * at.z + 1);
  });
  const WrittenModel model = model_of(".glb", build);
  CHECK(model.material_names.size() == 65'535);
  check_faces(build, model);
  check_faces(build, model_of(".obj", build));
}

TEST_CASE("far voxels of a long build are at their places", "[model_writers]") {
  auto builder =
      BuildBuilder::of({grid_cuts(kBuildSideMax, 128), grid_cuts(1, 128), grid_cuts(1, 128)});
  REQUIRE(builder.has_value());
  REQUIRE(builder->number_of(7) == 1);
  const SectionPos last{static_cast<std::uint32_t>(kBuildSideMax / 128 - 1), 0, 0};
  REQUIRE(builder->put(last, uniform_chunk({128, 1, 1}, 1)).has_value());
  FileBuild build{{}, *builder->finish(), {file_material("stone", "", {1, 2, 3, 255})}};
  build.info.name = "far";
  build.info.origin = {-kWorldLimit, 5, kWorldLimit - 1};
  for (const std::string& ending : kModelEndings) {
    CAPTURE(ending);
    const WrittenModel model = model_of(ending, build);
    CHECK(model.triangles.size() == 12);
    double low = 1e9, high = 0;
    for (const WrittenTriangle& t : model.triangles) {
      for (const ModelPlace& place : t.places) {
        low = std::min(low, place[0]);
        high = std::max(high, place[0]);
      }
    }
    CHECK(low == kBuildSideMax - 128);
    CHECK(high == kBuildSideMax);
  }
  const Bytes glb = model_bytes("far.glb", build, {});
  const std::string text(glb.begin(), glb.end());
  CHECK(text.find(R"("origin":[-536870912,5,536870911])") != std::string::npos);
}

TEST_CASE("a part with more than 65,535 vertices has long indices", "[model_writers]") {
  const FileBuild build =
      file_build({64, 8, 64}, {file_material("stone", "", {1, 2, 3, 255})},
                 [](VoxelPos at) { return static_cast<std::uint16_t>((at.x + at.y + at.z) % 2); });
  for (const bool is_quantised : {false, true}) {
    ModelWriting writing;
    writing.is_quantised = is_quantised;
    check_faces(build, model_of(".glb", build, writing));
  }
}

TEST_CASE("a build without faces is refused before anything is written", "[model_writers]") {
  const FileBuild build = file_build({3, 3, 3}, {file_material("air", "", {0, 0, 0, 0})},
                                     [](VoxelPos) { return std::uint16_t{1}; });
  for (const std::string& ending : kModelEndings) {
    const auto done = write_file_build("x" + ending, build, [](ByteView) {
      FAIL("bytes were written");
      return true;
    });
    REQUIRE_FALSE(done.has_value());
    CHECK(done.error() == "x" + ending + ": model: build shows no face");
  }
}

TEST_CASE("a sink that fails ends the writing", "[model_writers]") {
  SplitMix64 rng(4804);
  const FileBuild build = model_boxes(rng, {300, 40, 60}, 1, 5);
  for (const std::string& ending : kModelEndings) {
    CAPTURE(ending);
    int calls = 0;
    static_cast<void>(write_file_build("x" + ending, build, [&](ByteView) {
      ++calls;
      return true;
    }));
    for (int fails_at = 0; fails_at < calls; ++fails_at) {
      int call = 0;
      const auto done =
          write_file_build("x" + ending, build, [&](ByteView) { return call++ != fails_at; });
      CHECK_FALSE(done.has_value());
      CHECK(call == fails_at + 1);
    }
  }
  CHECK_FALSE(write_companion("x.obj", build, [](ByteView) { return false; }).has_value());
}

TEST_CASE("the sections of a build do not change the faces of its model", "[model_writers]") {
  SplitMix64 rng(4805);
  const FileBuild build = model_boxes(rng, {60, 70, 80}, 1, 5);
  auto builder = BuildBuilder::of({grid_cuts(60, 17, 3), grid_cuts(70, 128), grid_cuts(80, 32)});
  REQUIRE(builder.has_value());
  for (const Material material : build.build->palette())
    static_cast<void>(builder->number_of(material));
  for (std::uint32_t z = 0; z + 1 < builder->cuts()[2].size(); ++z) {
    for (std::uint32_t x = 0; x + 1 < builder->cuts()[0].size(); ++x) {
      const auto& cuts = builder->cuts();
      const VoxelBox box{{cuts[0][x], 0, cuts[2][z]}, {cuts[0][x + 1], 70, cuts[2][z + 1]}};
      REQUIRE(builder->put({x, 0, z}, cells_in(*build.build, box)).has_value());
    }
  }
  const FileBuild other{build.info, *builder->finish(), build.materials};
  ModelWriting writing;
  writing.closes_t_junctions = true;
  for (const std::string& ending : kModelEndings)
    check_faces(other, model_of(ending, other, writing));
}

}  // namespace runstone::test
