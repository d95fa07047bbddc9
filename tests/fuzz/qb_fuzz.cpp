// The target reads any bytes as a .qb. Whatever is read is a valid build.
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/formats/build_of_file.hpp"
#include "common/formats/look_material.hpp"
#include "common/formats/qb.hpp"

using namespace runstone;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Format format{"qb", ".qb", read_qb, material_of_look};
  const auto build = read_foreign_build(format, {data, size}, {.bytes_max = std::size_t{8} << 20});
  if (!build) {
    RUNSTONE_ASSERT(build.error().what[0] != '\0');
    return 0;
  }
  RUNSTONE_ASSERT(validate_build_materials(build->materials).has_value());
  return 0;
}
