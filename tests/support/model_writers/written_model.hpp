// WrittenModel: a plain reader of the models that Runstone writes. It is for tests and shares no
// code with the writers. It checks each rule of the formats that it meets, and throws
// std::runtime_error with the rule that is broken.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"

namespace runstone::test {

using ModelPlace = std::array<double, 3>;

struct WrittenTriangle {
  std::array<ModelPlace, 3> places;
  std::array<std::uint64_t, 3> vertices;  // numbers, different for different vertices of the file
  ModelPlace normal{};
  std::string colour;  // "r g b a", sRGB
  bool is_blended = false;
  bool is_double_sided = false;  // glTF only
};

struct WrittenModel {
  std::vector<WrittenTriangle> triangles;
  std::size_t vertex_count = 0;  // of the whole file
  std::vector<std::string> material_names;
  std::size_t node_count = 0;        // glTF only
  std::vector<WrittenModel> levels;  // coarser ones by MSFT_lod; glTF only
};

WrittenModel read_written_glb(const Bytes& file);
WrittenModel read_written_gltf(const Bytes& file);
/// Takes the .obj and its .mtl.
WrittenModel read_written_obj(const Bytes& obj, const Bytes& mtl);
WrittenModel read_written_ply(const Bytes& file);

}  // namespace runstone::test
