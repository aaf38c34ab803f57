#pragma once
#include <imgui.h>

namespace palpate {

// Blue and orange, which are distinguishable with colour blindness; warnings also say so in words.
inline const ImVec4 accent(0.16f, 0.47f, 0.76f, 1), warning(0.95f, 0.62f, 0.10f, 1),
    quiet(0.66f, 0.69f, 0.74f, 1);

inline constexpr float letters = 15, panel_width = 330;  // pixels, times the scale

/// A tooltip for the control before this.
inline void about(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

}  // namespace palpate
