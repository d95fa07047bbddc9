// runstone-read-model reads each format: places, colours, textures and transforms.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/integration/common/model_files/model_folder_of_test.hpp"

using namespace runstone;
using runstone::test::append_number;
using runstone::test::bytes_of;
using runstone::test::GltfText;
using runstone::test::ModelFolderOfTest;
using runstone::test::small_png;

namespace {

using Corner = std::array<float, 3>;
using Corners = std::array<Corner, 3>;

/// Returns the corners of a triangle, the least corner first, in their order.
Corners corners(const Model& model, std::size_t triangle) {
  Corners out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = model.positions[model.triangles[triangle][k]];
  std::size_t least = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (out[k] < out[least]) least = k;
  }
  return {out[least], out[(least + 1) % 3], out[(least + 2) % 3]};
}

ModelMaterial material_of(const Model& model, std::size_t triangle) {
  REQUIRE(triangle < model.material_of.size());
  return model.materials[model.material_of[triangle]];
}

std::string binary_stl(const std::vector<float>& numbers) {
  std::string out(80, ' ');
  append_number(out, static_cast<std::uint32_t>(numbers.size() / 9));
  for (std::size_t i = 0; i < numbers.size(); i += 9) {
    out += bytes_of<float>({0, 0, 0});
    for (std::size_t k = 0; k < 9; ++k) append_number(out, numbers[i + k]);
    append_number(out, std::uint16_t{0});
  }
  return out;
}

constexpr const char* kPlyHead =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 3\nproperty float x\n"
    "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
    "property uchar blue\n";

}  // namespace

TEST_CASE("an .obj has triangles, polygons, colours of its .mtl and textures", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("wood.png", small_png());
  folder.write("house.mtl",
               "newmtl red\nKd 1 0.5 0\nd 0.2\nnewmtl wood\nKd 0.1 0.1 0.1\nmap_Kd wood.png\n");
  folder.write("house.obj",
               "mtllib house.mtl\nv 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
               "usemtl red\nf 1 2 3 4\nusemtl wood\nf -4/1 -3/2 -2/3\n");
  const ReadModel read = folder.model("house.obj");
  const Model& model = read.model;
  CHECK(read.notices.empty());
  REQUIRE(model.triangles.size() == 3);
  CHECK_FALSE(model.metres_per_unit.has_value());
  std::size_t red = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ModelMaterial material = material_of(model, i);
    if (material.name == "red") {
      ++red;
      CHECK(material.colour == ModelColour{255, 128, 0, 51});
      CHECK_FALSE(material.texture.has_value());
      continue;
    }
    CHECK(material.name == "wood");
    CHECK(material.colour == ModelColour{255, 255, 255, 255});
    REQUIRE(material.texture == 0U);
    CHECK(corners(model, i) == Corners{Corner{0, 0, 0}, {2, 0, 0}, {2, 3, 0}});
    for (const std::uint32_t v : model.triangles[i]) {
      // The v of an .obj counts from below.
      CHECK(model.texture_places[v][0] == model.positions[v][0] / 2);
      CHECK(model.texture_places[v][1] == 1 - model.positions[v][1] / 3);
    }
  }
  CHECK(red == 2);
  REQUIRE(model.textures.size() == 1);
  CHECK(model.textures[0].width == 2);
  CHECK(model.textures[0].height == 1);
  CHECK(model.textures[0].texels == std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 100});
}

