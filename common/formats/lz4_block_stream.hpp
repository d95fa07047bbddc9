// The LZ4 streams of lz4-java: blocks with a head of their own, which Minecraft writes since 1.20.5.
// They are not the frames of the LZ4 project.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Decompresses the stream and appends what it holds to `out`. Fails if a block is damaged or has a
/// wrong checksum, if the stream ends without its end block, or with limit_exceeded if it holds more
/// than `bytes_max` bytes. Bytes behind the end block are ignored. The offset of an error is a byte
/// of `data`. What was appended before a failure stays.
Result<void> unpack_lz4_blocks(ByteView data, std::size_t bytes_max, Bytes& out);

}  // namespace runstone
