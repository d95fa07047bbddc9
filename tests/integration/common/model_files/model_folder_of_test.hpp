// ModelFolderOfTest: a folder with files of models for one test, and the reader of them.
#pragma once
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/model_files/model_file.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

/// Appends the bytes of a number.
template <class Number>
void append_number(std::string& to, Number number) {
  std::array<char, sizeof number> bytes;
  std::memcpy(bytes.data(), &number, sizeof number);  // the machines of the tests are little-endian
  to.append(bytes.data(), bytes.size());
}
template <class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  std::string out;
  for (const Number number : numbers) append_number(out, number);
  return out;
}

inline std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out.push_back(i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63]);
  }
  return out;
}

/// A PNG of 2 x 1 texels: opaque red, and green with alpha 100.
inline std::string small_png() {
  constexpr unsigned char kBytes[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
      0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0xf4,
      0x22, 0x7f, 0x8a, 0x00, 0x00, 0x00, 0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8,
      0xcf, 0xc0, 0xf0, 0x1f, 0x08, 0x53, 0x00, 0x10, 0x5d, 0x03, 0x62, 0x0c, 0x56, 0x48, 0xe2,
      0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  return {reinterpret_cast<const char*>(kBytes), sizeof kBytes};
}

/// The bytes of a .gltf with one triangle of positions (0, 0, 0), (1, 0, 0), (0, 1, 0).
/// `nodes`: of the scene, whose root is node 0, and mesh 0 is the triangle. `more`: further members,
/// each with a comma before it. `attributes`, `primitive`: further members of the primitive.
struct GltfText {
  std::string nodes = R"({"mesh":0})";
  std::string more, attributes, primitive, views, accessors, buffer_uri, extra_bytes;

  static std::string triangle_bytes() {
    return bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + bytes_of<std::uint16_t>({0, 1, 2, 0});
  }
  std::string buffer() const { return triangle_bytes() + extra_bytes; }
  std::string text() const {
    const std::string uri = !buffer_uri.empty()
                                ? buffer_uri
                                : "data:application/octet-stream;base64," + base64(buffer());
    return json(R"("uri":")" + uri + R"(",)");
  }
  std::string json(const std::string& uri_member) const {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
           R"(],"buffers":[{)" + uri_member + R"("byteLength":)" + std::to_string(buffer().size()) +
           R"(}],"bufferViews":[{"buffer":0,"byteLength":36},)"
           R"({"buffer":0,"byteOffset":36,"byteLength":6})" +
           views +
           R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
           R"("min":[0,0,0],"max":[1,1,0]},)"
           R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"})" +
           accessors + R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0)" + attributes +
           R"(},"indices":1)" + primitive + "}]}]" + more + "}";
  }
  std::string glb() const {
    std::string text = json("");
    while (text.size() % 4 != 0) text.push_back(' ');
    std::string bin = buffer();
    while (bin.size() % 4 != 0) bin.push_back('\0');
    std::string out = "glTF";
    append_number(out, std::uint32_t{2});
    append_number(out, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bin.size()));
    append_number(out, static_cast<std::uint32_t>(text.size()));
    out += "JSON" + text;
    append_number(out, static_cast<std::uint32_t>(bin.size()));
    out += "BIN";
    out.push_back('\0');
    return out + bin;
  }
};

class ModelFolderOfTest {
 public:
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  std::string operator/(const std::string& name) const { return folder_ / name; }

  Result<ReadModel, std::string> read(const std::string& name,
                                      ModelFileOptions options = {}) const {
    if (options.program.empty()) options.program = RUNSTONE_READ_MODEL_PROGRAM;
    return read_model_file(folder_ / name, options);
  }
  ReadModel model(const std::string& name, ModelFileOptions options = {}) const {
    auto read_one = read(name, std::move(options));
    INFO((read_one ? std::string() : read_one.error()));
    REQUIRE(read_one.has_value());
    return *std::move(read_one);
  }
  /// Returns the error without the folder.
  std::string error(const std::string& name, ModelFileOptions options = {}) const {
    const auto read_one = read(name, std::move(options));
    REQUIRE_FALSE(read_one.has_value());
    const std::string line = read_one.error();
    CHECK(line.find('\n') == std::string::npos);
    const std::string prefix = folder_.path() + "/";
    REQUIRE(line.substr(0, prefix.size()) == prefix);
    return line.substr(prefix.size());
  }

 private:
  TempFolder folder_;
};

}  // namespace runstone::test
