// The compressed streams of a Luanti map block: zstd since serialisation version 29, zlib before.
// Internal to the reader of blocks. Every byte is untrusted: the output is bounded.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Returns what the zstd frame at `at` decompresses to, cut to its first `bytes_max` bytes. Bytes
/// behind the frame are ignored. Fails if the frame is damaged or ends early before the cut. The
/// offset of an error is a byte of `data`.
Result<Bytes> unpack_zstd(ByteView data, std::size_t at, std::size_t bytes_max);

/// Decompresses the zlib stream at `at`, and appends what it holds to `out` if that is not null.
/// Returns the offset behind the stream. Fails if the stream is damaged, ends early or decompresses
/// to more than `bytes_max` bytes. The offset of an error is a byte of `data`.
Result<std::size_t> unpack_zlib(ByteView data, std::size_t at, std::size_t bytes_max, Bytes* out);

}  // namespace runstone
