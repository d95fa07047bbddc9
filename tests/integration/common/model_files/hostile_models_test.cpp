// Files and readers that are damaged or made to do harm.
#include <fcntl.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "tests/integration/common/model_files/model_folder_of_test.hpp"
#include "tests/support/core/text_contains.hpp"

using namespace runstone;
using runstone::test::append_number;
using runstone::test::bytes_of;
using runstone::test::contains;
using runstone::test::GltfText;
using runstone::test::ModelFolderOfTest;

namespace {

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";

/// The head of a PNG of 65,535 x 65,535 texels, without any.
std::string huge_png() {
  std::string png("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\xff\xff\0\0\xff\xff\x08\x06\0\0\0", 29);
  return png + "\x5d\x5f\x23\xcd";
}

/// Writes a program of the shell, to be started instead of runstone-read-model.
std::string fake_reader(ModelFolderOfTest& folder, const std::string& script) {
  const std::string path = folder.write("reader.sh", "#!/bin/sh\n" + script + "\n");
  ::chmod(path.c_str(), 0755);
  return path;
}

}  // namespace

TEST_CASE("a file that is no model file is refused by its name and kind", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("a.fbx", "x");
  CHECK(folder.error("a.fbx") == "a.fbx: is no .obj, .stl, .ply, .gltf or .glb");
  CHECK(folder.error("gone.obj") == "gone.obj: cannot be read: No such file or directory");
  ::mkfifo((folder / "pipe.obj").c_str(), 0600);
  CHECK(contains(folder.error("pipe.obj"), "pipe.obj: "));
  std::filesystem::create_directory(folder / "folder.glb");
  CHECK(contains(folder.error("folder.glb"), "folder.glb: "));
  folder.write("empty.stl", "");
  CHECK(contains(folder.error("empty.stl"), "empty.stl: "));
}

TEST_CASE("a model refers to files of its folder only", "[model_files]") {
  ModelFolderOfTest folder;
  std::filesystem::create_directory(folder / "in");
  GltfText gltf;
  folder.write("secret.bin", gltf.buffer());
  std::filesystem::create_symlink(folder / "secret.bin", folder / "in/link.bin");
  ::mkfifo((folder / "in/pipe.bin").c_str(), 0600);
  const auto error_of = [&](const std::string& uri) {
    gltf.buffer_uri = uri;
    folder.write("in/a.gltf", gltf.text());
    return folder.error("in/a.gltf");
  };
  const std::string outside = "which is outside its folder";
  CHECK(error_of("../secret.bin") ==
        "in/a.gltf: refers to \"../secret.bin\", which is outside its folder");
  CHECK(contains(error_of("x/../../secret.bin"), outside));
  CHECK(contains(error_of("..\\\\secret.bin"), outside));
  CHECK(contains(error_of("%2e%2e/secret.bin"), "secret.bin"));
  CHECK(contains(error_of(folder / "secret.bin"), outside));
  CHECK(contains(error_of("/etc/passwd"), outside));
  CHECK(contains(error_of("file:///etc/passwd"), outside));
  CHECK(contains(error_of("https://example.org/a.bin"), outside));
  CHECK(contains(error_of("link.bin"), outside));
  CHECK(contains(error_of("pipe.bin"), "which is no regular file"));
  CHECK(contains(error_of("gone.bin"), "which does not exist"));
}

TEST_CASE("materials and textures outside the folder are left out", "[model_files]") {
  ModelFolderOfTest folder;
  std::filesystem::create_directory(folder / "in");
  folder.write("secret.mtl", "newmtl a\nKd 1 0 0\n");
  folder.write("secret.png", runstone::test::small_png());
  folder.write("in/a.obj", std::string("mtllib ../secret.mtl\n") + kTriangle);
  const ReadModel one = folder.model("in/a.obj");
  REQUIRE_FALSE(one.notices.empty());
  CHECK(contains(one.notices[0], "which is outside its folder"));
  folder.write("in/b.mtl", "newmtl a\nmap_Kd ../secret.png\n");
  folder.write("in/b.obj", std::string("mtllib b.mtl\n") + kTriangle);
  const ReadModel two = folder.model("in/b.obj");
  REQUIRE_FALSE(two.notices.empty());
  CHECK(contains(two.notices[0], "which is outside its folder"));
  CHECK(two.model.textures.empty());
}

TEST_CASE("a texture with a huge head is refused before it is decoded", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("bomb.png", huge_png());
  folder.write("a.mtl", "newmtl a\nmap_Kd bomb.png\n");
  folder.write("a.obj", std::string("mtllib a.mtl\n") + kTriangle);
  CHECK(folder.error("a.obj") ==
        "a.obj: the texture \"bomb.png\" has 65535 x 65535 texels, and at most 16,384 a side are "
        "read");
}

