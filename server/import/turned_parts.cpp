#include "server/import/turned_parts.hpp"

#include <array>
#include <cstdint>

#include "common/formats/file_build_turn.hpp"
#include "common/formats/turned_names.hpp"

namespace runstone {
Result<std::optional<ImportPart>, std::string> TurnedParts::read(std::size_t index,
                                                                 ImportFaults& faults) {
  auto part = parts_->read(index, faults);
  if (!part || !*part) return part;
  auto turned = turned_file_build((*part)->build, orientation_, kPartBytesMax);
  if (!turned) return failure("the build cannot be turned: " + std::string(turned.error().what));
  (*part)->build = std::move(turned->build);
  stuck_ = turned->stuck;
  const VoxelPos at = (*part)->at, sides = (*part)->build.build->sides();
  const std::array<std::pair<std::int64_t, std::int64_t>, 3> axes = {
      {{at.x, sides.x}, {at.y, sides.y}, {at.z, sides.z}}};
  for (const auto& [low, side] : axes) {
    if (low + side > kWorldLimit)
      return failure(std::string("the turned build does not lie in the world at this place"));
  }
  return part;
}

std::vector<std::string> TurnedParts::notices() const {
  std::vector<std::string> out = parts_->notices();
  if (auto notice = stuck_notice(stuck_); !notice.empty()) out.push_back(std::move(notice));
  return out;
}

}  // namespace runstone
