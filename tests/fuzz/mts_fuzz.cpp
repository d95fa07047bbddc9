// The target reads any bytes as an .mts in two ways: the bytes as a whole file, and as a head whose
// nodes are packed afterwards, which random streams would hardly ever reach. Whatever is read as a
// build is written, and has as many voxels when it is read again.
#include <zlib.h>

#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/build_of_file.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/formats/mts.hpp"

using namespace runstone;

namespace {

const Format kSchematic{"mts", ".mts", read_mts, material_of_luanti_node, write_mts};

void read(ByteView file) {
  const ForeignReading reading{.bytes_max = std::size_t{8} << 20};
  const auto build = read_foreign_build(kSchematic, file, reading);
  if (!build) {
    RUNSTONE_ASSERT(build.error().what[0] != '\0');
    return;
  }
  RUNSTONE_ASSERT(validate_build_materials(build->materials).has_value());
  if (build->build->volume() > (1U << 18)) return;
  Bytes out;
  const auto written = write_mts(*build, [&](ByteView bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
    return true;
  });
  RUNSTONE_ASSERT(written.has_value());
  const auto again = read_foreign_build(kSchematic, out, reading);
  RUNSTONE_ASSERT(again.has_value());
  RUNSTONE_ASSERT(again->build->touched() == build->build->touched());
  RUNSTONE_ASSERT(again->build->solid() == build->build->solid());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read({data, size});
  if (size == 0 || data[0] >= size) return 0;
  // The first byte is the length of the head.
  const std::size_t head = data[0];
  Bytes file(data + 1, data + 1 + head);
  const ByteView nodes(data + 1 + head, size - 1 - head);
  Bytes packed(compressBound(nodes.size()));
  uLongf packed_bytes = packed.size();
  RUNSTONE_ASSERT(compress(packed.data(), &packed_bytes, nodes.data(), nodes.size()) == Z_OK);
  file.insert(file.end(), packed.begin(),
              packed.begin() + static_cast<std::ptrdiff_t>(packed_bytes));
  read(file);
  return 0;
}
