// RLE RDM as the thesis built it (7.3.1, 7.3.2): runs become sides of cuboids directly from the
// compressed chunk. Tail culling is the only culling; there is no merging, and neighbours are not
// read. The product's mesher started from this prototype.
#pragma once
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::reference {

/// Replaces `out` by the mesh of `chunk`. A drawn run is cut at the ends of lines. Each piece
/// gives, in our axes:
/// - the strips +x and +y and the ends +z and -z;
/// - the strip -x, unless the run passed the same piece one slow layer before;
/// - the strip -y, unless the run passed it one line before in the same slow layer.
/// So the mesh covers every exposed face and many hidden ones. Requires order zyx, which is the
/// thesis' (y, z, x with z up). Cost: O(runs + lines of drawn runs).
void mesh_rle_rdm(const RunChunk& chunk, const VisibilityTable& visibility, std::vector<Quad>& out);

}  // namespace runstone::reference
