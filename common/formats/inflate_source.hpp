// InflateSource: reads exact numbers of bytes, which are stored or packed as a deflate stream, and
// their checksum. Internal to formats. Every byte is untrusted. Memory: that of Inflater.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/core/bytes.hpp"
#include "common/formats/deflate.hpp"

namespace runstone {

class InflateSource {
 public:
  /// Without a form the bytes are stored. `packed` must outlive the source.
  InflateSource(ByteView packed, std::optional<DeflateForm> form);

  /// Fills `out`. Returns false if the bytes end before, or are damaged: see is_damaged().
  bool read(std::span<std::uint8_t> out);
  /// Skips bytes. Fails as read() does.
  bool skip(std::uint64_t count);
  /// Returns true if a stream is no stream. Otherwise it ended early.
  bool is_damaged() const { return is_damaged_; }
  /// Reads the end of a stream. Returns false if bytes follow, or if the stream ends early.
  bool finish();
  /// Returns the number of bytes of `packed` that were read.
  std::size_t offset() const { return inflater_ ? inflater_->packed_offset() : at_; }
  /// Returns the CRC-32 of the bytes that were read.
  std::uint32_t checksum() const { return checksum_; }

 private:
  bool fill(std::span<std::uint8_t> out);

  ByteView stored_;
  std::size_t at_ = 0;  // stored bytes that were read
  std::optional<Inflater> inflater_;
  bool is_damaged_ = false;
  std::uint32_t checksum_ = 0;
};

}  // namespace runstone
