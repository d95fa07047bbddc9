// Caption: a title and lines of text in a corner of a picture, in the font of the interface.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "client/render/overlay_frame.hpp"
#include "client/ui/ui_context.hpp"

namespace runstone {

struct Caption {
  std::string title;
  std::vector<std::string> lines;
};

/// Returns an overlay of `size` pixels with the caption in its upper left corner.
std::shared_ptr<const OverlayFrame> caption_frame(UiContext& context, const Caption& caption,
                                                  std::array<int, 2> size);

}  // namespace runstone
