// The textures of ImGui's draw lists. Internal to runtime/render.
#pragma once
#include <imgui.h>

namespace flaneur {

// ImGui's own letters are the default, null.
inline const ImTextureID kGlyphTexture = reinterpret_cast<ImTextureID>(1);

}  // namespace flaneur
