// The part of the interface for Inspection: the boxes that switch its modes, and the legend of its
// colours.
#pragma once
#include "client/input/key_map.hpp"
#include "client/render/inspection.hpp"

namespace runstone {

/// Adds a box for each mode, with its key, to the window that is being made with ImGui.
void build_inspection_boxes(const KeyMap& keys, InspectionModes& modes);
/// Makes a window with the meaning of the colours of the modes that are on. Makes no window if no
/// mode is on.
void build_inspection_legend(const InspectionModes& modes, double scale);

}  // namespace runstone
