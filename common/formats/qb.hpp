// Qubicle .qb: in. A file is a list of matrices: boxes of colours at places of their own. Format: the
// documentation of Qubicle's "binary" format.
// Axes: y is up, as here. Most files are left-handed; their z runs against ours, so a voxel at z is at
// -1 - z here, and nothing is mirrored. The z of right-handed files is ours.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"

namespace runstone {

inline constexpr std::uint32_t kQbMatricesMax = 1 << 16;
/// The cells of all matrices together, empty ones included.
inline constexpr std::uint64_t kQbCellsMax = std::uint64_t{1} << 32;

/// Reads a .qb, plain or compressed, with colours in both orders. Alpha is no colour there: it is 0 for
/// no voxel, otherwise a mask of faces, which is not kept. A block is named "colour #rrggbb". The offset
/// of an error is a byte of the file. Cost: O(cells). Memory: the runs of 64 layers, and the colours.
Result<ForeignInfo> read_qb(ByteView file, const PieceSink& sink);

}  // namespace runstone
