// Small helpers for windows that are made with ImGui. Only sources of client/ui include this file.
#pragma once
#include <imgui.h>

#include <string>
#include <string_view>

#include "common/core/material_row.hpp"

namespace runstone {

/// Flags of a window that only shows something: it takes no input and has no frame.
inline constexpr ImGuiWindowFlags kShowOnly =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;

/// Draws text with a dark shadow, so that it can be read over any ground. `alpha` is 0 to 1.
void shadowed_text(ImDrawList& list, ImVec2 at, ImU32 colour, std::string_view text,
                   double alpha = 1);
/// Returns the width of a text in pixels.
float width_of(std::string_view text);
/// Returns an opaque colour of a material, in ImGui's form.
ImU32 opaque_colour(const MaterialColour& colour);
/// Draws a swatch of a material: its colour, lighter above and darker below. A transparent material
/// shows a light ground through it.
void swatch(ImDrawList& list, ImVec2 from, ImVec2 to, const MaterialColour& colour);
/// Returns the name for people: without the part before a colon, with blanks for underscores.
std::string short_name(std::string_view name);

}  // namespace runstone
