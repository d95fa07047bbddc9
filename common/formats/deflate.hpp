// Deflate streams in the three forms in which other programs write them: zlib, gzip and raw. Every
// byte that is read is untrusted: whoever inflates bounds the output, so a small stream cannot become
// large memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

enum class DeflateForm : std::uint8_t {
  zlib,
  gzip,
  raw,           // without header and checksum
  zlib_or_gzip,  // the first bytes tell which; not for writing
};

/// Inflates one stream piece by piece. The packed bytes must outlive it. Memory: some 50 KB.
class Inflater {
 public:
  Inflater(ByteView packed, DeflateForm form);

  /// Fills `out` with the next bytes, and returns their number, which is smaller than out.size() only
  /// at the end of the stream. Fails with truncated if the stream ends early, and with bad_value if it
  /// is damaged or is none; a second call then fails in the same way. The offset of an error is a byte
  /// of the packed bytes.
  Result<std::size_t> read(std::span<std::uint8_t> out);
  /// Returns true if the whole stream was read.
  bool at_end() const { return at_end_; }
  /// Returns the number of packed bytes that were read. Bytes behind the stream are left alone.
  std::size_t packed_offset() const;

 private:
  struct State;
  struct StateDeleter {
    void operator()(State* state) const;
  };
  std::unique_ptr<State, StateDeleter> state_;
  ByteView packed_;
  std::size_t given_ = 0;  // packed bytes that zlib got, some of which it may not have read
  bool at_end_ = false;
};

/// Inflates the stream at `at`, and appends what it holds to `out` if that is not null. Returns the
/// offset behind the stream. Fails as Inflater::read() does, and with limit_exceeded if the stream
/// inflates to more than `bytes_max` bytes. The offset of an error is a byte of `data`. What was
/// appended before a failure stays. A vector that is reused needs no new memory.
Result<std::size_t> inflate_all(ByteView data, std::size_t at, DeflateForm form,
                                std::size_t bytes_max, Bytes* out);

/// Deflates one stream piece by piece. Equal bytes in equal pieces give equal output with one version
/// of zlib: a gzip header holds no time and no name. Memory: some 300 KB.
class Deflater {
 public:
  /// Requires a level of 1 .. 9. The output is appended to `out`, which must outlive it.
  Deflater(DeflateForm form, int level, Bytes& out);
  void write(ByteView plain);
  /// Ends the stream. Nothing may be written after that.
  void finish();

 private:
  struct State;
  struct StateDeleter {
    void operator()(State* state) const;
  };
  void run(int flush);
  std::unique_ptr<State, StateDeleter> state_;
  Bytes& out_;
};

/// Returns the bytes as one stream. Requires a level of 1 .. 9.
Bytes deflate_all(ByteView plain, DeflateForm form, int level = 6);

}  // namespace runstone
