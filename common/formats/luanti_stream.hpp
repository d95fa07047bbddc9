// The compressed stream of a Luanti map block since serialisation version 29, which is zstd. Internal
// to the reader of blocks. Every byte is untrusted: the output is bounded.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Returns what the zstd frame at `at` decompresses to, cut to its first `bytes_max` bytes. Bytes
/// behind the frame are ignored. Fails if the frame is damaged or ends early before the cut. The
/// offset of an error is a byte of `data`.
Result<Bytes> unpack_zstd(ByteView data, std::size_t at, std::size_t bytes_max);

}  // namespace runstone
