// The file for shaders, compiled as C++. This test defines the types and functions of GLSL that the
// file uses. So the checked text is the text that shaders include.
#include <catch2/catch.hpp>
#include <cstdint>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include "bindings/c/runstone.h"
#include "common/core/hash.hpp"
#include "common/mesh/occlusion/quad_occlusion.hpp"

namespace runstone::test {
namespace glsl {

using uint = std::uint32_t;
struct uvec2 {
  uint x, y;
};
struct uvec3 {
  uint x = 0, y = 0, z = 0;
};
struct vec3 {
  vec3(double of_x, double of_y, double of_z) : x(of_x), y(of_y), z(of_z) {}
  double x, y, z;
};
#include "bindings/c/runstone_quads.glsl"

}  // namespace glsl

namespace {

/// Returns the constants of a file, such as "const uint NAME = 7u;" or "NAME = 7,".
std::map<std::string, int> quad_constants(const char* file) {
  std::map<std::string, int> out;
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR "/bindings/c/") + file);
  const std::regex pattern("(RUNSTONE_QUAD_[A-Z]+_(SHIFT|BITS)) = ([0-9]+)");
  for (std::string line; std::getline(in, line);) {
    std::smatch found;
    if (std::regex_search(line, found, pattern)) out[found[1]] = std::stoi(found[3]);
  }
  return out;
}

}  // namespace

TEST_CASE("the file for shaders and the header have one table of the fields of quads",
          "[c_interface]") {
  const auto header = quad_constants("runstone.h");
  CHECK(header.size() == 16);
  CHECK(header == quad_constants("runstone_quads.glsl"));
}

TEST_CASE("the file for shaders unpacks what the mesher packs", "[c_interface]") {
  SplitMix64 rng{91};
  bool same = true;
  for (int i = 0; i < 4000; ++i) {
    QuadFields fields;
    fields.x = static_cast<std::uint8_t>(rng.below(128));
    fields.y = static_cast<std::uint8_t>(rng.below(128));
    fields.z = static_cast<std::uint8_t>(rng.below(128));
    fields.width = static_cast<std::uint8_t>(1 + rng.below(128));
    fields.height = static_cast<std::uint8_t>(1 + rng.below(128));
    fields.direction = static_cast<Direction>(rng.below(6));
    fields.material = static_cast<Material>(rng.below(65536));
    fields.face = static_cast<std::uint16_t>(rng.below(1024));
    const Quad quad = pack(fields);
    const glsl::RunstoneQuad q = glsl::runstone_unpack(
        {static_cast<std::uint32_t>(quad.bits), static_cast<std::uint32_t>(quad.bits >> 32)});
    same = same && q.voxel.x == fields.x && q.voxel.y == fields.y && q.voxel.z == fields.z &&
           q.width == fields.width && q.height == fields.height &&
           q.direction == static_cast<std::uint32_t>(fields.direction) &&
           q.material == fields.material && q.face == fields.face;
    const auto corners = quad_corners(quad);
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      const glsl::vec3 at = glsl::runstone_corner(q, corner);
      same = same && at.x == corners[corner][0] && at.y == corners[corner][1] &&
             at.z == corners[corner][2];
    }
    const glsl::vec3 normal = glsl::runstone_normal(q.direction);
    const double sign = is_positive(fields.direction) ? 1 : -1;
    const Axis axis = axis_of(fields.direction);
    same = same && normal.x == (axis == Axis::x ? sign : 0) &&
           normal.y == (axis == Axis::y ? sign : 0) && normal.z == (axis == Axis::z ? sign : 0);
  }
  CHECK(same);
}

TEST_CASE("the file for shaders draws the triangles of the indices", "[c_interface]") {
  constexpr std::uint32_t kIndices[] = {0, 1, 2, 0, 2, 3};
  bool same = true;
  for (unsigned corners = 0; corners < 256; ++corners) {
    const auto of = static_cast<CornerOcclusion>(corners);
    for (std::uint32_t i = 0; i < 6; ++i) {
      same = same && glsl::runstone_triangle_corner(i) == kIndices[i] &&
             glsl::runstone_occluded_corner(corners, i) == (kIndices[i] + first_corner(of)) % 4;
    }
    for (std::uint32_t corner = 0; corner < 4; ++corner)
      same = same && glsl::runstone_occlusion(corners, corner) == occlusion_of(of, corner);
  }
  CHECK(same);
}

}  // namespace runstone::test
