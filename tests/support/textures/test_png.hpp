// PNGs for tests: sound ones, and ones whose head lies.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "common/core/bytes.hpp"

namespace runstone::test {

/// The head of a PNG and its unpacked rows, each behind the number of its filter.
struct TestPng {
  std::uint32_t width = 16, height = 16;
  std::uint8_t bits = 8, type = 6;  // RGBA
  Bytes rows = {};
  Bytes palette = {};  // three bytes each
};

/// Returns the file.
Bytes bytes_of(const TestPng& png);

/// Returns a PNG of one colour.
Bytes plain_png(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 4> rgba);

void write_file(const std::string& path, const Bytes& bytes);

}  // namespace runstone::test
