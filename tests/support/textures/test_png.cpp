#include "tests/support/textures/test_png.hpp"

#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <string_view>

namespace runstone::test {
namespace {

void add_number(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void add_chunk(Bytes& out, std::string_view name, const Bytes& data) {
  add_number(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t checked = out.size();
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), data.begin(), data.end());
  add_number(out,
             static_cast<std::uint32_t>(crc32_z(0, out.data() + checked, out.size() - checked)));
}

}  // namespace

Bytes bytes_of(const TestPng& png) {
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  Bytes head;
  add_number(head, png.width);
  add_number(head, png.height);
  head.insert(head.end(), {png.bits, png.type, 0, 0, 0});
  add_chunk(out, "IHDR", head);
  if (!png.palette.empty()) add_chunk(out, "PLTE", png.palette);
  uLongf size = compressBound(static_cast<uLong>(png.rows.size()));
  Bytes packed(size);
  compress2(packed.data(), &size, png.rows.data(), static_cast<uLong>(png.rows.size()), 9);
  packed.resize(size);
  add_chunk(out, "IDAT", packed);
  add_chunk(out, "IEND", {});
  return out;
}

Bytes plain_png(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 4> rgba) {
  TestPng png{width, height};
  for (std::uint32_t y = 0; y < height; ++y) {
    png.rows.push_back(0);
    for (std::uint32_t x = 0; x < width; ++x)
      png.rows.insert(png.rows.end(), rgba.begin(), rgba.end());
  }
  return bytes_of(png);
}

void write_file(const std::string& path, const Bytes& bytes) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace runstone::test
