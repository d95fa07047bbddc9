// Small helpers for windows that are made with ImGui. Only sources of client/ui include this file.
#pragma once
#include <imgui.h>

#include <string_view>

#include "common/core/material_row.hpp"

namespace runstone {

/// Flags of a window that only shows something: it takes no input and has no frame.
inline constexpr ImGuiWindowFlags kShowOnly =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;

/// Draws text with a dark shadow, so that it can be read over any background. `alpha` is 0 to 1.
/// Lines are wrapped to `wrap` pixels; 0 wraps nothing.
void shadowed_text(ImDrawList& list, ImVec2 at, ImU32 colour, std::string_view text,
                   double alpha = 1, float wrap = 0);
/// Returns the width of a text in pixels.
float width_of(std::string_view text);
/// Returns the size in pixels of a text whose lines are wrapped to `wrap` pixels.
ImVec2 wrapped_size(std::string_view text, float wrap);
/// Returns an opaque colour of a material in ImGui's form, with its brightness multiplied by
/// `factor`. A transparent material shows a light ground through it.
ImU32 shaded_colour(const MaterialColour& colour, double factor);
/// Makes a button, which is grey and takes no clicks unless it is enabled. Returns true if it is
/// pressed.
bool enabled_button(const char* label, bool is_enabled);

}  // namespace runstone
