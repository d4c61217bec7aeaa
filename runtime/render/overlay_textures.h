// The textures of ImGui's draw lists. Internal to runtime/render.
#pragma once
#include <imgui.h>

#include <cstdint>

namespace flaneur {

// ImGui's own letters are the default, null.
inline const ImTextureID kGlyphTexture = reinterpret_cast<ImTextureID>(1);
// Beyond it: pictures, by their OpenGL name.
inline constexpr uintptr_t kFirstPicture = 16;

}  // namespace flaneur
