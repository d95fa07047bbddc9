// ViewPane: the chunks of a world as one mesher makes them, for one part of the split view.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "bench/frames/frames_world.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone::bench {

struct ViewChunk {
  ChunkCoord at;
  ChunkMesh mesh;
};

struct ViewPane {
  std::string name;   // of the mesher, for people
  std::string timed;  // what mesh_us contains
  std::vector<ViewChunk> chunks;
  std::size_t quads = 0;
  double mesh_us = 0;  // to mesh all chunks: the median over the repetitions
  std::size_t gpu_bytes() const { return quads * sizeof(Quad); }
};

/// Returns the short names of the meshers: "culled", "binary" and "rdm".
std::vector<std::string> view_mesher_names();

/// Meshes all chunks with culled faces, binary greedy meshing and RDM, or with the one that `only`
/// names. RDM begins with the stored runs. The others decode them first, which their time contains.
/// In each repetition the meshers take turns. Times are those of the thread's processor. Requires
/// repetitions > 0 and an edge of at most 64.
std::vector<ViewPane> view_panes(const FramesWorld& world, unsigned repetitions,
                                 std::string_view only = {});

}  // namespace runstone::bench
