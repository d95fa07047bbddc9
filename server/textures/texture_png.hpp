// Pictures of files as textures: pictures of other sizes are cut and scaled, and those that lie
// over each other become one. Thread: any.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The pixels of a file, at most.
inline constexpr std::uint32_t kPicturePixelsMax = 1U << 22;

/// Returns the PNG of a texture. `layers` are PNG files, the lowest first. A single file that is a
/// texture already stays as it is. Otherwise:
///   - of a picture that is higher than wide, as animations are, the first square is taken;
///   - a picture of fewer than 16 pixels a side is repeated, and one of more than 64 averaged;
///   - further layers lie over the first one, if they have its size, and are left out otherwise.
/// `tint`: the average colour that the picture gets. Fails with words if the lowest layer is no
/// PNG, is damaged, has too many pixels or sides that do not fit. Cost: O(pixels).
Result<Bytes, std::string> texture_png(std::span<const Bytes> layers,
                                       std::optional<std::array<std::uint8_t, 3>> tint);

}  // namespace runstone
