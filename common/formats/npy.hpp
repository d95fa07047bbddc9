// Arrays of numpy: .npy and .npz, in and out. An array has three axes, x, y (up) and z, in this
// order, and whole numbers. Format: numpy's documentation of numpy.lib.format, versions 1 to 3, and
// zip.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/rsb_build.hpp"

namespace runstone {

/// The bytes of an array that is written.
inline constexpr std::uint64_t kNpyBytesMax = std::uint64_t{1} << 36;
/// The bytes of the array `voxels` in an .npz that is written: its sizes are those of a zip without
/// extensions.
inline constexpr std::uint64_t kNpzBytesMax = 0xf000'0000;

/// Reads an .npy: an array of bool or of integers of 1 to 8 bytes, of both byte orders, in C or Fortran
/// order. The number 0 is air, and a number n is a block "material n", 1 .. 65535. Fails with bad_value
/// for other numbers. The offset of an error is a byte of the file. Cost: O(cells). Memory: the
/// runs of 64 layers and 1 MiB.
Result<ForeignInfo> read_npy(ByteView file, const PieceSink& sink);

/// Reads an .npz, whose members are stored or deflated:
///   - `voxels` as read_npy() reads it; the numbers are indices of the other arrays, if there are any;
///   - `names`, one axis of strings (S or U): names of blocks. A cell whose name is empty is untouched;
///   - `states`, one axis of strings: their states;
///   - `colours`, n x 4 of u8: red, green, blue, alpha;
///   - `origin`, 3 integers: the place in a world of the first cell.
/// Only `voxels` is required. Other members are not read. Without `names`, blocks are named as read_npy()
/// names them. A number without a name is refused. The offset of an error is a byte of the file. Cost and
/// memory: those of read_npy(), and names and states of at most 32 MiB.
Result<ForeignInfo> read_npz(ByteView file, const PieceSink& sink);

/// Writes cells as .npy of u8 or u16, C order. Air and untouched cells are 0. A material "material n"
/// without states is n if all materials are called so, otherwise materials are 1, 2, ... in the order of
/// their names; names are lost. Fails with limit_exceeded if the array has more than kNpyBytesMax bytes.
/// Cost: O(cells).
Result<void> write_npy(const FileBuild& build, const FormatSink& sink);

/// Writes an .npz with all arrays of read_npz(). Air is 0, and an untouched cell has an empty name, which
/// is that of 0 if there is no air. Equal builds give equal bytes with one version of zlib. Fails with
/// limit_exceeded if the voxels have more than kNpzBytesMax bytes. Cost: O(cells).
Result<void> write_npz(const FileBuild& build, const FormatSink& sink);

}  // namespace runstone
