#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/conformance/vectors/vector_file.hpp"

// The files that the conformance kit gives to writers of other clients. Each is what the library
// makes: a change here is a change of a format. `runstone-conformance vectors
// tests/conformance/files` writes them.
namespace runstone::test {
namespace {

std::string kept_file(const std::string& name) {
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/tests/conformance/files/" + name,
                   std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

const conformance::VectorFile& file_named(const std::vector<conformance::VectorFile>& files,
                                          const std::string& name) {
  for (const conformance::VectorFile& file : files) {
    if (file.name == name) return file;
  }
  throw std::out_of_range(name);
}

}  // namespace

TEST_CASE("the vectors of the conformance kit are what the library makes",
          "[conformance][golden]") {
  for (const conformance::VectorFile& file : conformance::vector_files()) {
    CAPTURE(file.name);
    CHECK(conformance::difference(file, kept_file(file.name)).value_or("") == "");
  }
}

TEST_CASE("vectors that were changed are found", "[conformance][golden]") {
  const auto files = conformance::vector_files();
  const auto check = [&](const char* name, const std::string& from, const std::string& to) {
    std::string text = kept_file(name);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    CAPTURE(name, from);
    CHECK(conformance::difference(file_named(files, name), text).has_value());
  };
  check("chunks.json", "95fe3d9fa0", "95fe3d9fa1");
  check("edits.json", "\"voxels_changed\":1", "\"voxels_changed\":2");
  check("borders.json", "[256,0]", "[256,1]");
  check("tiles.json", "\"tile_rules\": 2", "\"tile_rules\": 3");
  check("handshake.json", "d0b130d0", "d0b130d1");
  check("handshake.json", "\"kind\":2", "\"kind\":3");
  // A message that means something else: another name of the player.
  check("handshake.json", "52656ec3a9", "52656ec3aa");
  check("handshake.json", "{", "");
}

}  // namespace runstone::test
