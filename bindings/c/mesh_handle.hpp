// The object behind runstone_mesh: quads, and the states of the chunks that they were made of.
#pragma once
#include <array>
#include <cstdint>

#include "bindings/c/handle.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/mesh_materials.hpp"
#include "common/mesh/occlusion/quad_occlusion.hpp"

struct runstone_mesh : runstone::c_interface::Handle<0x6873656d> {
  runstone::ChunkMesh quads;
  /// The materials with the shapes that the quads name. Null before the first mesh.
  runstone::MeshMaterialsPtr materials;
  // Revisions; 0: none, or the mesh has to be made anew.
  std::uint64_t of_chunk = 0, of_visibility = 0;
  std::array<std::uint64_t, runstone::kDirectionCount> of_neighbours{};
  /// The quads with occlusion, by pass. If the mesh has occlusion, they replace `quads`.
  std::array<runstone::OccludedQuads, 2> occluded;
  bool has_occlusion = false;

  /// Does `work`, which changes the quads. If `work` throws, the mesh becomes empty and the next
  /// update makes it anew, because a part of the quads could name faces of shapes that `materials`
  /// lacks.
  template <class F>
  auto change_quads(F&& work) {
    of_chunk = 0;
    has_occlusion = false;
    try {
      return work();
    } catch (...) {
      quads.opaque = {};
      quads.transparent = {};
      quads.shapes.clear();
      throw;
    }
  }
};
