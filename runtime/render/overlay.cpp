#include "runtime/render/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "runtime/render/gl_objects.h"
#include "runtime/render/glyph_atlas.h"
#include "runtime/render/overlay_textures.h"

namespace flaneur {

struct Overlay::Impl {
  TextLayer text;
  Program program;
  GLuint font = 0, glyphs = 0, array = 0, vertices = 0, indices = 0;

  explicit Impl(Fonts* fonts) : text(fonts) {}
  ~Impl() {
    if (ImGui::GetCurrentContext() != nullptr) ImGui::DestroyContext();
  }

  static GLuint CreateTexture(int width_px, int height_px, const unsigned char* cover) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    BindTexture(kColorUnit, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width_px, height_px, 0, GL_RED, GL_UNSIGNED_BYTE, cover);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (GLenum channel : {GLenum{GL_TEXTURE_SWIZZLE_R}, GLenum{GL_TEXTURE_SWIZZLE_G}, GLenum{GL_TEXTURE_SWIZZLE_B}})
      glTexParameteri(GL_TEXTURE_2D, channel, GL_ONE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_A, GL_RED);  // so that letters are drawn as pictures are
    return texture;
  }

  GLuint TextureOf(ImTextureID id) const {
    const auto number = reinterpret_cast<uintptr_t>(id);
    return number >= kFirstPicture ? static_cast<GLuint>(number - kFirstPicture) : id == kGlyphTexture ? glyphs : font;
  }

  void CreateFont() {
    unsigned char* pixels = nullptr;
    int width_px = 0, height_px = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width_px, &height_px);
    font = CreateTexture(width_px, height_px, pixels);
  }

  // What has come to the glyphs since the last picture.
  void UploadGlyphs() {
    GlyphAtlas& atlas = text.atlas();
    if (atlas.changed_from >= atlas.changed_to) return;
    if (glyphs == 0) {
      glyphs = CreateTexture(kGlyphAtlas_px, kGlyphAtlas_px, atlas.cover.data());
    } else {
      BindTexture(kColorUnit, glyphs);
      glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, atlas.changed_from, kGlyphAtlas_px, atlas.changed_to - atlas.changed_from,
                      GL_RED, GL_UNSIGNED_BYTE, &atlas.cover[static_cast<size_t>(atlas.changed_from) * kGlyphAtlas_px]);
    }
    atlas.changed_from = atlas.changed_to = 0;
  }

  void CreateArrays() {
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    constexpr size_t stride = sizeof(ImDrawVert);
    vertices = CreateBuffer(GL_ARRAY_BUFFER, nullptr, 0);
    indices = CreateBuffer(GL_ELEMENT_ARRAY_BUFFER, nullptr, 0);
    EnableAttribute(ATTRIBUTE_POSITION, 2, GL_FLOAT, false, stride, offsetof(ImDrawVert, pos), 0);
    EnableAttribute(ATTRIBUTE_UV, 2, GL_FLOAT, false, stride, offsetof(ImDrawVert, uv), 0);
    EnableAttribute(ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(ImDrawVert, col), 0);
  }

  void DrawList(const ImDrawList& list, float height_px) const {
    glBindBuffer(GL_ARRAY_BUFFER, vertices);
    glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data, GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const ImVec4 clip = command.ClipRect;
      if (clip.z <= clip.x || clip.w <= clip.y) continue;
      BindTexture(kColorUnit, TextureOf(command.GetTexID()));
      glScissor(static_cast<GLint>(clip.x), static_cast<GLint>(height_px - clip.w),
                static_cast<GLsizei>(clip.z - clip.x), static_cast<GLsizei>(clip.w - clip.y));
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                     sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(size_t{command.IdxOffset} * sizeof(ImDrawIdx)));
    }
  }
};

Overlay::Overlay(Fonts* fonts) : impl_(std::make_unique<Impl>(fonts)) {}
Overlay::~Overlay() = default;

Error Overlay::Create() {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableGamepad;
  ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_HasGamepad;
  ImGui::StyleColorsDark();
  if (Error e = BuildProgram(ShaderProgram::kOverlay, &impl_->program)) return e;
  glReleaseShaderCompiler();
  impl_->CreateFont();
  impl_->CreateArrays();
  return Ok();
}

TextLayer& Overlay::text() { return impl_->text; }
OverlayPicture Overlay::AddPicture(int width_px, int height_px, const std::vector<uint8_t>& rgba) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  BindTexture(kColorUnit, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (GLenum wrap : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  return reinterpret_cast<OverlayPicture>(kFirstPicture + texture);
}

void Overlay::RemovePicture(OverlayPicture picture) {
  if (picture == nullptr) return;
  const auto texture = static_cast<GLuint>(reinterpret_cast<uintptr_t>(picture) - kFirstPicture);
  glDeleteTextures(1, &texture);
}

bool Overlay::HasPointer() const { return ImGui::GetIO().WantCaptureMouse; }

void Overlay::Begin(int width_px, int height_px, const OverlayInput& input) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width_px), static_cast<float>(height_px)};
  io.DeltaTime = input.passed_s > 0 ? input.passed_s : 1.0f / 60;
  io.KeyRepeatDelay = 0.6f + 4 * io.DeltaTime;  // where pictures are slow, a key tapped looks like one held
  io.MousePos = input.pointer_px.x >= 0 ? ImVec2{input.pointer_px.x, input.pointer_px.y} : ImVec2{-1e30f, -1e30f};
  io.MouseDown[0] = input.pressed;
  const auto hold = [&io](ImGuiNavInput_ which, bool held) { io.NavInputs[which] = held ? 1.0f : 0.0f; };
  hold(ImGuiNavInput_DpadUp, input.up);
  hold(ImGuiNavInput_DpadDown, input.down);
  hold(ImGuiNavInput_DpadLeft, input.left);
  hold(ImGuiNavInput_DpadRight, input.right);
  hold(ImGuiNavInput_Activate, input.activate);
  ImGui::NewFrame();
  impl_->text.BeginPicture();
}

void Overlay::Draw() {
  ImGui::Render();
  const ImDrawData& data = *ImGui::GetDrawData();
  glViewport(0, 0, static_cast<GLsizei>(data.DisplaySize.x), static_cast<GLsizei>(data.DisplaySize.y));
  glDisable(GL_DEPTH_TEST);
  CullBackFaces(false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);
  glUseProgram(impl_->program.id);
  SetUniform(impl_->program.size, Vec3{data.DisplaySize.x, data.DisplaySize.y, 0});
  impl_->UploadGlyphs();
  glBindVertexArray(impl_->array);
  for (int i = 0; i < data.CmdListsCount; ++i) impl_->DrawList(*data.CmdLists[i], data.DisplaySize.y);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

}  // namespace flaneur
