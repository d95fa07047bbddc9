// runstone-read-model reads glTF whose vertices have integers (KHR_mesh_quantization).
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "common/build_files/build_files.hpp"
#include "common/shapes/shape_kinds.hpp"
#include "tests/integration/common/model_files/model_folder_of_test.hpp"
#include "tests/support/formats/file_builds.hpp"

using namespace runstone;
using runstone::test::append_number;
using runstone::test::base64;
using runstone::test::bytes_of;
using runstone::test::ModelFolderOfTest;

namespace {

using Places = std::vector<std::array<float, 3>>;

/// A triangle of integers whose vertices have eight bytes: three numbers of 16 bits, and two more
/// bytes. The indices follow. The members can be changed.
struct QuantisedText {
  std::string bytes = bytes_of<std::int16_t>({-3, 0, 7, 99, 32767, 0, 0, 99, 0, -32768, 16, 99}) +
                      bytes_of<std::uint16_t>({0, 1, 2, 0});
  std::string accessor =
      R"("bufferView":0,"componentType":5122,"count":3,"type":"VEC3","min":[-3,-32768,0],)"
      R"("max":[32767,0,16])";
  std::string view = R"("buffer":0,"byteLength":24,"byteStride":8)";
  std::string attributes = R"("POSITION":0)";
  std::string more;
  std::string json(const std::string& uri_member) const {
    return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_mesh_quantization"],)"
           R"("extensionsRequired":["KHR_mesh_quantization"],"scene":0,"scenes":[{"nodes":[0]}],)"
           R"("nodes":[{"mesh":0}],"buffers":[{)" +
           uri_member + R"("byteLength":)" + std::to_string(bytes.size()) +
           R"(}],"bufferViews":[{)" + view +
           R"(},{"buffer":0,"byteOffset":24,"byteLength":6}],"accessors":[{)" + accessor +
           R"(},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],)"
           R"("meshes":[{"primitives":[{"attributes":{)" +
           attributes + R"(},"indices":1}]}])" + more + "}";
  }
  std::string text() const {
    return json(R"("uri":"data:application/octet-stream;base64,)" + base64(bytes) + R"(",)");
  }
  std::string glb() const {
    std::string text = json("");
    while (text.size() % 4 != 0) text.push_back(' ');
    std::string out = "glTF";
    append_number(out, std::uint32_t{2});
    append_number(out, static_cast<std::uint32_t>(28 + text.size() + bytes.size()));
    append_number(out, static_cast<std::uint32_t>(text.size()));
    out += "JSON" + text;
    append_number(out, static_cast<std::uint32_t>(bytes.size()));
    return out + std::string("BIN\0", 4) + bytes;
  }
};

/// The corners of the triangles with their colours, in an order that does not depend on the file.
std::vector<std::tuple<Places, ModelColour>> sorted_triangles(const Model& model) {
  std::vector<std::tuple<Places, ModelColour>> out;
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    Places places;
    for (const std::uint32_t v : model.triangles[i]) places.push_back(model.positions[v]);
    std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
    out.emplace_back(places, model.materials[model.material_of[i]].colour);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("a quantised model has the triangles of a plain one", "[model_files]") {
  std::vector<BuildMaterial> materials = {
      test::file_material("stone", "", {120, 121, 122, 255}),
      test::file_material("stairs", "facing=east", {200, 10, 3, 255}),
      test::file_material("plant", "", {10, 200, 10, 255}),
      test::file_material("water", "", {10, 40, 250, 100})};
  materials[1].row.shape = shape_of_kind("stairs", "facing=east").value();
  materials[2].row.shape = shape_of_kind("plant", "").value();
  SplitMix64 rng(4831);
  const bool has_shapes = GENERATE(false, true);
  const FileBuild build = test::file_build({131, 4, 9}, materials, [&](VoxelPos) {
    if (rng.below(3) != 0) return std::uint16_t{0};
    return static_cast<std::uint16_t>(has_shapes ? 1 + rng.below(4) : rng.below(2) == 0 ? 1U : 4U);
  });
  ModelFolderOfTest folder;
  for (const std::string ending : {".glb", ".gltf"}) {
    CAPTURE(ending, has_shapes);
    FileWriting writing;
    writing.model.metres_per_voxel = 0.5;
    REQUIRE(write_build_to_file(folder / ("plain" + ending), build, writing).has_value());
    writing.model.is_quantised = true;
    REQUIRE(write_build_to_file(folder / ("small" + ending), build, writing).has_value());
    const ReadModel small = folder.model("small" + ending);
    CHECK(small.notices.empty());
    CHECK(small.model.metres_per_unit == 1.0);
    const auto triangles = sorted_triangles(small.model);
    CHECK(triangles.size() > 1000);
    CHECK(triangles == sorted_triangles(folder.model("plain" + ending).model));
  }
}

TEST_CASE("integers of each type become places, wherever their buffer lies", "[model_files]") {
  ModelFolderOfTest folder;
  QuantisedText gltf;
  folder.write("a.gltf", gltf.text());
  folder.write("a.glb", gltf.glb());
  folder.write("b.gltf", gltf.json(R"("uri":"a%20b.bin",)"));
  folder.write("a b.bin", gltf.bytes);
  for (const char* name : {"a.gltf", "a.glb", "b.gltf"}) {
    CAPTURE(name);
    CHECK(folder.model(name).model.positions == Places{{-3, 0, 7}, {32767, 0, 0}, {0, -32768, 16}});
  }
  gltf.accessor += R"(,"normalized":true)";
  folder.write("a.glb", gltf.glb());
  // -32768 is -1, as -32767 is.
  CHECK(folder.model("a.glb").model.positions ==
        Places{{-3 / 32767.0F, 0, 7 / 32767.0F}, {1, 0, 0}, {0, -1, 16 / 32767.0F}});
  const auto with_type = [&](int type, bool is_normalised, const std::string& places) {
    QuantisedText other;
    other.bytes = places + other.bytes.substr(24);
    other.accessor = R"("bufferView":0,"count":3,"type":"VEC3","componentType":)" +
                     std::to_string(type) + R"(,"normalized":)" +
                     (is_normalised ? "true" : "false");
    folder.write("c.glb", other.glb());
    return folder.model("c.glb").model.positions;
  };
  const std::string bytes("\0\1\2\0\0\0\0\0\xff\3\4\0\0\0\0\0\5\x80\6\0\0\0\0\0", 24);
  CHECK(with_type(5121, false, bytes) == Places{{0, 1, 2}, {255, 3, 4}, {5, 128, 6}});
  CHECK(with_type(5121, true, bytes)[1] == std::array<float, 3>{1, 3 / 255.0F, 4 / 255.0F});
  CHECK(with_type(5120, false, bytes) == Places{{0, 1, 2}, {-1, 3, 4}, {5, -128, 6}});
  CHECK(with_type(5120, true, bytes)[2] == std::array<float, 3>{5 / 127.0F, -1, 6 / 127.0F});
  const std::string words = bytes_of<std::uint16_t>({0, 1, 2, 0, 65535, 3, 4, 0, 5, 6, 7, 0});
  CHECK(with_type(5123, false, words) == Places{{0, 1, 2}, {65535, 3, 4}, {5, 6, 7}});
  CHECK(with_type(5123, true, words)[1] == std::array<float, 3>{1, 3 / 65535.0F, 4 / 65535.0F});
}

TEST_CASE("a file that requires quantisation and has floats is read", "[model_files]") {
  ModelFolderOfTest folder;
  runstone::test::GltfText gltf;
  gltf.more = R"(,"extensionsRequired":["KHR_mesh_quantization"])";
  folder.write("a.gltf", gltf.text());
  folder.write("a.glb", gltf.glb());
  for (const char* name : {"a.gltf", "a.glb"})
    CHECK(folder.model(name).model.positions == Places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("hostile quantised files end with a line", "[model_files]") {
  ModelFolderOfTest folder;
  const auto error_of = [&](const auto& change) {
    QuantisedText gltf;
    change(gltf);
    folder.write("a.gltf", gltf.text());
    folder.write("a.glb", gltf.glb());
    const std::string line = folder.error("a.gltf");
    CHECK(line.substr(7) == folder.error("a.glb").substr(6));
    CHECK(line.find("sent no sound model") == std::string::npos);
    return line.substr(8);
  };
  const std::string damaged = "cannot be read: its JSON is none of glTF, or damaged";
  const std::string outside = "has quantised numbers outside of their buffer";
  const auto with_accessor = [&](const std::string& members) {
    return error_of([&](QuantisedText& gltf) { gltf.accessor = members; });
  };
  const std::string vector = R"("componentType":5122,"type":"VEC3","bufferView":0,)";
  CHECK(with_accessor(vector + R"("count":4)") == outside);
  CHECK(with_accessor(vector + R"("count":3,"byteOffset":4)") == outside);
  CHECK(with_accessor(vector + R"("count":1099511627776)") == outside);
  CHECK(with_accessor(vector + R"("count":18446744073709551615)") == damaged);
  CHECK(with_accessor(vector + R"("count":-1)") == damaged);
  CHECK(with_accessor(vector + R"("count":0)") == damaged);
  CHECK(with_accessor(vector + R"("count":"3")") == damaged);
  CHECK(with_accessor(vector + R"("count":3,"normalized":7)") == damaged);
  CHECK(with_accessor(R"("componentType":5122,"type":"VEC3","count":3,"bufferView":9)") == damaged);
  CHECK(with_accessor(R"("componentType":5122,"type":"VEC9","count":3,"bufferView":0)") == damaged);
  CHECK(with_accessor(R"("componentType":5125,"type":"VEC3","count":2,"bufferView":0)") ==
        "a place, normal or texture place has numbers of another kind");
  const std::string sparse =
      "has quantised numbers that are sparse or compressed: export the model without them";
  CHECK(with_accessor(R"("componentType":5122,"type":"VEC3","count":3)") == sparse);
  CHECK(with_accessor(vector + R"("count":3,"sparse":{})") == sparse);
  const auto with_view = [&](const std::string& members) {
    return error_of([&](QuantisedText& gltf) { gltf.view = members; });
  };
  const std::string early = "ends early: a buffer has too few bytes";
  CHECK(with_view(R"("buffer":0,"byteLength":24,"byteStride":0)") == damaged);
  CHECK(with_view(R"("buffer":0,"byteLength":24,"byteStride":4)") == damaged);
  CHECK(with_view(R"("buffer":0,"byteLength":9999,"byteStride":9999)") == damaged);
  CHECK(with_view(R"("buffer":0,"byteLength":23,"byteStride":12)") == outside);
  CHECK(with_view(R"("buffer":7,"byteLength":24)") == "a buffer does not exist");
  CHECK(with_view(R"("buffer":0,"byteOffset":1099511627776,"byteLength":24)") == early);
  CHECK(with_view(R"("buffer":0,"byteOffset":20,"byteLength":24)") == early);
  CHECK(error_of([](QuantisedText& gltf) { gltf.attributes = R"("POSITION":5)"; }) == damaged);
  CHECK(error_of([](QuantisedText& gltf) { gltf.attributes = R"("POSITION":[])"; }) == damaged);
  CHECK(error_of([](QuantisedText& gltf) {
          gltf.more = R"(,"extras":)" + std::string(100'000, '[') + std::string(100'000, ']');
        }) == damaged);
  CHECK(error_of([](QuantisedText& gltf) { gltf.more = ",,"; }) == damaged);
}

TEST_CASE("a quantised file cannot ask for more floats than allowed", "[model_files]") {
  // 3,000 accessors of the same 131,000 places: 4.7 GB of floats of 786 KB.
  QuantisedText gltf;
  constexpr int kCount = 131'000;
  const std::string places(6 * kCount, '\1');
  gltf.bytes = gltf.bytes.substr(0, 30) + places;
  std::string accessors, attributes;
  for (int i = 0; i < 3000; ++i) {
    accessors +=
        R"(},{"bufferView":2,"componentType":5122,"type":"VEC3","count":)" + std::to_string(kCount);
    attributes += (i == 0 ? "\"TEXCOORD_" : ",\"TEXCOORD_") + std::to_string(i) +
                  "\":" + std::to_string(i + 2);
  }
  std::string text = gltf.text();
  const auto insert = [&](const std::string& before, const std::string& what) {
    text.insert(text.find(before), what);
  };
  insert(R"(}],"meshes")", accessors);
  insert(R"(}],"accessors")",
         R"(},{"buffer":0,"byteOffset":30,"byteLength":)" + std::to_string(places.size()));
  insert(R"(},"indices")", "," + attributes);
  ModelFolderOfTest folder;
  folder.write("a.gltf", text);
  CHECK(folder.error("a.gltf") ==
        "a.gltf: has too many quantised numbers: export the model without KHR_mesh_quantization");
}
