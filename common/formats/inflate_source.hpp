// InflateSource: reads bytes in order, which are stored, or packed as a zlib or raw deflate stream.
// Internal to formats. Every byte is untrusted. Memory: 64 KiB and the window of zlib.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "common/core/bytes.hpp"

struct z_stream_s;

namespace runstone {

class InflateSource {
 public:
  enum class Kind { stored, zlib, deflate };
  /// `packed` must outlive the source.
  InflateSource(ByteView packed, Kind kind);
  ~InflateSource();
  InflateSource(InflateSource&&) noexcept;
  InflateSource& operator=(InflateSource&&) noexcept;

  /// Fills `out`. Returns false if the bytes end before, or are damaged: see is_damaged().
  bool read(std::span<std::uint8_t> out);
  /// Skips bytes. Fails as read() does.
  bool skip(std::uint64_t count);
  /// Returns true if a stream is no stream. Otherwise it ended early.
  bool is_damaged() const { return is_damaged_; }
  /// Reads the end of a stream. Returns false if bytes follow, or if the stream ends early.
  bool finish();
  /// Returns the number of bytes of `packed` that were read.
  std::size_t offset() const;
  /// Returns the CRC-32 of the bytes that were read.
  std::uint32_t checksum() const { return checksum_; }

 private:
  struct StreamDeleter {
    void operator()(z_stream_s* stream) const;
  };
  ByteView packed_;
  std::size_t at_ = 0;  // stored bytes that were read
  std::unique_ptr<z_stream_s, StreamDeleter> stream_;
  bool is_damaged_ = false;
  bool is_finished_ = false;
  std::uint32_t checksum_ = 0;

  bool fill(std::span<std::uint8_t> out);
};

}  // namespace runstone
