// A zstd frame from outside, unpacked into scratch of this thread. Internal to the chunk codec.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Unpacks `frame`, which has to announce just `bytes` bytes (bad_value), to end where its data ends (trailing_bytes),
/// and to be sound (bad_checksum). So many bytes are taken: the caller has held them to what the chunk may need. Offsets
/// of errors are 0. The view lives until the next call on the thread.
Result<ByteView> unpack_zstd_frame(ByteView frame, std::size_t bytes);

}  // namespace runstone
