// The shared part of all mesher cases: the buffers, the count of the last mesh's quads, and its
// copy as a surface.
#pragma once
#include <cstddef>
#include <memory>

#include "bench/meshing/mesher_case.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone::bench {

/// Returns a mesher case that keeps `state` alive. Its last mesh is a member of `state`: a
/// ChunkMesh `mesh`, a list `quads` or a TriangleMesh `triangles`. The caller sets the name and the
/// mesher.
template <class State>
MesherCase case_over(std::shared_ptr<State> state, std::size_t storage_bytes) {
  const auto quads = [state]() -> std::size_t {
    if constexpr (requires { state->mesh; })
      return state->mesh.quad_count();
    else if constexpr (requires { state->triangles; })
      return 0;
    else
      return state->quads.size();
  };
  const auto surface = [state](reference::Surface& out) {
    out.clear();
    if constexpr (requires { state->mesh; }) {
      for (const QuadLayers* pass : {&state->mesh.opaque, &state->mesh.transparent}) {
        out.quads.insert(out.quads.end(), pass->quads.begin(), pass->quads.end());
      }
    } else if constexpr (requires { state->triangles; }) {
      out.triangles = state->triangles;
    } else {
      out.quads = state->quads;
    }
  };
  return {"", {}, quads, surface, storage_bytes};
}

}  // namespace runstone::bench