TEST_CASE("an .obj without its .mtl or a texture is read, with notices", "[model_files]") {
  ModelFolderOfTest folder;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
  SECTION("without an .mtl") {
    folder.write("a.obj", "mtllib gone.mtl\n" + triangle);
    const ReadModel read = folder.model("a.obj");
    CHECK(read.notices ==
          std::vector<std::string>{"the file refers to \"gone.mtl\", which does not "
                                   "exist: it is left out"});
    for (const ModelMaterial& material : read.model.materials)
      CHECK(material.colour == ModelColour{255, 255, 255, 255});
  }
  SECTION("without an .mtl that is named in several ways") {
    // The first name is that of the model, for which the parser looks in any case.
    for (const std::string name :
         {"a.mtl", "./gone.mtl", "b/gone.mtl", "b\\\\gone.mtl", "../gone.mtl"}) {
      CAPTURE(name);
      folder.write("a.obj", "mtllib " + name + "\n" + triangle + "mtllib " + name + "\n");
      const ReadModel read = folder.model("a.obj");
      REQUIRE(read.notices.size() == 1);
      CHECK(read.notices[0].find("the file refers to \"" + name + "\", which ") == 0);
    }
    folder.write("a.obj", "mtllib one.mtl\nmtllib two.mtl\n" + triangle);
    CHECK(folder.model("a.obj").notices.size() == 2);
  }
  SECTION("with an .mtl that has got the name of the model") {
    folder.write("a.mtl", "newmtl a\nKd 0 1 0\n");
    folder.write("a.obj", "mtllib before.mtl\n" + triangle);
    const ReadModel read = folder.model("a.obj");
    CHECK(read.notices.size() == 1);
    CHECK(material_of(read.model, 0).colour == ModelColour{0, 255, 0, 255});
  }
  SECTION("without a texture") {
    folder.write("a.mtl", "newmtl a\nKd 0 1 0\nmap_Kd gone.png\n");
    folder.write("a.obj", "mtllib a.mtl\n" + triangle);
    const ReadModel read = folder.model("a.obj");
    CHECK(read.notices == std::vector<std::string>{
                              "the texture \"gone.png\", which does not exist, is left out: its "
                              "material is plain"});
    CHECK(material_of(read.model, 0).colour == ModelColour{0, 255, 0, 255});
  }
  SECTION("with the texture's path of another machine") {
    folder.write("wood.png", small_png());
    folder.write("a.mtl", "newmtl a\nmap_Kd C:\\models\\wood.png\n");
    folder.write("a.obj", "mtllib a.mtl\n" + triangle);
    const ReadModel read = folder.model("a.obj");
    CHECK(read.notices.empty());
    CHECK(read.model.textures.size() == 1);
  }
  SECTION("with a texture of another kind") {
    folder.write("a.png", "RIFF    WEBP");
    folder.write("a.mtl", "newmtl a\nmap_Kd a.png\n");
    folder.write("a.obj", "mtllib a.mtl\n" + triangle);
    const ReadModel read = folder.model("a.obj");
    CHECK(read.notices.size() == 1);
    CHECK(read.model.textures.empty());
  }
}

TEST_CASE("an .obj may have colours of vertices, or points alone", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  const Model a = folder.model("a.obj").model;
  CHECK(a.materials.empty());
  REQUIRE(a.colours.size() == 3);
  CHECK(a.colours[a.triangles[0][0]] == ModelColour{255, 0, 0, 255});
  folder.write("b.obj", "v 0 0 0\nv 1 2 3\nv 0 1 0\n");
  const Model b = folder.model("b.obj").model;
  CHECK(b.is_cloud());
  CHECK(b.positions.size() == 3);
}

TEST_CASE("an .stl is read as text and as bytes, with z up", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("text.stl",
               "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 5\nvertex 1 0 5\n"
               "vertex 0 2 5\nendloop\nendfacet\nendsolid part\n");
  folder.write("bytes.stl", binary_stl({0, 0, 5, 1, 0, 5, 0, 2, 5}));
  // x stays, z becomes y, and y, which leads to the back, becomes -z.
  const Corners expected = {Corner{0, 5, -2}, {0, 5, 0}, {1, 5, 0}};
  for (const char* name : {"text.stl", "bytes.stl"}) {
    CAPTURE(name);
    const ReadModel read = folder.model(name);
    CHECK(read.notices.empty());
    REQUIRE(read.model.triangles.size() == 1);
    CHECK(read.model.materials.empty());
    CHECK(corners(read.model, 0) == expected);
  }
  ModelFileOptions options;
  options.up = ModelUp::y;
  CHECK(corners(folder.model("bytes.stl", options).model, 0) ==
        Corners{Corner{0, 0, 5}, {1, 0, 5}, {0, 2, 5}});
}

