// The occlusion of the corners of quads: how much the opaque voxels around a corner darken it. The
// rule is the usual one of worlds of cubes. At each corner of a face three voxels lie before the
// face: two beside the voxel before it, and one diagonal to that. The occlusion of the corner is
//   - 3 if both voxels beside are opaque;
//   - otherwise the number of opaque voxels among the three, 0 .. 2.
//
// A quad stands for many faces, so it is cut where its four corners would give a face other values.
// Then the values stand in the vertices, and no texture and no special shader is needed. On real
// worlds this makes 1.7 times as many quads. A texture of masks would not cut quads, but every
// program that draws would have to read it at each pixel.
//
// Two facts keep the cuts cheap. All faces that meet at a point of the plane before them see the
// same four voxels there, so the occlusion is a property of the point. The voxels before the faces
// of a quad are not opaque, so points inside a quad have the occlusion 0, and only the rim is read.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/occlusion/opaque_bits.hpp"
#include "common/mesh/quad_corners.hpp"

namespace runstone {

inline constexpr unsigned kOcclusionMax = 3;

/// The occlusion of the four corners of a quad: two bits each, in the order of quad_corners(), the
/// first one lowest.
using CornerOcclusion = std::uint8_t;

constexpr unsigned occlusion_of(CornerOcclusion corners, std::size_t corner) {
  return corners >> (2 * corner) & 3U;
}

/// Quads of one pass, each with the occlusion of its corners.
struct OccludedQuads {
  QuadLayers quads;
  std::vector<CornerOcclusion> corners;  // by quad
  void clear() {
    quads.clear();
    corners.clear();
  }
};

/// Replaces `out` by the quads of cubes of one pass, cut so that each of their faces has the
/// occlusion of its own corners if the values of the quad's corners are interpolated over it. The
/// parts of a quad stay together, and in its layer. Requires that `bits` were read from the chunk
/// of the mesh, from the chunks with which it was meshed, and with the same visibility. Thread:
/// any. Allocates only to grow. Cost: O(rims of the quads).
void occlude_quads(const QuadLayers& quads, const OpaqueBits& bits, OccludedQuads& out);

/// Returns the corner of a quad at which its first triangle begins: 0, or 1 so that the diagonal
/// joins the two opposite corners that are less dark together. Both diagonals interpolate equally
/// along the edges. But if the diagonal did not follow the values, a single dark corner would
/// darken one triangle or two, depending on its place. The triangles are
/// (c, c + 1, c + 2) and (c, c + 2, c + 3), modulo 4.
constexpr std::size_t first_corner(CornerOcclusion corners) {
  return occlusion_of(corners, 0) + occlusion_of(corners, 2) >
                 occlusion_of(corners, 1) + occlusion_of(corners, 3)
             ? 1
             : 0;
}

}  // namespace runstone
