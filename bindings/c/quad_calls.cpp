// Calls of runstone.h that read the quads of a mesh.
#include <array>
#include <span>

#include "bindings/c/buffer.hpp"
#include "bindings/c/mesh_handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/versioned.hpp"
#include "common/mesh/quad_corners.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

const QuadLayers& pass_of(const runstone_mesh* mesh, std::uint32_t pass) {
  const ChunkMesh& quads = live(mesh, "mesh").quads;
  check_at_most(pass, std::uint32_t{RUNSTONE_PASS_TRANSPARENT}, "pass", "is unknown");
  return pass == RUNSTONE_PASS_OPAQUE ? quads.opaque : quads.transparent;
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
    const QuadLayers& quads = pass_of(mesh, pass);
    if (!has_room(out, capacity, 4 * quads.quads.size(), count)) return;
    for (const Quad& quad : quads.quads) {
      for (const runstone_vertex& vertex : vertices_of(quad)) *out++ = vertex;
    }
  });
}

runstone_status runstone_mesh_indices(const runstone_mesh* mesh, uint32_t pass, uint32_t* out,
                                      size_t capacity, size_t* count) {
  return answer([&] {
    const std::size_t quad_count = pass_of(mesh, pass).quads.size();
    if (!has_room(out, capacity, 6 * quad_count, count)) return;
    for (std::uint32_t quad = 0; quad < quad_count; ++quad) {
      for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) *out++ = 4 * quad + corner;
    }
  });
}

runstone_status runstone_quad_unpack(uint64_t quad, runstone_quad_fields* out) {
  return answer([&] {
    const QuadFields q = unpack({quad});
    check_at_most(static_cast<std::uint32_t>(q.direction), std::uint32_t{RUNSTONE_POS_Z}, "quad",
                  "has an unknown direction");
    fill_versioned(versioned(out, "out"), {0, q.x, q.y, q.z, q.width, q.height,
                                           static_cast<std::uint32_t>(q.direction), q.material});
  });
}
