// Little-endian byte reader and writer, with the one varint of this project. A varint has 7 bits a
// byte, low bits first; the high bit is set if another byte follows. Only the shortest encoding is
// accepted, so equal values have equal bytes. Signed values are zigzag-coded first.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

constexpr std::uint64_t zigzag(std::int64_t v) {
  return (static_cast<std::uint64_t>(v) << 1) ^ static_cast<std::uint64_t>(v >> 63);
}
constexpr std::int64_t unzigzag(std::uint64_t v) {
  return static_cast<std::int64_t>(v >> 1) ^ -static_cast<std::int64_t>(v & 1);
}

/// Returns the bytes of a varint, 1 .. 10.
constexpr std::size_t varint_size(std::uint64_t v) {
  return (static_cast<std::size_t>(std::bit_width(v | 1)) + 6) / 7;
}

/// Appends to a byte vector. Never fails.
class ByteWriter {
 public:
  explicit ByteWriter(Bytes& out) : out_(out) {}
  void u8(std::uint8_t v) { out_.push_back(v); }
  void u16(std::uint16_t v) { little_endian(v, 2); }
  void u32(std::uint32_t v) { little_endian(v, 4); }
  void u64(std::uint64_t v) { little_endian(v, 8); }
  /// Writes the bits of an IEEE 754 number as a u64.
  void f64(double v) {
    std::uint64_t bits;
    std::memcpy(&bits, &v, sizeof bits);
    u64(bits);
  }
  void varint(std::uint64_t v) {
    for (; v >= 0x80; v >>= 7) out_.push_back(static_cast<std::uint8_t>(v | 0x80));
    out_.push_back(static_cast<std::uint8_t>(v));
  }
  void svarint(std::int64_t v) { varint(zigzag(v)); }
  void bytes(ByteView v) { out_.insert(out_.end(), v.begin(), v.end()); }

 private:
  void little_endian(std::uint64_t v, int count) {
    for (int i = 0; i < count; ++i) out_.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  }
  Bytes& out_;
};

/// Reads forward through a view and checks every bound. After the first failure every read fails,
/// so a caller can read a whole record and check ok() once. error() holds the offset of the first
/// failure.
class ByteReader {
 public:
  explicit ByteReader(ByteView in) : in_(in) {}

  bool ok() const { return !failed_; }
  bool at_end() const { return at_ == in_.size(); }
  std::size_t offset() const { return at_; }
  std::size_t left() const { return in_.size() - at_; }
  const Error& error() const { return error_; }

  std::uint8_t u8() { return static_cast<std::uint8_t>(little_endian(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(little_endian(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(little_endian(4)); }
  std::uint64_t u64() { return little_endian(8); }
  double f64() {
    const std::uint64_t bits = u64();
    double v;
    std::memcpy(&v, &bits, sizeof v);
    return v;
  }
  std::uint64_t varint() {
    const bool is_one_byte = !failed_ && at_ < in_.size() && in_[at_] < 0x80;
    return is_one_byte ? in_[at_++] : long_varint();
  }
  std::int64_t svarint() { return unzigzag(varint()); }
  /// Reads a varint. Fails if it exceeds `max`.
  std::uint64_t varint_max(std::uint64_t max, const char* what) {
    const std::uint64_t v = varint();
    if (v <= max) return v;
    reject(ErrorCode::bad_value, what);
    return 0;
  }
  /// Reads a signed varint. Fails if it lies outside [low, high].
  std::int64_t svarint_in(std::int64_t low, std::int64_t high, const char* what);
  ByteView bytes(std::size_t count);
  /// Marks the input as bad. It is for a value that decodes but is not allowed.
  void reject(ErrorCode code, const char* what);
  /// Returns success if every read succeeded and no byte is left over.
  Result<void> finish();

 private:
  std::uint64_t little_endian(int count);
  std::uint64_t long_varint();
  ByteView in_;
  std::size_t at_ = 0;
  bool failed_ = false;
  Error error_{};
};

}  // namespace runstone
