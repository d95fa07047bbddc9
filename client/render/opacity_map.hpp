// OpacityMap: the opacity bits of all chunks on the GPU, and the table in which a shader finds
// those of a chunk. A shader so reads the voxels beside a face across the borders of chunks, and a
// changed chunk never changes the data of another one.
//   bits    buffer texture R32UI: word 0 has no bit set, word 1 has all; then the words of chunks
//   table   buffer texture RG32UI, an entry for each chunk, at its coordinates modulo kTableSide
//           first word; shifts of x, y and z in the index of a bit (5 bits each), then 1 bit: the
//           chunk has words of its own
// Two chunks that are kTableSide chunks apart share an entry; the newer one has it. Thread: the GL
// thread.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "client/render/opacity_bits.hpp"
#include "client/render/texel_store.hpp"
#include "common/core/coords.hpp"

namespace runstone {

class OpacityMap {
 public:
  static constexpr std::int32_t kTableSide = 64;  // chunks

  OpacityMap();
  /// Replaces the bits of a chunk. Chunks whose edge differs from that of the first chunk are
  /// ignored, as are edges that are no power of two.
  void set(ChunkCoord at, std::int32_t edge, const OpacityBits& bits);
  void remove(ChunkCoord at);

  /// Binds both textures to texture units `unit` and `unit` + 1, and sets the uniforms of
  /// RUNSTONE_OCCLUSION_GLSL. Requires that the program is in use.
  void bind(const GlProgram& program, GLint unit) const;
  std::uint64_t used_bytes() const;

 private:
  struct Entry {
    std::uint32_t first = 0, shifts = 0;
    friend bool operator==(const Entry&, const Entry&) = default;
  };
  struct Slot {
    std::uint32_t first = 0, words = 0;
  };
  static std::size_t place(ChunkCoord at);
  void write(ChunkCoord at, Entry entry);

  TexelStore bits_, table_;
  std::int32_t edge_ = 0;             // of the chunks; 0: none was set
  std::map<ChunkCoord, Slot> slots_;  // every chunk that was set
};

/// float occlusion(vec3 at, vec3 normal): the share of opaque voxels around a place on a face, 0 ..
/// 0.75: the opacity of the voxels in front of the face, interpolated between their middles. `at`
/// lies half a voxel in front of the face, in voxels modulo 8192. It depends on the voxels alone,
/// never on the quad to which the face belongs. The voxel right in front of a visible face is not
/// opaque, so three voxels are read.
#define RUNSTONE_OCCLUSION_GLSL                                                             \
  "uniform usamplerBuffer opacity, opacity_table;\n"                                        \
  "uniform int edge_bits;\n"                                                                \
  "float opaque_at(ivec3 voxel) {\n"                                                        \
  "  ivec3 chunk = (voxel >> edge_bits) & 63;\n"                                            \
  "  uvec2 entry = texelFetch(opacity_table, chunk.x | chunk.y << 6 | chunk.z << 12).xy;\n" \
  "  uvec3 l = uvec3(voxel & ((1 << edge_bits) - 1));\n"                                    \
  "  uint i = l.x << (entry.y & 31u) | l.y << ((entry.y >> 5) & 31u) |\n"                   \
  "           l.z << ((entry.y >> 10) & 31u);\n"                                            \
  "  uint word = texelFetch(opacity, int(entry.x + (i >> 5) * (entry.y >> 15))).x;\n"       \
  "  return float((word >> (i & 31u)) & 1u);\n"                                             \
  "}\n"                                                                                     \
  "float occlusion(vec3 at, vec3 normal) {\n"                                               \
  "  vec3 voxel = floor(at);\n"                                                             \
  "  vec3 from_middle = at - voxel - 0.5;\n"                                                \
  "  vec3 u = abs(normal.zxy), v = abs(normal.yzx);\n"                                      \
  "  float du = dot(from_middle, u), dv = dot(from_middle, v);\n"                           \
  "  ivec3 side_u = ivec3(u) * (du < 0.0 ? -1 : 1);\n"                                      \
  "  ivec3 side_v = ivec3(v) * (dv < 0.0 ? -1 : 1);\n"                                      \
  "  ivec3 here = ivec3(voxel);\n"                                                          \
  "  float a = opaque_at(here + side_u), b = opaque_at(here + side_v);\n"                   \
  "  float c = max(opaque_at(here + side_u + side_v), a * b);\n"                            \
  "  du = abs(du), dv = abs(dv);\n"                                                         \
  "  return a * du * (1.0 - dv) + b * dv * (1.0 - du) + c * du * dv;\n"                     \
  "}\n"

}  // namespace runstone