TEST_CASE("a .ply is read as text and as bytes of both orders", "[model_files]") {
  ModelFolderOfTest folder;
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  folder.write("text.ply",
               kPlyHead + faces + "0 0 5 255 0 0\n1 0 5 0 128 0\n0 2 5 0 0 1\n3 0 1 2\n");
  for (const bool is_little : {true, false}) {
    std::string head = kPlyHead + faces;
    head.replace(head.find("ascii"), 5, is_little ? "binary_little_endian" : "binary_big_endian");
    std::string body;
    const auto number = [&body, is_little](auto value) {
      std::string bytes;
      append_number(bytes, value);
      body += is_little ? bytes : std::string(bytes.rbegin(), bytes.rend());
    };
    const std::vector<std::array<float, 3>> places = {{0, 0, 5}, {1, 0, 5}, {0, 2, 5}};
    const std::string colours("\xff\0\0\0\x80\0\0\0\x01", 9);
    for (std::size_t v = 0; v < 3; ++v) {
      for (const float value : places[v]) number(value);
      body += colours.substr(3 * v, 3);
    }
    body += '\x03';
    for (const std::int32_t index : {0, 1, 2}) number(index);
    folder.write(is_little ? "little.ply" : "big.ply", head + body);
  }
  for (const char* name : {"text.ply", "little.ply", "big.ply"}) {
    CAPTURE(name);
    const Model model = folder.model(name).model;
    REQUIRE(model.triangles.size() == 1);
    CHECK(corners(model, 0) == Corners{Corner{0, 5, -2}, {0, 5, 0}, {1, 5, 0}});
    REQUIRE(model.colours.size() == 3);
    CHECK(model.colours[0] == ModelColour{255, 0, 0, 255});
    CHECK(model.colours[1] == ModelColour{0, 128, 0, 255});
    CHECK(model.colours[2] == ModelColour{0, 0, 1, 255});
    CHECK(model.materials.empty());
  }
}

TEST_CASE("a .ply without faces is a cloud of points", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("cloud.ply", kPlyHead + std::string("end_header\n0 0 5 255 0 0\n"
                                                   "nan 0 0 1 1 1\n1 2 3 0 0 255\n"));
  const ReadModel read = folder.model("cloud.ply");
  CHECK(read.model.is_cloud());
  CHECK(read.model.positions == std::vector<Corner>{{0, 5, 0}, {1, 3, -2}});
  CHECK(read.model.colours == std::vector<ModelColour>{{255, 0, 0, 255}, {0, 0, 255, 255}});
  CHECK(read.notices ==
        std::vector<std::string>{"points whose places are no finite numbers are left out: 1"});
}

TEST_CASE("a .gltf and a .glb have nodes, instances and metres", "[model_files]") {
  ModelFolderOfTest folder;
  GltfText gltf;
  // Two instances: one moved, and one mirrored along x, below a node that doubles.
  gltf.nodes = R"({"children":[1,2],"scale":[2,2,2]},{"mesh":0,"translation":[10,0,0]},)"
               R"({"mesh":0,"scale":[-1,1,1]})";
  folder.write("a.gltf", gltf.text());
  folder.write("a.glb", gltf.glb());
  gltf.buffer_uri = "a%20b.bin";
  folder.write("b.gltf", gltf.text());
  folder.write("a b.bin", gltf.buffer());
  for (const char* name : {"a.gltf", "a.glb", "b.gltf"}) {
    CAPTURE(name);
    const ReadModel read = folder.model(name);
    CHECK(read.notices.empty());
    CHECK(read.model.metres_per_unit == 1.0);
    REQUIRE(read.model.triangles.size() == 2);
    std::vector<Corners> all = {corners(read.model, 0), corners(read.model, 1)};
    if (all[1] < all[0]) std::swap(all[0], all[1]);
    // The mirrored one is turned, so that it still faces +z.
    CHECK(all[0] == Corners{Corner{-2, 0, 0}, {0, 0, 0}, {0, 2, 0}});
    CHECK(all[1] == Corners{Corner{20, 0, 0}, {22, 0, 0}, {20, 2, 0}});
  }
}

