#include "server/admin/border_setting.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "server/admin/word_reader.hpp"

namespace runstone {

namespace {

constexpr const char* kBorderRule =
    "must be x and z of two opposite columns, or x y z of two opposite corners, all inside, as in "
    "\"-500 -500 499 499\", or a circle, as in \"circle 0 0 500\"";
constexpr const char* kBorderBlanks = " ,";

/// Reads whole numbers, separated by blanks or commas.
Result<std::vector<std::int32_t>, std::string> border_numbers(std::string_view text) {
  std::vector<std::int32_t> numbers;
  for (std::size_t at = text.find_first_not_of(kBorderBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBorderBlanks, at), text.size());
    const auto number = number_of<std::int32_t>(text.substr(at, end - at));
    if (!number) return failure(std::string(kBorderRule));
    if (*number < -kWorldLimit || *number >= kWorldLimit)
      return failure("has " + std::to_string(*number) + ", which is outside every world");
    numbers.push_back(*number);
    at = text.find_first_not_of(kBorderBlanks, end);
  }
  return numbers;
}

}  // namespace

Result<std::optional<WorldBorder>, std::string> parse_border(const std::string& text) {
  constexpr std::string_view kCircle = "circle";
  std::string_view rest = text;
  rest.remove_prefix(std::min(rest.find_first_not_of(kBorderBlanks), rest.size()));
  const bool is_circle = rest.starts_with(kCircle);
  if (is_circle) rest.remove_prefix(kCircle.size());
  auto read = border_numbers(rest);
  if (!read) return failure(read.error());
  std::vector<std::int32_t> numbers = *std::move(read);
  if (is_circle) {
    if (numbers.size() != 3) return failure(std::string(kBorderRule));
    if (numbers[2] < 1) return failure("has a circle with a radius below 1: nobody could edit");
    return std::optional<WorldBorder>(BorderCircle{numbers[0], numbers[1], numbers[2]});
  }
  if (numbers.empty()) return std::optional<WorldBorder>();
  if (numbers.size() == 4) {
    numbers = {numbers[0], -kWorldLimit, numbers[1], numbers[2], kWorldLimit - 1, numbers[3]};
  }
  if (numbers.size() != 6) return failure(std::string(kBorderRule));
  for (std::size_t i = 0; i < 3; ++i) {
    if (numbers[i] > numbers[i + 3]) std::swap(numbers[i], numbers[i + 3]);
  }
  return std::optional<WorldBorder>(VoxelBox{{numbers[0], numbers[1], numbers[2]},
                                             {numbers[3] + 1, numbers[4] + 1, numbers[5] + 1}});
}

std::string border_setting_text(const std::optional<WorldBorder>& border) {
  if (!border) return "";
  if (std::holds_alternative<BorderCircle>(*border)) return border_words(*border);
  const auto& box = std::get<VoxelBox>(*border);
  const auto corner = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    const std::string height = has_all_heights(box) ? "" : " " + std::to_string(y);
    return std::to_string(x) + height + " " + std::to_string(z);
  };
  return corner(box.min.x, box.min.y, box.min.z) + " " +
         corner(box.max.x - 1, box.max.y - 1, box.max.z - 1);
}

}  // namespace runstone
