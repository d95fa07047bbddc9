// Calls of runstone.h that read the quads of a mesh.
#include <array>
#include <cmath>
#include <span>

#include "bindings/c/buffer.hpp"
#include "bindings/c/mesh_handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/versioned.hpp"
#include "common/mesh/quad_corners.hpp"
#include "common/mesh/shapes/liquid_steps.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

const QuadLayers& pass_of(const runstone_mesh* mesh, std::uint32_t pass) {
  const runstone_mesh& of = live(mesh, "mesh");
  check_at_most(pass, std::uint32_t{RUNSTONE_PASS_TRANSPARENT}, "pass", "is unknown");
  if (of.has_occlusion) return of.occluded[pass].quads;
  return pass == RUNSTONE_PASS_OPAQUE ? of.quads.opaque : of.quads.transparent;
}

std::span<const Quad> shapes_of(const runstone_mesh* mesh, std::uint32_t pass) {
  const ShapeQuads& shapes = live(mesh, "mesh").quads.shapes;
  check_at_most(pass, std::uint32_t{RUNSTONE_PASS_TRANSPARENT}, "pass", "is unknown");
  return pass == RUNSTONE_PASS_OPAQUE ? shapes.opaque : shapes.transparent;
}

void write_quads(std::span<const Quad> quads, uint64_t* out, std::size_t capacity,
                 std::size_t* count) {
  if (!has_room(out, capacity, quads.size(), count)) return;
  for (const Quad& quad : quads) *out++ = quad.bits;
}

std::array<runstone_vertex, 4> vertices_of(Quad quad) {
  const QuadFields fields = unpack(quad);
  const Axis axis = axis_of(fields.direction);
  const auto u = static_cast<std::size_t>(u_axis_of(axis));
  const auto v = static_cast<std::size_t>(v_axis_of(axis));
  const auto corners = quad_corners(quad);
  std::array<runstone_vertex, 4> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t along = 0; along < 3; ++along)
      out[i].position[along] = static_cast<float>(corners[i][along]);
    out[i].normal[static_cast<std::size_t>(axis)] = is_positive(fields.direction) ? 1.0F : -1.0F;
    out[i].uv[0] = static_cast<float>(corners[i][u] - corners[0][u]);
    out[i].uv[1] = static_cast<float>(corners[i][v] - corners[0][v]);
    out[i].material = fields.material;
  }
  return out;
}

/// Returns the rectangle of a quad inside its first and its last voxel, in sixteenths.
ShapeFace face_of(const QuadFields& q, const MeshMaterials& materials) {
  // A step of a liquid (common/mesh/shapes/liquid_steps.hpp) is the upper part of a lateral face.
  if (!materials.shapes.is_cube(q.material))
    return materials.shapes[q.material].faces.faces()[q.face - 1U];
  ShapeFace step;
  step.direction = q.direction;
  step.depth = step.far_depth = is_positive(q.direction) ? kShapeUnits : 0;
  const auto low = static_cast<std::uint8_t>(kShapeUnits - kLiquidDrop);
  (u_axis_of(axis_of(q.direction)) == Axis::y ? step.u0 : step.v0) = low;
  return step;
}

std::array<runstone_vertex, 4> shape_vertices_of(Quad quad, const MeshMaterials& materials) {
  auto out = vertices_of(quad);
  const QuadFields fields = unpack(quad);
  const ShapeFace face = face_of(fields, materials);
  const Axis axis = axis_of(fields.direction);
  const auto w = static_cast<std::size_t>(axis);
  const auto u = static_cast<std::size_t>(u_axis_of(axis));
  const auto v = static_cast<std::size_t>(v_axis_of(axis));
  const auto units = [](int sixteenths) { return static_cast<float>(sixteenths) / kShapeUnits; };
  for (runstone_vertex& vertex : out) {
    const bool is_far_u = vertex.uv[0] > 0, is_far_v = vertex.uv[1] > 0;
    const float du = units(is_far_u ? face.u1 - kShapeUnits : face.u0);
    const float dv = units(is_far_v ? face.v1 - kShapeUnits : face.v0);
    vertex.position[u] += du;
    vertex.position[v] += dv;
    vertex.uv[0] += du;
    vertex.uv[1] += dv;
    vertex.position[w] += units((is_far_v ? face.far_depth : face.depth) -
                                (is_positive(fields.direction) ? kShapeUnits : 0));
    if (face.is_flat()) continue;
    // The plane of a plant is upright, from (depth, v0) to (far_depth, v1) along x and z.
    const auto across = static_cast<float>(face.v1 - face.v0);
    const auto along = static_cast<float>(face.far_depth - face.depth);
    const float length = std::hypot(across, along);
    const float sign = is_positive(fields.direction) ? 1.0F : -1.0F;
    vertex.normal[w] = sign * across / length;
    vertex.normal[v] = -sign * along / length;
  }
  return out;
}