TEST_CASE("the colours of a .gltf are linear and become those of sRGB", "[model_files]") {
  ModelFolderOfTest folder;
  GltfText gltf;
  gltf.extra_bytes = bytes_of<float>({0.5F, 0, 1, 0, 0, 0, 1, 1, 1});
  gltf.views = R"(,{"buffer":0,"byteOffset":44,"byteLength":36})";
  gltf.accessors = R"(,{"bufferView":2,"componentType":5126,"count":3,"type":"VEC3"})";
  gltf.attributes = R"(,"COLOR_0":2)";
  gltf.primitive = R"(,"material":0)";
  gltf.more =
      R"(,"materials":[{"name":"lamp","pbrMetallicRoughness":{"baseColorFactor":[0.2,1,0,0.5]}}])";
  folder.write("a.glb", gltf.glb());
  const Model model = folder.model("a.glb").model;
  REQUIRE(model.colours.size() == 3);
  CHECK(model.colours[0] == ModelColour{188, 0, 255, 255});
  CHECK(material_of(model, 0).name == "lamp");
  CHECK(material_of(model, 0).colour == ModelColour{124, 255, 0, 255});  // OPAQUE
}

TEST_CASE("textures of a .gltf come from files, addresses and buffers", "[model_files]") {
  ModelFolderOfTest folder;
  GltfText gltf;
  gltf.extra_bytes = bytes_of<float>({0, 0, 1, 0, 0, 0.25F}) + small_png();
  gltf.views = R"(,{"buffer":0,"byteOffset":44,"byteLength":24},{"buffer":0,"byteOffset":68,)"
               R"("byteLength":)" +
               std::to_string(small_png().size()) + "}";
  gltf.accessors = R"(,{"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"})";
  gltf.attributes = R"(,"TEXCOORD_0":2)";
  gltf.primitive = R"(,"material":0)";
  const std::string image =
      GENERATE(as<std::string>(), R"({"bufferView":3,"mimeType":"image/png"})",
               R"({"uri":"a%20b.png"})", R"({"uri":"DATA"})");
  const std::string mode = GENERATE(as<std::string>(), "OPAQUE", "BLEND", "MASK");
  CAPTURE(image, mode);
  std::string images = image;
  if (const std::size_t at = images.find("DATA"); at != std::string::npos)
    images.replace(at, 4, "data:image/png;base64," + runstone::test::base64(small_png()));
  gltf.more = R"(,"images":[)" + images +
              R"(],"textures":[{"source":0}],"materials":[{"alphaMode":")" + mode +
              R"(","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  folder.write("a.gltf", gltf.text());
  folder.write("a b.png", small_png());
  const ReadModel read = folder.model("a.gltf");
  const Model& model = read.model;
  CHECK(read.notices.empty());
  REQUIRE(model.textures.size() == 1);
  CHECK(material_of(model, 0).texture == 0U);
  CHECK(model.texture_places == std::vector<std::array<float, 2>>{{0, 0}, {1, 0}, {0, 0.25F}});
  const int alpha = mode == "OPAQUE" ? 255 : mode == "MASK" ? 0 : 100;
  CHECK(model.textures[0].texels ==
        std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, static_cast<std::uint8_t>(alpha)});
}

TEST_CASE("what is left out of a .gltf is said", "[model_files]") {
  ModelFolderOfTest folder;
  GltfText gltf;
  gltf.extra_bytes = bytes_of<float>({0, 1, 0, 0, 0, 1, 0, 0});
  gltf.views =
      R"(,{"buffer":0,"byteOffset":44,"byteLength":8},{"buffer":0,"byteOffset":52,"byteLength":24})";
  gltf.accessors =
      R"(,{"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},)"
      R"({"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"})";
  gltf.more =
      R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],)"
      R"("samplers":[{"input":2,"output":3}]}])";
  folder.write("a.gltf", gltf.text());
  const ReadModel read = folder.model("a.gltf");
  CHECK(read.model.triangles.size() == 1);
  CHECK(read.notices == std::vector<std::string>{
                            "animations are left out: the model stands as the file places it"});
}

