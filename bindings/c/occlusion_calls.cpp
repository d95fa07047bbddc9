// Calls of runstone.h that darken the corners of quads.
#include <algorithm>
#include <array>
#include <span>

#include "bindings/c/buffer.hpp"
#include "bindings/c/mesh_handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/visibility_handle.hpp"
#include "common/core/thread_scratch.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

/// Refuses one of the chunks around if its sides do not fit the sides of the chunk.
void check_fits(const RunChunk& beyond, const RunChunk& chunk, std::size_t place) {
  for (std::size_t axis = 0; axis < 3; ++axis, place /= 3) {
    if (place % 3 == 1 && beyond.extent.sides()[axis] != chunk.extent.sides()[axis])
      refuse(RUNSTONE_BAD_ARGUMENT, "around", "has chunks of other sides than the chunk");
  }
}

/// The places of the six neighbours in the 27 chunks, by Direction.
constexpr std::array<std::size_t, kDirectionCount> kNeighbourPlaces = {
    around_place(-1, 0, 0), around_place(1, 0, 0),  around_place(0, -1, 0),
    around_place(0, 1, 0),  around_place(0, 0, -1), around_place(0, 0, 1)};

}  // namespace

runstone_status runstone_mesh_occlude(runstone_mesh* mesh, const runstone_chunk* chunk,
                                      const runstone_chunk* const around[27],
                                      const runstone_visibility* visibility) {
  return answer([&] {
    runstone_mesh& of = live(mesh, "mesh");
    const runstone_chunk& middle = whole(chunk, "chunk");
    const runstone_visibility& table = live(visibility, "visibility");
    ChunksAround chunks{};
    std::array<std::uint64_t, 27> revisions{};
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      if (around == nullptr || around[i] == nullptr || i == around_place(0, 0, 0)) continue;
      const runstone_chunk& beyond = whole(around[i], "around");
      check_fits(beyond.runs, middle.runs, i);
      chunks[i] = &beyond.runs;
      revisions[i] = beyond.revision;
    }
    bool fits = of.of_chunk == middle.revision && of.of_visibility == table.revision;
    for (std::size_t d = 0; d < kDirectionCount; ++d)
      fits = fits && of.of_neighbours[d] == revisions[kNeighbourPlaces[d]];
    if (!fits) {
      refuse(RUNSTONE_BAD_ARGUMENT, "mesh",
             "is not of this chunk, these neighbours and this visibility as they are now");
    }
    of.has_occlusion = false;
    with_scratch<OpaqueBits>([&](OpaqueBits& bits) {
      bits.read(middle.runs, chunks, table.materials->cubes);
      occlude_quads(of.quads.opaque, bits, of.occluded[RUNSTONE_PASS_OPAQUE]);
      occlude_quads(of.quads.transparent, bits, of.occluded[RUNSTONE_PASS_TRANSPARENT]);
    });
    of.has_occlusion = true;
  });
}

runstone_status runstone_mesh_occlusion(const runstone_mesh* mesh, uint32_t pass, uint8_t* out,
                                        size_t capacity, size_t* count) {
  return answer([&] {
    const runstone_mesh& of = live(mesh, "mesh");
    check_at_most(pass, std::uint32_t{RUNSTONE_PASS_TRANSPARENT}, "pass", "is unknown");
    if (of.has_occlusion) {
      write_elements(std::span<const CornerOcclusion>(of.occluded[pass].corners), out, capacity,
                     count);
      return;
    }
    const QuadLayers& quads = pass == RUNSTONE_PASS_OPAQUE ? of.quads.opaque : of.quads.transparent;
    if (has_room(out, capacity, quads.quads.size(), count)) std::fill_n(out, quads.quads.size(), 0);
  });
}