void write_indices(std::size_t quad_count, uint32_t* out, std::size_t capacity,
                   std::size_t* count) {
  if (!has_room(out, capacity, 6 * quad_count, count)) return;
  for (std::uint32_t quad = 0; quad < quad_count; ++quad) {
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) *out++ = 4 * quad + corner;
  }
}

}  // namespace

runstone_status runstone_mesh_quads(const runstone_mesh* mesh, uint32_t pass, uint64_t* out,
                                    size_t capacity, size_t* count) {
  return answer([&] { write_quads(pass_of(mesh, pass).quads, out, capacity, count); });
}

runstone_status runstone_mesh_layer_quads(const runstone_mesh* mesh, uint32_t pass,
                                          uint32_t direction, uint32_t layer, uint64_t* out,
                                          size_t capacity, size_t* count) {
  return answer([&] {
    const QuadLayers& quads = pass_of(mesh, pass);
    check_at_most(direction, std::uint32_t{RUNSTONE_POS_Z}, "direction", "is unknown");
    check_at_most(layer, std::uint32_t{kSideMax - 1}, "layer", "is above 127");
    write_quads(quads.layer(static_cast<Direction>(direction), layer), out, capacity, count);
  });
}

runstone_status runstone_mesh_vertices(const runstone_mesh* mesh, uint32_t pass,
                                       runstone_vertex* out, size_t capacity, size_t* count) {
  return answer([&] {
    const std::vector<Quad>& quads = pass_of(mesh, pass).quads;
    if (!has_room(out, capacity, 4 * quads.size(), count)) return;
    const CornerOcclusion* const corners =
        mesh->has_occlusion ? mesh->occluded[pass].corners.data() : nullptr;
    for (std::size_t i = 0; i < quads.size(); ++i) {
      const auto vertices = vertices_of(quads[i]);
      const CornerOcclusion dark = corners == nullptr ? 0 : corners[i];
      for (std::size_t corner = first_corner(dark), end = corner + 4; corner < end; ++corner) {
        *out = vertices[corner % 4];
        out++->occlusion = static_cast<std::uint16_t>(occlusion_of(dark, corner % 4));
      }
    }
  });
}

runstone_status runstone_mesh_indices(const runstone_mesh* mesh, uint32_t pass, uint32_t* out,
                                      size_t capacity, size_t* count) {
  return answer([&] { write_indices(pass_of(mesh, pass).quads.size(), out, capacity, count); });
}

runstone_status runstone_mesh_shape_quads(const runstone_mesh* mesh, uint32_t pass, uint64_t* out,
                                          size_t capacity, size_t* count) {
  return answer([&] { write_quads(shapes_of(mesh, pass), out, capacity, count); });
}

runstone_status runstone_mesh_shape_vertices(const runstone_mesh* mesh, uint32_t pass,
                                             runstone_vertex* out, size_t capacity, size_t* count) {
  return answer([&] {
    const std::span<const Quad> quads = shapes_of(mesh, pass);
    if (!has_room(out, capacity, 4 * quads.size(), count)) return;
    for (const Quad& quad : quads) {
      for (const runstone_vertex& vertex : shape_vertices_of(quad, *mesh->materials))
        *out++ = vertex;
    }
  });
}

runstone_status runstone_mesh_shape_indices(const runstone_mesh* mesh, uint32_t pass, uint32_t* out,
                                            size_t capacity, size_t* count) {
  return answer([&] { write_indices(shapes_of(mesh, pass).size(), out, capacity, count); });
}

runstone_status runstone_quad_unpack(uint64_t quad, runstone_quad_fields* out) {
  return answer([&] {
    const QuadFields q = unpack({quad});
    check_at_most(static_cast<std::uint32_t>(q.direction), std::uint32_t{RUNSTONE_POS_Z}, "quad",
                  "has an unknown direction");
    fill_versioned(versioned(out, "out"),
                   {0, q.x, q.y, q.z, q.width, q.height, static_cast<std::uint32_t>(q.direction),
                    q.material, q.face});
  });
}
