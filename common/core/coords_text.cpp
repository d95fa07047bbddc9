#include "common/core/coords_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <system_error>

namespace runstone {
namespace {

/// Returns N coordinates with commas between them, or nullopt.
template <std::size_t N>
std::optional<std::array<std::int32_t, N>> parse_coordinates(std::string_view text) {
  std::array<std::int32_t, N> out{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out[i]);
    if (error != std::errc() || out[i] < -kWorldLimit || out[i] >= kWorldLimit) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const bool is_last = i + 1 == N;
    if (is_last != text.empty() || (!is_last && text.front() != ',')) return std::nullopt;
    if (!is_last) text.remove_prefix(1);
  }
  return out;
}

}  // namespace

std::optional<VoxelPos> parse_voxel_pos(std::string_view text) {
  const auto at = parse_coordinates<3>(text);
  if (!at) return std::nullopt;
  return VoxelPos{(*at)[0], (*at)[1], (*at)[2]};
}

std::optional<VoxelBox> parse_voxel_box(std::string_view text) {
  const auto at = parse_coordinates<6>(text);
  if (!at) return std::nullopt;
  const auto low = [&](std::size_t axis) { return std::min((*at)[axis], (*at)[axis + 3]); };
  const auto high = [&](std::size_t axis) { return std::max((*at)[axis], (*at)[axis + 3]) + 1; };
  return VoxelBox{{low(0), low(1), low(2)}, {high(0), high(1), high(2)}};
}

}  // namespace runstone
