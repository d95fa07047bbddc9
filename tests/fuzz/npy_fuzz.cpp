// The target reads any bytes as an .npy and as an .npz. Whatever is read as a build is written as an
// .npz, and is equal when it is read again.
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/build_of_file.hpp"
#include "common/formats/look_material.hpp"
#include "common/formats/npy.hpp"

using namespace runstone;

namespace {

const Format kArrays[] = {{"npy", ".npy", read_npy, material_of_look, write_npy},
                          {"npz", ".npz", read_npz, material_of_look, write_npz}};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ForeignReading reading{.bytes_max = std::size_t{8} << 20};
  for (const Format& format : kArrays) {
    const auto build = read_foreign_build(format, {data, size}, reading);
    if (!build) {
      RUNSTONE_ASSERT(build.error().what[0] != '\0');
      continue;
    }
    RUNSTONE_ASSERT(validate_build_materials(build->materials).has_value());
    if (build->build->volume() > (1U << 20)) continue;
    Bytes file;
    const auto written = write_npz(*build, [&](ByteView bytes) {
      file.insert(file.end(), bytes.begin(), bytes.end());
      return true;
    });
    RUNSTONE_ASSERT(written.has_value());
    const auto again = read_foreign_build(kArrays[1], file, reading);
    RUNSTONE_ASSERT(again.has_value());
    RUNSTONE_ASSERT(again->build->touched() == build->build->touched());
    RUNSTONE_ASSERT(again->build->solid() == build->build->solid());
    RUNSTONE_ASSERT(again->materials.size() == build->materials.size());
  }
  return 0;
}
