// The head of an array of numpy. Every byte that is read is untrusted.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/inflate_source.hpp"

namespace runstone {

inline constexpr std::size_t kNpyAxesMax = 8;

struct NpyHeader {
  char kind = 'u';               // as numpy has it: b, u, i, S, U
  std::uint32_t item_bytes = 1;  // of a U: 4 a character
  bool is_big_endian = false;
  bool is_fortran = false;
  std::vector<std::uint64_t> shape;  // at most kNpyAxesMax sides

  /// Returns the number of items, or 2^63 if it is greater.
  std::uint64_t items() const;
  bool is_integer() const { return kind == 'u' || kind == 'i' || kind == 'b'; }
};

/// Reads the head, and leaves the source at the first item. `bytes_max` is what the source holds at
/// most. Fails if it is none, or has a type that NpyHeader does not know. The offset of an error is a
/// byte of the packed source.
Result<NpyHeader> read_npy_header(InflateSource& source, std::uint64_t bytes_max);

/// Returns the head of an array in C order, version 1. `type` is such as "|u1". Requires few sides.
Bytes npy_header(const std::string& type, std::span<const std::uint64_t> shape);

}  // namespace runstone
