// RLE RDM as the thesis built it (7.3.1, 7.3.2): runs become cuboids' sides straight from the compressed
// chunk, with tail culling as the only culling, no merging and no neighbours. The prototype ours sets out
// from.
#pragma once
#include <vector>

#include "common/mesh/quad.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::reference {

/// Replaces `out` by the mesh of `chunk`. A drawn run is cut where lines end; each piece gives, in our axes,
/// the strips +x, +y and the ends +z, -z, the strip -x unless the run had come past the piece one slow layer
/// before, and the strip -y unless it had one line before in the same slow layer. So it covers every exposed
/// face and many hidden ones. Requires order zyx, the thesis' (y, z, x with z up). O(runs + lines of drawn
/// runs).
void mesh_rle_rdm(const RunChunk& chunk, const VisibilityTable& visibility, std::vector<Quad>& out);

}  // namespace runstone::reference
