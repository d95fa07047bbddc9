#include "common/core/bytes.hpp"

namespace runstone {

void ByteReader::reject(ErrorCode code, const char* what) {
  if (failed_) return;
  failed_ = true;
  error_ = Error{code, what, at_};
}

std::uint64_t ByteReader::little_endian(int count) {
  const auto bytes_needed = static_cast<std::size_t>(count);
  if (failed_ || left() < bytes_needed) {
    reject(ErrorCode::truncated, "input ends inside a fixed-width integer");
    return 0;
  }
  std::uint64_t v = 0;
  for (std::size_t i = 0; i < bytes_needed; ++i)
    v |= static_cast<std::uint64_t>(in_[at_ + i]) << (8 * i);
  at_ += bytes_needed;
  return v;
}

std::uint64_t ByteReader::long_varint() {
  if (failed_) return 0;
  std::uint64_t v = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    if (at_ == in_.size()) {
      reject(ErrorCode::truncated, "input ends inside a varint");
      return 0;
    }
    const std::uint8_t byte = in_[at_];
    if (shift == 63 && byte > 1) break;
    v |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    ++at_;
    if ((byte & 0x80) == 0) {
      if (byte == 0 && shift != 0) reject(ErrorCode::not_canonical, "varint is longer than needed");
      return failed_ ? 0 : v;
    }
  }
  reject(ErrorCode::bad_value, "varint exceeds 64 bits");
  return 0;
}

std::int64_t ByteReader::svarint_in(std::int64_t low, std::int64_t high, const char* what) {
  const std::int64_t v = svarint();
  if (!failed_ && (v < low || v > high)) reject(ErrorCode::bad_value, what);
  return failed_ ? low : v;
}

ByteView ByteReader::bytes(std::size_t count) {
  if (failed_ || left() < count) {
    reject(ErrorCode::truncated, "input ends inside a byte string");
    return {};
  }
  const ByteView out = in_.subspan(at_, count);
  at_ += count;
  return out;
}

Result<void> ByteReader::finish() {
  if (!failed_ && !at_end()) reject(ErrorCode::trailing_bytes, "bytes left over");
  if (failed_) return failure(error_);
  return {};
}

}  // namespace runstone
