#include "server/import/mapped_parts.hpp"

#include <utility>

#include "common/formats/mapped_build.hpp"

namespace runstone {
Result<std::optional<ImportPart>, std::string> MappedParts::read(std::size_t index,
                                                                 ImportFaults& faults) {
  auto part = parts_->read(index, faults);
  if (!part || !*part) return part;
  auto build = mapped_build((*part)->build, map_, applied_, kPartBytesMax);
  if (!build) return failure("the map of materials: " + std::string(build.error().what));
  (*part)->build = *std::move(build);
  return part;
}

}  // namespace runstone