TEST_CASE("a mesh that is compressed with Draco is read", "[model_files]") {
  ModelFolderOfTest folder;
  // One triangle, written by the encoder of Draco 1.5 (sequential, 14 bits).
  folder.write(
      "a.gltf",
      R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_draco_mesh_compression"],)"
      R"("extensionsRequired":["KHR_draco_mesh_compression"],"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0,)"
      R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]}],)"
      R"("accessors":[{"componentType":5123,"count":3,"type":"SCALAR"},)"
      R"({"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":66}],"buffers":[{"byteLength":66,)"
      R"("uri":"data:application/octet-stream;base64,)"
      "RFJBQ08CAgEAAAABAwEAAQIBAQAJAwAAAgABAQADA60qVRUDoHqBiAEAAAAA/z8AAAAAAAAAAAAAAAAAAAAAgD8O"
      R"("}]})");
  const Model model = folder.model("a.gltf").model;
  REQUIRE(model.triangles.size() == 1);
  const Corners expected = {Corner{0, 0, 0}, Corner{1, 0, 0}, Corner{0, 1, 0}};
  const Corners got = corners(model, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) CHECK(got[i][k] == Approx(expected[i][k]).margin(0.001));
  }
}

TEST_CASE("a .gltf that requires an unknown extension is refused", "[model_files]") {
  ModelFolderOfTest folder;
  GltfText gltf;
  gltf.more = R"(,"extensionsRequired":["KHR_materials_unlit"])";
  folder.write("a.gltf", gltf.text());
  CHECK(folder.model("a.gltf").model.triangles.size() == 1);
  gltf.more = R"(,"extensionsRequired" : [ "KHR_materials_unlit","EXT_meshopt_compression" ])";
  folder.write("a.gltf", gltf.text());
  folder.write("a.glb", gltf.glb());
  for (const std::string name : {"a.gltf", "a.glb"}) {
    CHECK(folder.error(name) == name +
                                    ": requires the extension \"EXT_meshopt_compression\" of "
                                    "glTF, which is not read: export the model without "
                                    "compression, or with that of Draco");
  }
  gltf.more = R"(,"extensionsRequired":["KHR_texture_basisu"])";
  folder.write("a.glb", gltf.glb());
  CHECK(folder.error("a.glb") ==
        "a.glb: requires the extension \"KHR_texture_basisu\" of glTF, which is not read: export "
        "the model with textures of PNG or JPEG");
  gltf.more = R"(,"extensionsRequired":["X_Y\u001b"])";
  folder.write("a.glb", gltf.glb());
  CHECK(folder.error("a.glb").find("export the model without it") != std::string::npos);
}

TEST_CASE("a symbolic link to a model is followed", "[model_files]") {
  ModelFolderOfTest folder;
  std::filesystem::create_directory(folder / "real");
  folder.write("real/a.mtl", "newmtl a\nKd 0 1 0\n");
  folder.write("real/a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  std::filesystem::create_symlink(folder / "real/a.obj", folder / "link.obj");
  const ReadModel read = folder.model("link.obj");
  CHECK(read.notices.empty());
  CHECK(material_of(read.model, 0).colour == ModelColour{0, 255, 0, 255});
}

TEST_CASE("files named by the model may lie in folders below", "[model_files]") {
  ModelFolderOfTest folder;
  std::filesystem::create_directory(folder / "parts");
  folder.write("parts/a.mtl", "newmtl a\nmap_Kd parts\\sub\\..\\wood.png\n");
  folder.write("parts/wood.png", small_png());
  folder.write(
      "a.obj",
      "mtllib ./parts/a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
  const ReadModel read = folder.model("a.obj");
  CHECK(read.notices.empty());
  CHECK(read.model.textures.size() == 1);
}
