// Unpacks a zstd frame from an untrusted source. Internal to the chunk codec.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Unpacks `frame` into scratch of this thread. The view lives until the thread's next call.
/// Allocates `bytes`, which the caller must have bounded. Offsets of errors are 0. Fails with
///   - bad_value if the frame does not announce exactly `bytes` bytes;
///   - trailing_bytes if it is truncated or bytes follow it;
///   - bad_checksum if it is damaged.
Result<ByteView> unpack_zstd_frame(ByteView frame, std::size_t bytes);

}  // namespace runstone
