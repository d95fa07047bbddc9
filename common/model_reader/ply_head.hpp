// The head of a .ply: which elements it has, and which numbers each of them has.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

enum class PlyBody : std::uint8_t { text, little_endian, big_endian };
enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

/// Returns 1, 2, 4 or 8.
std::size_t ply_bytes(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;  // of a value
  bool is_list = false;         // a count, and so many values
  PlyType count_type = PlyType::u8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHead {
  PlyBody body = PlyBody::text;
  std::vector<PlyElement> elements;
  std::string texture;  // a comment "TextureFile x", as many programs write it; or empty
};

/// Reads the lines of a head, up to "end_header". `next_line` gives one without its end, or false.
/// Fails with one line if the head is bad or has more than 10,000 lines, 64 elements, or 256 properties
/// of one.
Result<PlyHead, std::string> read_ply_head(const std::function<bool(std::string&)>& next_line);

}  // namespace runstone
