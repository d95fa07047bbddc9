#include "server/admin/border_setting.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "server/admin/word_reader.hpp"
#include "server/world/environment/world_border.hpp"

namespace runstone {

Result<std::optional<VoxelBox>, std::string> parse_border(const std::string& text) {
  constexpr const char* kRule =
      "must be x and z of two opposite columns, or x y z of two opposite corners, all inside, as in "
      "\"-500 -500 499 499\"";
  std::vector<std::int32_t> numbers;
  for (std::size_t at = text.find_first_not_of(" ,"); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(" ,", at), text.size());
    const auto number = number_of<std::int32_t>(std::string_view(text).substr(at, end - at));
    if (!number) return failure(std::string(kRule));
    if (*number < -kWorldLimit || *number >= kWorldLimit)
      return failure("has " + std::to_string(*number) + ", which is outside every world");
    numbers.push_back(*number);
    at = text.find_first_not_of(" ,", end);
  }
  if (numbers.empty()) return std::optional<VoxelBox>();
  if (numbers.size() == 4) {
    numbers = {numbers[0], -kWorldLimit, numbers[1], numbers[2], kWorldLimit - 1, numbers[3]};
  }
  if (numbers.size() != 6) return failure(std::string(kRule));
  for (std::size_t i = 0; i < 3; ++i) {
    if (numbers[i] > numbers[i + 3]) std::swap(numbers[i], numbers[i + 3]);
  }
  return std::optional(VoxelBox{{numbers[0], numbers[1], numbers[2]},
                                {numbers[3] + 1, numbers[4] + 1, numbers[5] + 1}});
}

std::string border_setting_text(const std::optional<VoxelBox>& border) {
  if (!border) return "";
  const auto corner = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    const std::string height = has_all_heights(*border) ? "" : " " + std::to_string(y);
    return std::to_string(x) + height + " " + std::to_string(z);
  };
  return corner(border->min.x, border->min.y, border->min.z) + " " +
         corner(border->max.x - 1, border->max.y - 1, border->max.z - 1);
}

}  // namespace runstone
