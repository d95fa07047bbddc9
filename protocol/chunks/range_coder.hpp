// Adaptive binary range coder: it codes bits with probabilities that follow the bits before.
// docs/protocol.md has the arithmetic step by step. A sequence of bits has exactly one spelling;
// the decoder rejects every other one. Source: Martin 1979; the carry and the shifts as in LZMA
// (Pavlov).
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The probability that a bit is 1, in 65536ths, and the shift of its updates. The first bits move
/// it most.
struct AdaptiveBit {
  std::uint16_t one = 1u << 15;
  std::uint16_t shift = 1;

  void learn(bool bit) {
    // Stays within 15 .. 65521: from there the step is 0.
    one = static_cast<std::uint16_t>(bit ? one + ((65536u - one) >> shift) : one - (one >> shift));
    shift = static_cast<std::uint16_t>(shift + (shift < 4 ? 1 : 0));
  }
};

class RangeEncoder {
 public:
  /// Appends to `out`.
  explicit RangeEncoder(Bytes& out) : out_(out) {}

  bool code(AdaptiveBit& model, bool bit) {
    const std::uint32_t bound = (range_ >> 16) * model.one;
    if (bit) {
      range_ = bound;
    } else {
      low_ += bound;
      if (low_ < bound) carry();
      range_ -= bound;
    }
    model.learn(bit);
    while (range_ < kRangeMin) {
      out_.push_back(static_cast<std::uint8_t>(low_ >> 24));
      low_ <<= 8;
      range_ <<= 8;
    }
    return bit;
  }

  /// Writes the last byte: that of the lowest number in the range whose three further bytes are 0.
  void finish() {
    const std::uint32_t last = low_ + (kRangeMin - 1);
    if (last < low_) carry();
    out_.push_back(static_cast<std::uint8_t>(last >> 24));
  }

 private:
  static constexpr std::uint32_t kRangeMin = 1u << 24;

  /// Adds one to the bytes written. They are a fraction below 1, so the carry stops at a byte of
  /// this encoder.
  void carry() {
    std::size_t at = out_.size();
    while (++out_[--at] == 0) {
    }
  }

  Bytes& out_;
  std::uint32_t low_ = 0, range_ = 0xffffffff;
};

class RangeDecoder {
 public:
  explicit RangeDecoder(ByteView in) : at_(in.data()), end_(in.data() + in.size()) {
    for (int i = 0; i < 4; ++i) next_byte();
    above_ = code_ >= range_;
  }

  bool code(AdaptiveBit& model, bool /*unknown*/) {
    const std::uint32_t bound = (range_ >> 16) * model.one;
    const bool bit = code_ < bound;
    range_ = bit ? bound : range_ - bound;
    code_ -= bit ? 0 : bound;
    model.learn(bit);
    while (range_ < kRangeMin) {
      range_ <<= 8;
      next_byte();
    }
    return bit;
  }

  /// Returns true if more bytes were read than there are. The bits decoded since then are
  /// arbitrary.
  bool overrun() const { return zeros_ > kZeros; }

  /// Fails unless the input is exactly what an encoder writes for the decoded bits.
  Result<void> finish() const {
    if (overrun()) return fail(ErrorCode::truncated, "body ends inside its runs");
    if (at_ != end_ || zeros_ != kZeros)
      return fail(ErrorCode::trailing_bytes, "bytes follow the runs");
    if (above_ || code_ >= kRangeMin)
      return fail(ErrorCode::not_canonical, "body does not end as an encoder ends it");
    return {};
  }

 private:
  static constexpr std::uint32_t kRangeMin = 1u << 24;
  static constexpr unsigned kZeros = 3;  // bytes that the encoder leaves out

  void next_byte() {
    code_ <<= 8;
    if (at_ != end_) {
      code_ |= *at_++;
    } else {
      ++zeros_;
    }
  }

  const std::uint8_t *at_, *end_;
  std::uint32_t code_ = 0, range_ = 0xffffffff;
  unsigned zeros_ = 0;
  bool above_ = false;  // the first code was outside the range, and stays outside
};

}  // namespace runstone