TEST_CASE("corners that are no finite numbers are left out", "[model_files]") {
  ModelFolderOfTest folder;
  std::string stl(80, ' ');
  append_number(stl, std::uint32_t{3});
  for (const float value :
       {1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    stl += bytes_of<float>({0, 0, 0, 0, 0, 0, value, 0, 0, 0, 1, 0});
    append_number(stl, std::uint16_t{0});
  }
  folder.write("a.stl", stl);
  const ReadModel read = folder.model("a.stl");
  CHECK(read.model.triangles.size() == 1);
  CHECK(validate(read.model).has_value());
  CHECK(read.notices == std::vector<std::string>{
                            "triangles with corners that are no finite numbers are left out: 2"});
  folder.write("b.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto b = folder.read("b.obj");
  if (b) CHECK(validate(b->model).has_value());
}

TEST_CASE("indices that name no vertex are refused or left out", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 -9\n");
  folder.write("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  GltfText gltf;
  std::string glb = gltf.glb();
  glb[glb.size() - 4] = '\x09';  // the last index
  folder.write("a.glb", glb);
  for (const char* name : {"a.obj", "a.ply", "a.glb"}) {
    CAPTURE(name);
    const auto read = folder.read(name);
    if (read) CHECK(validate(read->model).has_value());
    if (!read) CHECK_FALSE(contains(read.error(), "sent no sound model"));
  }
}

TEST_CASE("huge counts end with a line", "[model_files]") {
  ModelFolderOfTest folder;
  ModelFileOptions options;
  options.memory_mib = 256;
  std::string stl(80, ' ');
  append_number(stl, std::uint32_t{0xffffffff});
  folder.write("a.stl", stl + std::string(100, ' '));
  folder.write("a.ply",
               "ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty float x\n"
               "property float y\nproperty float z\nelement face 4294967295\n"
               "property list uint uint vertex_indices\nend_header\n0000");
  GltfText gltf;
  std::string text = gltf.text();
  for (std::size_t at; (at = text.find("\"count\":3")) != std::string::npos;)
    text.replace(at, 9, "\"count\":4294967295");
  folder.write("a.gltf", text);
  folder.write("a.obj", "v 0 0 0\nf 1 1 99999999999999999999\n");
  for (const char* name : {"a.stl", "a.ply", "a.gltf", "a.obj"}) {
    CAPTURE(name);
    const auto read = folder.read(name, options);
    if (!read) {
      UNSCOPED_INFO(read.error());
      CHECK_FALSE(contains(read.error(), "sent no sound model"));
    }
  }
}

#ifndef RUNSTONE_SANITIZED
TEST_CASE("a file that needs more memory than allowed is refused", "[model_files]") {
  ModelFolderOfTest folder;
  std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 400'000; ++i) obj += "f 1 2 3\n";
  folder.write("a.obj", obj);
  ModelFileOptions options;
  options.memory_mib = 96;
  CHECK(folder.error("a.obj", options) == "a.obj: needs more than 96 MiB of memory");
  CHECK(folder.read("a.obj").has_value());
}
#endif

TEST_CASE("instances count against the limit of triangles", "[model_files]") {
  ModelFolderOfTest folder;
  GltfText gltf;
  gltf.nodes = R"({"children":[1)";
  for (int i = 2; i <= 200; ++i) gltf.nodes += "," + std::to_string(i);
  gltf.nodes += "]}";
  for (int i = 1; i <= 200; ++i) gltf.nodes += R"(,{"mesh":0})";
  folder.write("a.gltf", gltf.text());
  CHECK(folder.model("a.gltf").model.triangles.size() == 200);
  ModelFileOptions options;
  options.triangles_max = 199;
  CHECK(folder.error("a.gltf", options) ==
        "a.gltf: the file has 200 triangles, and at most 199 are allowed");
}

TEST_CASE("nodes that contain themselves, and towers of nodes, end with a line", "[model_files]") {
  ModelFolderOfTest folder;
  GltfText gltf;
  ModelFileOptions options;
  options.memory_mib = 512;
  options.time_max = std::chrono::seconds(20);
  SECTION("a circle") { gltf.nodes = R"({"mesh":0,"children":[0]})"; }
#ifndef RUNSTONE_SANITIZED  // memory has no limit then
  SECTION("2^40 instances of few nodes") {
    gltf.nodes = R"({"children":[1,1]})";
    for (int i = 2; i <= 40; ++i) {
      const std::string next = std::to_string(i);
      gltf.nodes += R"(,{"children":[)" + next + "," + next + "]}";
    }
    gltf.nodes += R"(,{"mesh":0})";
  }
#endif
  folder.write("a.gltf", gltf.text());
  const auto read = folder.read("a.gltf", options);
  REQUIRE_FALSE(read.has_value());
  CHECK(contains(read.error(), "a.gltf: "));
}

TEST_CASE("cut files of each format end with a model or a line", "[model_files]") {
  ModelFolderOfTest folder;
  GltfText gltf;
  std::string stl(80, ' ');
  append_number(stl, std::uint32_t{2});
  stl += bytes_of<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + std::string(2, '\0');
  stl += bytes_of<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + std::string(2, '\0');
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
      bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + '\x03' + bytes_of<std::int32_t>({0, 1, 2});
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.glb", gltf.glb()},
      {"a.gltf", gltf.text()},
      {"b.stl", stl},
      {"c.ply", ply},
      {"d.obj", std::string(kTriangle) + "f 1/1 2/1 3/1 1/1 2/1\n"},
      {"e.stl",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
       "endloop\nendfacet\nendsolid a\n"},
      {"f.ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
       "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}};
  for (const auto& [name, whole] : files) {
    REQUIRE(folder.read((folder.write(name, whole), name)).has_value());
    for (std::size_t i = 1; i <= 12; ++i) {
      const std::size_t size = whole.size() * i / 13;
      CAPTURE(name, size);
      folder.write(name, whole.substr(0, size));
      const auto read = folder.read(name);
      if (read) continue;
      UNSCOPED_INFO(read.error());
      CHECK_FALSE(contains(read.error(), "sent no sound model"));
    }
  }
}

TEST_CASE("names and texts of a file control no terminal", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("a.mtl", "newmtl a\x1b[31m\xff\nmap_Kd \x1b[31m.png\n");
  folder.write("a.obj",
               "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\x1b[31m\xff\n"
               "f 1/1 2/1 3/1\n");
  const ReadModel read = folder.model("a.obj");
  CHECK(validate(read.model).has_value());
  for (const std::string& notice : read.notices) CHECK_FALSE(contains(notice, "\x1b"));
}

TEST_CASE("a reader that does not end is killed", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("a.obj", kTriangle);
  ModelFileOptions options;
  options.time_max = std::chrono::milliseconds(300);
  SECTION("that writes nothing") {
    options.program = fake_reader(folder, "exec sleep 1000");
    CHECK(folder.error("a.obj", options) == "a.obj: took longer than 300 ms");
  }
  SECTION("that closes its output") {
    options.program = fake_reader(folder, "exec sleep 1000 >&- 2>&-");
    CHECK(folder.error("a.obj", options) == "a.obj: took longer than 300 ms");
  }
  SECTION("that is not wanted any more") {
    options.time_max = std::chrono::hours(1);
    options.program = fake_reader(folder, "exec sleep 1000");
    options.should_continue = [] { return false; };
    CHECK(folder.error("a.obj", options) == "a.obj: is not wanted any more");
  }
}

TEST_CASE("what a reader sends is not trusted", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("a.obj", kTriangle);
  ModelFileOptions options;
  const auto error_of = [&](const std::string& script) {
    options.program = fake_reader(folder, script);
    return folder.error("a.obj", options);
  };
  CHECK(error_of("yes") == "a.obj: its reader sent no sound model: the bytes are no model");
  CHECK(error_of("exit 0") == "a.obj: its reader ended with exit code 0 without a model");
  CHECK(error_of("exit 7") == "a.obj: its reader ended with exit code 7 without a model");
  CHECK(contains(error_of("kill -SEGV $$"), "a.obj: its reader was ended by signal 11"));
  CHECK(error_of("printf 'odd\\033[1m words\\nmore' >&2; exit 2") == "a.obj: odd?[1m words");
  CHECK(error_of("exit 2") == "a.obj: cannot be read");
  // Endless errors fill no memory, and are cut.
  CHECK(error_of("yes aaaaaaaaaaaaaaaaaaaaaaa | head -c 3000000 | tr -d '\\n' >&2; exit 2").size() <
        1100);
  const std::string real = RUNSTONE_READ_MODEL_PROGRAM;
  CHECK(error_of("'" + real + "' \"$@\"; echo more") ==
        "a.obj: its reader sent no sound model: bytes are left over");
  CHECK(error_of("'" + real + "' \"$@\"; exit 3") ==
        "a.obj: its reader ended with exit code 3 without a model");
  options.program = folder / "gone";
  CHECK(contains(folder.error("a.obj", options), "cannot be started: No such file or directory"));
}

TEST_CASE("a name that begins with a dash is a name", "[model_files]") {
  ModelFolderOfTest folder;
  folder.write("-h.obj", kTriangle);
  ModelFileOptions options;
  options.program = RUNSTONE_READ_MODEL_PROGRAM;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  const auto read = read_model_file("-h.obj", options);
  std::filesystem::current_path(before);
  INFO((read ? std::string() : read.error()));
  CHECK(read.has_value());
}
