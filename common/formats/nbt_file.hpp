// Files of NBT, such as schematics: gzip, zlib or not compressed. A file may decompress to far more
// than memory holds, because it has an array with an entry per voxel. So a reader walks it twice: once
// for all that is small, when it notes where the arrays lie, and once for the arrays.
//   NbtFileSource source(file);
//   NbtReader in(source);
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/deflate.hpp"
#include "common/formats/format.hpp"
#include "common/formats/nbt_reader.hpp"
#include "common/formats/nbt_writer.hpp"

namespace runstone {

/// The bytes that a file may decompress to.
inline constexpr std::uint64_t kNbtFileBytesMax = std::uint64_t{5} << 30;

/// The bytes of a file, a window at a time; the whole file if it is not compressed. The file must
/// outlive it. Memory: 180 KB.
class NbtFileSource : public NbtSource {
 public:
  explicit NbtFileSource(ByteView file);
  Result<ByteView> more(ByteView rest) override;

 private:
  ByteView file_;
  bool is_plain_;
  Inflater packed_;
  Bytes window_;
  std::uint64_t total_ = 0;
};

/// The place of an array in the decompressed bytes of a file.
struct NbtArrayPlace {
  std::uint64_t at = 0;     // of its first element
  std::uint64_t bytes = 0;  // 0: there is no array, or it is empty
};

/// Notes where an array lies, and skips it. `width` is the number of bytes of an element.
NbtArrayPlace skip_nbt_array(NbtReader& in, std::size_t width);

/// Reads the bytes of one array from the first to the last. The file must outlive it.
class NbtArrayCursor {
 public:
  NbtArrayCursor(ByteView file, NbtArrayPlace place);
  NbtArrayCursor(const NbtArrayCursor&) = delete;
  NbtArrayCursor& operator=(const NbtArrayCursor&) = delete;

  /// Goes to another array, which lies behind what was read.
  void go_to(NbtArrayPlace place);
  /// Returns false at the end of the array, and after a failure.
  bool has_more() { return at_ != end_ || refill(); }
  /// Returns the bytes at hand. Requires has_more().
  ByteView part() const { return {at_, end_}; }
  /// Reads `count` of the bytes at hand.
  void advance(std::size_t count) { at_ += count; }
  /// Reads a byte. Returns 0 at the end of the array.
  std::uint8_t u8() { return has_more() ? *at_++ : std::uint8_t{0}; }

  const NbtReader& reader() const { return in_; }
  /// Returns the offset of the next byte in the decompressed bytes of the file.
  std::uint64_t offset() const { return in_.offset() - static_cast<std::uint64_t>(end_ - at_); }

 private:
  bool refill();
  NbtFileSource source_;
  NbtReader in_;
  std::uint64_t left_ = 0;  // bytes of the array behind those at hand
  const std::uint8_t* at_ = nullptr;
  const std::uint8_t* end_ = nullptr;
};

/// Writes a file of NBT as gzip. The caller writes with nbt() or appends to plain(), and calls flush()
/// now and then. Memory: some 300 KB, and what was not flushed.
class NbtFileWriter {
 public:
  explicit NbtFileWriter(const FormatSink& sink) : sink_(sink) {}
  NbtWriter& nbt() { return nbt_; }
  Bytes& plain() { return plain_; }
  /// Takes the bytes away if they are many. Returns false if the sink did.
  bool flush();
  bool finish();

 private:
  bool give();
  const FormatSink& sink_;
  Bytes plain_, packed_;
  NbtWriter nbt_{plain_};
  Deflater deflater_{DeflateForm::gzip, 6, packed_};
};

}  // namespace runstone
