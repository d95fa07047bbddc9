// runstone_quads.glsl: unpacks the quads of 8 bytes of Runstone in a shader, GLSL 1.30 or ES 3.00
// and later. Include it behind the line #version. A quad is a uvec2: its low 32 bits, then its high
// ones, as runstone_mesh_quads() writes them on machines whose lowest byte comes first.
//
// A vertex shader draws six vertices a quad, of which vertex i is
//   RunstoneQuad quad = runstone_unpack(texelFetch(quads, i / 6).xy);
//   vec3 at = origin_of_chunk + runstone_corner(quad, runstone_triangle_corner(uint(i % 6)));
// The numbers equal RUNSTONE_QUAD_..._SHIFT and _BITS in runstone.h.
const uint RUNSTONE_QUAD_X_SHIFT = 0u;
const uint RUNSTONE_QUAD_X_BITS = 7u;
const uint RUNSTONE_QUAD_Y_SHIFT = 7u;
const uint RUNSTONE_QUAD_Y_BITS = 7u;
const uint RUNSTONE_QUAD_Z_SHIFT = 14u;
const uint RUNSTONE_QUAD_Z_BITS = 7u;
const uint RUNSTONE_QUAD_WIDTH_SHIFT = 21u;
const uint RUNSTONE_QUAD_WIDTH_BITS = 7u;
const uint RUNSTONE_QUAD_HEIGHT_SHIFT = 28u;
const uint RUNSTONE_QUAD_HEIGHT_BITS = 7u;
const uint RUNSTONE_QUAD_DIRECTION_SHIFT = 35u;
const uint RUNSTONE_QUAD_DIRECTION_BITS = 3u;
const uint RUNSTONE_QUAD_MATERIAL_SHIFT = 38u;
const uint RUNSTONE_QUAD_MATERIAL_BITS = 16u;
const uint RUNSTONE_QUAD_FACE_SHIFT = 54u;
const uint RUNSTONE_QUAD_FACE_BITS = 10u;

struct RunstoneQuad {
  uvec3 voxel;     // of the corner with the smallest coordinates, in the chunk
  uint width;      // faces along u, 1 .. 128
  uint height;     // faces along v
  uint direction;  // -x, +x, -y, +y, -z, +z
  uint material;
  uint face;  // 0 for a cube
};

// Returns `bits` bits of a quad from bit `shift` on.
uint runstone_quad_bits(uvec2 quad, uint shift, uint bits) {
  uint mask = (1u << bits) - 1u;
  if (shift >= 32u) return (quad.y >> (shift - 32u)) & mask;
  uint low = quad.x >> shift;
  if (shift + bits > 32u) low = low | (quad.y << (32u - shift));
  return low & mask;
}

RunstoneQuad runstone_unpack(uvec2 quad) {
  RunstoneQuad q;
  q.voxel = uvec3(runstone_quad_bits(quad, RUNSTONE_QUAD_X_SHIFT, RUNSTONE_QUAD_X_BITS),
                  runstone_quad_bits(quad, RUNSTONE_QUAD_Y_SHIFT, RUNSTONE_QUAD_Y_BITS),
                  runstone_quad_bits(quad, RUNSTONE_QUAD_Z_SHIFT, RUNSTONE_QUAD_Z_BITS));
  q.width = runstone_quad_bits(quad, RUNSTONE_QUAD_WIDTH_SHIFT, RUNSTONE_QUAD_WIDTH_BITS) + 1u;
  q.height = runstone_quad_bits(quad, RUNSTONE_QUAD_HEIGHT_SHIFT, RUNSTONE_QUAD_HEIGHT_BITS) + 1u;
  q.direction =
      runstone_quad_bits(quad, RUNSTONE_QUAD_DIRECTION_SHIFT, RUNSTONE_QUAD_DIRECTION_BITS);
  q.material = runstone_quad_bits(quad, RUNSTONE_QUAD_MATERIAL_SHIFT, RUNSTONE_QUAD_MATERIAL_BITS);
  q.face = runstone_quad_bits(quad, RUNSTONE_QUAD_FACE_SHIFT, RUNSTONE_QUAD_FACE_BITS);
  return q;
}

// Returns the unit vector of a direction.
vec3 runstone_normal(uint direction) {
  float side = (direction & 1u) == 1u ? 1.0 : -1.0;
  uint axis = direction >> 1u;
  return vec3(axis == 0u ? side : 0.0, axis == 1u ? side : 0.0, axis == 2u ? side : 0.0);
}

// Returns corner 0 .. 3 of a quad of cubes in the chunk, counter-clockwise seen from outside.
vec3 runstone_corner(RunstoneQuad quad, uint corner) {
  bool positive = (quad.direction & 1u) == 1u;
  bool far_u = corner == 2u || corner == (positive ? 1u : 3u);
  bool far_v = corner == 2u || corner == (positive ? 3u : 1u);
  float w = positive ? 1.0 : 0.0;
  float u = float(far_u ? quad.width : 0u);
  float v = float(far_v ? quad.height : 0u);
  uint axis = quad.direction >> 1u;
  float x = float(quad.voxel.x) + (axis == 0u ? w : axis == 1u ? v : u);
  float y = float(quad.voxel.y) + (axis == 0u ? u : axis == 1u ? w : v);
  float z = float(quad.voxel.z) + (axis == 0u ? v : axis == 1u ? u : w);
  return vec3(x, y, z);
}

// Returns the corner of vertex 0 .. 5 of the two triangles of a quad without occlusion.
uint runstone_triangle_corner(uint vertex) {
  return vertex < 3u ? vertex : vertex == 3u ? 0u : vertex - 2u;
}

// Returns the occlusion of a corner, 0 .. 3. `corners` is an element that runstone_mesh_occlusion()
// writes.
uint runstone_occlusion(uint corners, uint corner) { return (corners >> (2u * corner)) & 3u; }

// Returns the corner of vertex 0 .. 5 of the two triangles of a quad with occlusion, whose diagonal
// joins the corners that are less dark.
uint runstone_occluded_corner(uint corners, uint vertex) {
  uint even = runstone_occlusion(corners, 0u) + runstone_occlusion(corners, 2u);
  uint odd = runstone_occlusion(corners, 1u) + runstone_occlusion(corners, 3u);
  uint first = even > odd ? 1u : 0u;
  return (runstone_triangle_corner(vertex) + first) & 3u;
}
