// The objects behind runstone_visibility and runstone_borders. A visibility holds all properties of
// materials that meshers read, with the shapes.
#pragma once
#include <cstdint>
#include <memory>
#include <utility>

#include "bindings/c/chunk_handle.hpp"
#include "bindings/c/handle.hpp"
#include "common/mesh/mesh_materials.hpp"
#include "common/mesh/rdm/chunk_borders.hpp"

struct runstone_visibility : runstone::c_interface::Handle<0x65737576> {
  /// Requires materials, not null.
  explicit runstone_visibility(runstone::MeshMaterialsPtr of) : materials(std::move(of)) {}

  runstone::MeshMaterialsPtr materials;
  // Tells tables apart, also after one was freed.
  std::uint64_t revision = runstone::c_interface::new_revision();
};

struct runstone_borders : runstone::c_interface::Handle<0x64726f62> {
  runstone_borders(const runstone_chunk& chunk, const runstone_visibility& visibility)
      : of_chunk(chunk.revision), of_visibility(visibility.revision) {
    borders.read(chunk.runs, visibility.materials->cubes);
  }

  runstone::ChunkBorders borders;
  std::uint64_t of_chunk, of_visibility;  // the revisions that they were read from
};
