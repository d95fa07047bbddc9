// Calls of runstone.h that make meshes.
#include <algorithm>
#include <array>
#include <optional>

#include "bindings/c/mesh_handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/visibility_handle.hpp"
#include "common/core/thread_scratch.hpp"
#include "common/mesh/chunk_mesher.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

/// The checked arguments of a call that meshes.
struct MeshInput {
  MeshInput(const runstone_chunk* chunk_given, const runstone_chunk* const neighbours_given[6],
            const runstone_borders* const borders_given[6],
            const runstone_visibility* visibility_given)
      : chunk(whole(chunk_given, "chunk")), visibility(live(visibility_given, "visibility")) {
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (neighbours_given != nullptr && neighbours_given[d] != nullptr)
        set_neighbour(d, whole(neighbours_given[d], "neighbours"));
      if (borders_given != nullptr && borders_given[d] != nullptr)
        set_borders(d, live(borders_given[d], "borders"));
    }
  }

  void set_neighbour(std::size_t d, const runstone_chunk& neighbour) {
    const auto across = static_cast<std::size_t>(axis_of(static_cast<Direction>(d)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis != across &&
          neighbour.runs.extent.sides()[axis] != chunk.runs.extent.sides()[axis]) {
        refuse(RUNSTONE_BAD_ARGUMENT, "neighbours", "have other sides than the chunk");
      }
    }
    handles[d] = &neighbour;
    neighbours[d] = &neighbour.runs;
  }
  void set_borders(std::size_t d, const runstone_borders& kept) {
    if (handles[d] == nullptr || kept.of_chunk != handles[d]->revision ||
        kept.of_visibility != visibility.revision) {
      refuse(RUNSTONE_BAD_ARGUMENT, "borders",
             "are not of the neighbour as it is now, or of another visibility");
    }
    borders[d] = &kept.borders;
  }

  const runstone_chunk& chunk;
  const runstone_visibility& visibility;
  std::array<const runstone_chunk*, kDirectionCount> handles{};
  MeshNeighbours neighbours{};
  MeshBorders borders{};
};

/// The layers that changed since a mesh was made.
struct OutdatedLayers {
  DirtyLayers inside;
  std::array<DirtyLayers, kDirectionCount> beyond;
  bool any() const {
    return inside.any() ||
           std::any_of(beyond.begin(), beyond.end(), [](const auto& b) { return b.any(); });
  }
};

/// All layers of a neighbour, if it is not known which of them changed.
DirtyLayers all_layers(const RunChunk& chunk) {
  DirtyLayers out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t layer = 0; layer < chunk.extent.sides()[axis]; ++layer)
      out.layer[axis].set(layer);
  }
  return out;
}

/// Returns nullopt if the whole mesh has to be made.
std::optional<OutdatedLayers> outdated_layers(const runstone_mesh& mesh, const MeshInput& in) {
  if (mesh.of_visibility != in.visibility.revision) return std::nullopt;
  const auto inside = in.chunk.changes_since(mesh.of_chunk);
  if (!inside) return std::nullopt;
  OutdatedLayers out{*inside, {}};
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    const runstone_chunk* const neighbour = in.handles[d];
    if (neighbour != nullptr) {
      out.beyond[d] =
          neighbour->changes_since(mesh.of_neighbours[d]).value_or(all_layers(neighbour->runs));
    } else if (mesh.of_neighbours[d] != 0) {
      return std::nullopt;  // the mesher reads no layers of a neighbour that is gone
    }
  }
  return out;
}

void note_made_of(runstone_mesh& mesh, const MeshInput& in) {
  mesh.materials = in.visibility.materials;
  mesh.of_chunk = in.chunk.revision;
  mesh.of_visibility = in.visibility.revision;
  for (std::size_t d = 0; d < kDirectionCount; ++d)
    mesh.of_neighbours[d] = in.handles[d] == nullptr ? 0 : in.handles[d]->revision;
}

void make_whole(runstone_mesh& mesh, const MeshInput& in) {
  mesh.change_quads([&] {
    with_scratch<ChunkMeshScratch>([&](ChunkMeshScratch& scratch) {
      mesh_chunk(in.chunk.runs, in.neighbours, in.borders, *in.visibility.materials, scratch,
                 mesh.quads);
    });
  });
}

}  // namespace

runstone_status runstone_mesh_create(runstone_mesh** out) {
  return answer([&] {
    output(out, "out");
    create(out);
  });
}

runstone_status runstone_mesh_free(runstone_mesh* mesh) { return free_handle(mesh, "mesh"); }

runstone_status runstone_mesh_chunk(runstone_mesh* mesh, const runstone_chunk* chunk,
                                    const runstone_chunk* const neighbours[6],
                                    const runstone_borders* const borders[6],
                                    const runstone_visibility* visibility) {
  return answer([&] {
    runstone_mesh& made = live(mesh, "mesh");
    const MeshInput in(chunk, neighbours, borders, visibility);
    make_whole(made, in);
    note_made_of(made, in);
  });
}

runstone_status runstone_mesh_update(runstone_mesh* mesh, const runstone_chunk* chunk,
                                     const runstone_chunk* const neighbours[6],
                                     const runstone_borders* const borders[6],
                                     const runstone_visibility* visibility, uint32_t* is_whole) {
  return answer([&] {
    runstone_mesh& made = live(mesh, "mesh");
    const MeshInput in(chunk, neighbours, borders, visibility);
    const auto outdated = outdated_layers(made, in);
    bool in_part = outdated.has_value();
    made.has_occlusion = false;
    if (!outdated) {
      make_whole(made, in);
    } else if (outdated->any()) {
      in_part = made.change_quads([&] {
        return with_scratch<ChunkMeshScratch>([&](ChunkMeshScratch& scratch) {
          return mesh_chunk_layers(in.chunk.runs, in.neighbours, in.borders,
                                   *in.visibility.materials, outdated->inside, outdated->beyond,
                                   scratch, made.quads);
        });
      });
    }
    note_made_of(made, in);
    if (is_whole != nullptr) *is_whole = in_part ? 0 : 1;
  });
}
