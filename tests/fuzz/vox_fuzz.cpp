// The target reads any bytes as a .vox. Whatever is read as a build and fits a .vox is written, and
// has equal voxels when it is read again.
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/build_of_file.hpp"
#include "common/formats/look_material.hpp"
#include "common/formats/vox.hpp"

using namespace runstone;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Format format{"vox", ".vox", read_vox, material_of_look, write_vox};
  const ForeignReading reading{.bytes_max = std::size_t{8} << 20};
  const auto build = read_foreign_build(format, {data, size}, reading);
  if (!build) {
    RUNSTONE_ASSERT(build.error().what[0] != '\0');
    return 0;
  }
  RUNSTONE_ASSERT(validate_build_materials(build->materials).has_value());
  // Scenes of hardly any voxels may be large.
  if (build->build->volume() > (1U << 24) || build->build->solid() > 100'000) return 0;
  Bytes file;
  const auto written = write_vox(*build, [&](ByteView bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
    return true;
  });
  RUNSTONE_ASSERT(written.has_value());
  const auto again = read_foreign_build(format, file, reading);
  if (!again) RUNSTONE_ASSERT(again.error().code == ErrorCode::limit_exceeded);
  if (again) {
    RUNSTONE_ASSERT(again->build->solid() == build->build->solid());
    RUNSTONE_ASSERT(again->materials == build->materials);
  }
  return 0;
}
