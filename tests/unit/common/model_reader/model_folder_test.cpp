#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "common/model_reader/folder_files.hpp"
#include "common/model_reader/gltf_buffers.hpp"
#include "common/model_reader/gltf_extensions.hpp"
#include "common/model_reader/model_folder.hpp"
#include "common/model_reader/scene_materials.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;

TEST_CASE("a path stays within the folder or is none", "[model_reader]") {
  CHECK(path_within("a.mtl") == "a.mtl");
  CHECK(path_within("./a//b/./c.png") == "a/b/c.png");
  CHECK(path_within("a\\b.png") == "a/b.png");
  CHECK(path_within("a/../b.png") == "b.png");
  CHECK(path_within("..png") == "..png");
  for (const char* path :
       {"", ".", "..", "../a", "a/../../b", "..\\a", "/etc/passwd", "\\\\host\\a", "C:\\a.png",
        "c:a.png", "file:///etc/passwd", "https://example.org/a"}) {
    CAPTURE(path);
    CHECK(path_within(path).empty());
  }
  CHECK(path_within(std::string_view("a\0b", 3)).empty());
}

TEST_CASE("a folder of a model opens its regular files and nothing else", "[model_reader]") {
  test::TempFolder temp;
  std::filesystem::create_directories(temp / "in/deep");
  std::ofstream(temp / "outside.txt") << "secret";
  std::ofstream(temp / "in/model.obj") << "v 0 0 0";
  std::ofstream(temp / "in/deep/a.png") << "12345";
  std::filesystem::create_symlink("deep/a.png", temp / "in/within.png");
  std::filesystem::create_symlink("../outside.txt", temp / "in/out.txt");
  std::filesystem::create_symlink(temp / "outside.txt", temp / "in/far.txt");
  std::filesystem::create_directory_symlink("..", temp / "in/up");
  ::mkfifo((temp / "in/pipe").c_str(), 0600);
  const auto folder = ModelFolder::of_file(temp / "in/model.obj");
  REQUIRE(folder.has_value());
  CHECK(folder->name() == "model.obj");
  const auto opened = folder->open("deep/a.png");
  REQUIRE(opened.has_value());
  CHECK(opened->bytes() == 5);
  std::string text(8, '\0');
  CHECK(opened->read(text.data(), text.size(), 2) == 3);
  CHECK(text.substr(0, 3) == "345");
  using Refusal = ModelFolder::Refusal;
  const auto refusal = [&folder](const char* path) {
    const auto file = folder->open(path);
    REQUIRE_FALSE(file.has_value());
    return file.error();
  };
  CHECK(refusal("out.txt") == Refusal::outside);
  CHECK(refusal("far.txt") == Refusal::outside);
  CHECK(refusal("up/outside.txt") == Refusal::outside);
  CHECK(refusal("../outside.txt") == Refusal::outside);
  CHECK(refusal("pipe") == Refusal::not_a_file);
  CHECK(refusal("deep") == Refusal::not_a_file);
  CHECK(refusal("gone") == Refusal::missing);
  CHECK(refusal("model.obj/x") == Refusal::missing);
  CHECK_FALSE(ModelFolder::of_file(temp / "in/gone.obj").has_value());
}

TEST_CASE("addresses of a .gltf are decoded", "[model_reader]") {
  CHECK(percent_decoded("a%20b.bin") == "a b.bin");
  CHECK(percent_decoded("%2e%2E/a") == "../a");
  CHECK(percent_decoded("100%") == "100%");
  CHECK(percent_decoded("%zz%4") == "%zz%4");
  CHECK(percent_decoded("%41") == "A");
}

TEST_CASE("required extensions are found in the text of a .gltf", "[model_reader]") {
  CHECK(required_extensions("{}").empty());
  CHECK(required_extensions(R"({"extensionsRequired" : [ "A", "B" ]})") ==
        std::vector<std::string>{"A", "B"});
  CHECK(required_extensions(R"({"extensionsRequired":["A)").empty());
  CHECK(required_extensions(R"({"extensionsRequired")").empty());
}

TEST_CASE("base64 is decoded with and without padding", "[model_reader]") {
  CHECK(base64_decoded("") == "");
  CHECK(base64_decoded("/+8=") == "\xff\xef");
  CHECK(base64_decoded("/+8") == "\xff\xef");
  CHECK(base64_decoded("YWJj") == "abc");
  CHECK(base64_decoded("YWJjZA==") == "abcd");
  CHECK_FALSE(base64_decoded("YW Jj").has_value());
  CHECK_FALSE(base64_decoded("=YWJj").has_value());
}

TEST_CASE("numbers of colours become bytes", "[model_reader]") {
  CHECK(unit_byte(0) == 0);
  CHECK(unit_byte(0.5F) == 128);
  CHECK(unit_byte(7) == 255);
  CHECK(unit_byte(-1) == 0);
  CHECK(unit_byte(std::numeric_limits<float>::quiet_NaN()) == 0);
  CHECK(srgb_byte(0) == 0);
  CHECK(srgb_byte(0.2F) == 124);
  CHECK(srgb_byte(0.001F) == 3);
  CHECK(srgb_byte(1) == 255);
}
