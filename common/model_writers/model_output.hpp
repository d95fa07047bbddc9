// ModelOutput: the bytes and texts of a file on their way to a sink, in blocks of 64 KiB.
#pragma once
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <type_traits>

#include "common/core/bytes.hpp"

namespace runstone {

/// Takes the next bytes of a file. Returns false if they cannot be written, which ends the writing.
using ModelSink = std::function<bool(ByteView)>;

class ModelOutput {
 public:
  explicit ModelOutput(const ModelSink& sink) : sink_(sink) {}
  ModelOutput(const ModelOutput&) = delete;
  ModelOutput& operator=(const ModelOutput&) = delete;

  /// Returns false if the sink failed. What follows is dropped then.
  bool ok() const { return !failed_; }
  std::uint64_t size() const { return size_; }

  void bytes(ByteView v) {
    size_ += v.size();
    if (failed_) return;
    buffer_.insert(buffer_.end(), v.begin(), v.end());
    if (buffer_.size() >= kBlock) flush();
  }
  void u8(std::uint8_t v) { bytes({&v, 1}); }
  void u16(std::uint16_t v) { little_endian(v); }
  void u32(std::uint32_t v) { little_endian(v); }
  void f32(float v) { little_endian(std::bit_cast<std::uint32_t>(v)); }
  void text(std::string_view v) {
    bytes({reinterpret_cast<const std::uint8_t*>(v.data()), v.size()});
  }
  /// Writes a number as text: an integer, or the shortest text that reads back as the same
  /// fraction.
  template <class T>
  void number(T v) {
    static_assert(std::is_arithmetic_v<T>);
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, v).ptr;
    text({digits, static_cast<std::size_t>(end - digits)});
  }
  /// Writes a fraction with six significant digits.
  void rounded(double v) {
    char digits[32];
    const auto end =
        std::to_chars(digits, digits + sizeof digits, v, std::chars_format::general, 6).ptr;
    text({digits, static_cast<std::size_t>(end - digits)});
  }
  /// Gives everything to the sink. Returns ok().
  bool flush() {
    if (!failed_ && !buffer_.empty()) failed_ = !sink_(buffer_);
    buffer_.clear();
    return !failed_;
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 16;

  template <class T>
  void little_endian(T v) {
    std::uint8_t out[sizeof v];
    for (std::size_t i = 0; i < sizeof v; ++i) out[i] = static_cast<std::uint8_t>(v >> (8 * i));
    bytes(out);
  }

  const ModelSink& sink_;
  Bytes buffer_;
  std::uint64_t size_ = 0;
  bool failed_ = false;
};

}  // namespace runstone
