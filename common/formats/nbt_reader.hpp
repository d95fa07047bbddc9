// NbtReader: a cursor over the named binary tags of Minecraft's files, decompressed and big-endian. It
// makes no tree: the caller walks from entry to entry, and reads or skips each value.
//   NbtReader in(bytes);
//   in.root();
//   NbtEntry entry;
//   while (in.next(entry)) {
//     if (entry.is("Width", NbtType::i16)) width = in.i16();
//     else in.skip(entry.type);
//   }
//   if (!in.ok()) return failure(in.error());
// Every byte is untrusted. Each count is compared with the bytes that are left before it is used.
// After the first failure every read returns 0 or an empty view and next() returns false, so a caller
// can walk on and check ok() once. The reader allocates no memory, and skip() does not recurse. A caller
// whose own recursion follows the bytes must bound it by kNbtDepthMax.
//
// Views of strings and arrays point into the bytes. If the bytes come from an NbtSource, a view is
// valid until the next read.
// Source: the format as Minecraft's own documentation of 2010 gives it, with int and long arrays.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The type of a value. The numbers are those in the bytes.
enum class NbtType : std::uint8_t {
  end = 0,  // of a compound; also the type of the elements of an empty list
  i8 = 1,
  i16 = 2,
  i32 = 3,
  i64 = 4,
  f32 = 5,
  f64 = 6,
  byte_array = 7,
  string = 8,
  list = 9,
  compound = 10,
  int_array = 11,
  long_array = 12,
};

/// The nesting that skip() follows, which is Minecraft's own.
inline constexpr std::size_t kNbtDepthMax = 512;

/// Returns the number whose big-endian bytes begin at `at`.
template <class T>
T big_endian_at(const std::uint8_t* at) {
  static_assert(std::endian::native == std::endian::little);
  T v;
  std::memcpy(&v, at, sizeof v);
  if constexpr (sizeof(T) == 2)
    v = static_cast<T>(__builtin_bswap16(static_cast<std::uint16_t>(v)));
  if constexpr (sizeof(T) == 4)
    v = static_cast<T>(__builtin_bswap32(static_cast<std::uint32_t>(v)));
  if constexpr (sizeof(T) == 8)
    v = static_cast<T>(__builtin_bswap64(static_cast<std::uint64_t>(v)));
  return v;
}

/// A view of big-endian integers.
template <class T>
class BigEndianArray {
 public:
  BigEndianArray() = default;
  /// Requires a whole number of integers.
  explicit BigEndianArray(ByteView bytes) : bytes_(bytes) {}
  std::size_t size() const { return bytes_.size() / sizeof(T); }
  bool empty() const { return bytes_.empty(); }
  /// Requires i < size().
  T operator[](std::size_t i) const { return big_endian_at<T>(bytes_.data() + i * sizeof(T)); }
  ByteView bytes() const { return bytes_; }

 private:
  ByteView bytes_;
};
using NbtInts = BigEndianArray<std::int32_t>;
using NbtLongs = BigEndianArray<std::uint64_t>;

/// The head of an entry of a compound. The value follows.
struct NbtEntry {
  NbtType type = NbtType::end;
  std::string_view name;  // modified UTF-8; equal to UTF-8 where it is ASCII
  bool is(std::string_view wanted, NbtType wanted_type) const {
    return type == wanted_type && name == wanted;
  }
};

/// The head of a list. `count` values of the type follow, without names.
struct NbtList {
  NbtType type = NbtType::end;
  std::uint32_t count = 0;
};

/// Gives an NbtReader the bytes of a stream that is not in memory as a whole.
class NbtSource {
 public:
  virtual ~NbtSource() = default;
  /// Returns a view that begins with `rest`, which is the end of the view before, and goes on with at
  /// least one more byte of the stream; only `rest` at the end of the stream. The view before becomes
  /// invalid. Fails if the stream is damaged, or with limit_exceeded if `rest` fills the window.
  virtual Result<ByteView> more(ByteView rest) = 0;
};

class NbtReader {
 public:
  explicit NbtReader(ByteView bytes) : in_(bytes) {}
  /// Reads a stream. The source must outlive the reader.
  explicit NbtReader(NbtSource& source) : source_(&source) {}

  bool ok() const { return !failed_; }
  const Error& error() const { return error_; }
  /// Returns the number of bytes that were read.
  std::uint64_t offset() const { return base_ + at_; }

  /// Reads the head of the outermost compound, whose entries follow, and returns its name. Fails if the
  /// outermost value is no compound.
  std::string_view root();
  /// Reads the head of the next entry of the present compound. Returns false at the end of the compound,
  /// which is then left, and after a failure. The caller reads or skips the value of each entry.
  bool next(NbtEntry& entry);

  std::int8_t i8() { return number<std::int8_t>(); }
  std::int16_t i16() { return number<std::int16_t>(); }
  std::int32_t i32() { return number<std::int32_t>(); }
  std::int64_t i64() { return number<std::int64_t>(); }
  float f32() { return std::bit_cast<float>(number<std::uint32_t>()); }
  double f64() { return std::bit_cast<double>(number<std::uint64_t>()); }
  /// Reads a value of one of the four types of integers. Fails with bad_value and `what` if the type is
  /// another one.
  std::int64_t integer(NbtType type, const char* what);
  std::string_view string();  // modified UTF-8
  ByteView byte_array() { return array(1); }
  NbtInts int_array() { return NbtInts(array(4)); }
  NbtLongs long_array() { return NbtLongs(array(8)); }
  /// Reads the head of a list.
  NbtList list();
  /// Skips a value. Cost: O(values in it), not counting the elements of arrays and numbers of lists.
  void skip(NbtType type);

  /// Reads the head of an array and returns its number of elements. Its bytes follow, which bytes() or
  /// skip_bytes() reads. It is for arrays of streams, which may be longer than the window.
  std::uint32_t array_head();
  /// Reads that many bytes.
  ByteView bytes(std::size_t count) {
    const std::uint8_t* at = take(count, "nbt: an array ends early");
    return at != nullptr ? ByteView(at, count) : ByteView();
  }
  void skip_bytes(std::uint64_t count);

  /// Marks the input as bad. It is for a value that decodes but is not allowed.
  void reject(ErrorCode code, const char* what);
  void reject(const Error& error);

 private:
  static constexpr std::size_t kNbtTypes = 13;

  const std::uint8_t* take(std::size_t count, const char* what) {
    if (in_.size() - at_ < count && !refill(count, what)) return nullptr;
    const std::uint8_t* at = in_.data() + at_;
    at_ += count;
    return at;
  }
  template <class T>
  T number() {
    const std::uint8_t* at = take(sizeof(T), "nbt: a number ends early");
    return at != nullptr ? big_endian_at<T>(at) : T{0};
  }
  bool refill(std::size_t count, const char* what);
  ByteView array(std::size_t width);
  void skip_flat(NbtType type);

  ByteView in_;
  std::size_t at_ = 0;
  std::uint64_t base_ = 0;  // bytes of the stream before in_
  NbtSource* source_ = nullptr;
  bool failed_ = false;
  Error error_{};
};

/// Returns the text of modified UTF-8, in which NUL has two bytes and a character above U+FFFF is a pair
/// of surrogates of three bytes each. Bytes that are no such thing stay as they are.
std::string from_modified_utf8(std::string_view text);
/// Returns UTF-8 as modified UTF-8. Bytes that are no UTF-8 stay as they are.
std::string to_modified_utf8(std::string_view text);

}  // namespace runstone
