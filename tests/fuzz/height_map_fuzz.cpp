// The target reads any bytes as a height map, as a colour map, and as both with corrected checksums,
// which random chunks would hardly ever have. Whatever is read is a valid build.
#include <zlib.h>

#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/build_of_file.hpp"
#include "common/formats/height_map.hpp"
#include "common/formats/look_material.hpp"

using namespace runstone;

namespace {

void read(ByteView file) {
  const Format format{"png", ".png", read_height_map, material_of_look};
  const auto build = read_foreign_build(format, file, {.bytes_max = std::size_t{8} << 20});
  if (build) RUNSTONE_ASSERT(validate_build_materials(build->materials).has_value());
  if (!build) RUNSTONE_ASSERT(build.error().what[0] != '\0');
  const auto both =
      read_height_map(file, file, {9, 7, "stone"}, [](ForeignPiece&& piece) -> Result<void> {
        RUNSTONE_ASSERT(validate_runs(piece.voxels).has_value());
        return {};
      });
  if (!both) RUNSTONE_ASSERT(both.error().what[0] != '\0');
}

/// Corrects the checksum of each chunk.
void mend_png(Bytes& file) {
  const auto number = [&](std::size_t at) {
    return static_cast<std::uint32_t>(file[at] << 24 | file[at + 1] << 16 | file[at + 2] << 8 |
                                      file[at + 3]);
  };
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t bytes = number(at);
    if (bytes > file.size() - at - 12) return;
    const auto sum = crc32_z(0, file.data() + at + 4, bytes + 4);
    for (unsigned i = 0; i < 4; ++i)
      file[at + 8 + bytes + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    at += 12 + bytes;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes file(data, data + size);
  // Pictures of many pixels take long, and show nothing new.
  if (size > 24 && (data[18] > 0 || data[22] > 0 || data[17] > 0 || data[21] > 0)) return 0;
  read(file);
  mend_png(file);
  read(file);
  return 0;
}
