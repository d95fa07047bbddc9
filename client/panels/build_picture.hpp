// The picture of a build in the window of the library: the build from above one of its edges, as the
// icons of materials show a block. Pure.
#pragma once
#include <memory>
#include <span>

#include "client/render/overlay_frame.hpp"
#include "common/builds/build.hpp"
#include "common/core/material_row.hpp"

namespace runstone {

/// The greatest width and height of a picture, in pixels.
inline constexpr int kBuildPicturePixels = 256;

/// Returns the picture; its ground is transparent. `rows` are the materials of the palette, by entry. A
/// build with a side of more than kBuildPictureCells is drawn in coarser cells. Each of them has the
/// material of one of at most eight cells that are looked up in it, so thin parts of a large build
/// may be missing. Cost: O(coarse cells * log), at most about 2 million look-ups.
std::shared_ptr<const OverlayImage> build_picture(const Build& build,
                                                  std::span<const MaterialRow> rows);
inline constexpr std::int32_t kBuildPictureCells = 64;

}  // namespace runstone
