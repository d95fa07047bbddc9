// NbtWriter: appends named binary tags (big-endian) to a byte vector. The caller keeps the structure
// right: every compound is ended, and a list gets as many values of its type as its head says.
//   NbtWriter out(bytes);
//   out.compound("");
//   out.i16("Width", 3);
//   out.list("Names", NbtType::string, 1);
//   out.string_value("stone");
//   out.end();
// A caller may take the bytes away between two calls, so a file need not be in memory as a whole.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "common/formats/nbt_reader.hpp"

namespace runstone {

class NbtWriter {
 public:
  explicit NbtWriter(Bytes& out) : out_(out) {}

  // Entries of a compound. Names and texts are UTF-8, are written as modified UTF-8, and are at most
  // 65,535 bytes long then.
  void i8(std::string_view name, std::int8_t v) { entry(NbtType::i8, name), big_endian(v); }
  void i16(std::string_view name, std::int16_t v) { entry(NbtType::i16, name), big_endian(v); }
  void i32(std::string_view name, std::int32_t v) { entry(NbtType::i32, name), big_endian(v); }
  void i64(std::string_view name, std::int64_t v) { entry(NbtType::i64, name), big_endian(v); }
  void string(std::string_view name, std::string_view text) {
    entry(NbtType::string, name);
    string_value(text);
  }
  void int_array(std::string_view name, std::span<const std::int32_t> values);
  /// Begins an array. The caller appends its bytes: `count` elements in big-endian.
  void array(std::string_view name, NbtType type, std::int32_t count) {
    entry(type, name);
    big_endian(count);
  }
  /// Begins a compound, also the outermost one. end() ends it.
  void compound(std::string_view name) { entry(NbtType::compound, name); }
  void end() { out_.push_back(0); }
  /// Begins a list. The caller writes `count` values of the type.
  void list(std::string_view name, NbtType type, std::int32_t count);

  // Values of a list. A compound in a list has no head; end() ends it.
  void string_value(std::string_view text);
  void i32_value(std::int32_t v) { big_endian(v); }
  void i64_value(std::int64_t v) { big_endian(v); }

 private:
  void entry(NbtType type, std::string_view name) {
    out_.push_back(static_cast<std::uint8_t>(type));
    string_value(name);
  }
  template <class T>
  void big_endian(T v) {
    const T swapped = big_endian_at<T>(reinterpret_cast<const std::uint8_t*>(&v));
    const auto* at = reinterpret_cast<const std::uint8_t*>(&swapped);
    out_.insert(out_.end(), at, at + sizeof v);
  }
  Bytes& out_;
};

}  // namespace runstone
