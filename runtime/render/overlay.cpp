#include "runtime/render/overlay.h"

#include <imgui.h>

#include <cstddef>

#include "runtime/render/gl_objects.h"
#include "runtime/render/shaders.h"

namespace flaneur {

struct Overlay::Impl {
  GLuint program = 0, font = 0, array = 0, vertices = 0, indices = 0;

  ~Impl() {
    if (ImGui::GetCurrentContext() != nullptr) ImGui::DestroyContext();
  }

  void CreateFont() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    glGenTextures(1, &font);
    glBindTexture(GL_TEXTURE_2D, font);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8, width, height);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, pixels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }

  void CreateArrays() {
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    constexpr size_t stride = sizeof(ImDrawVert);
    vertices = CreateBuffer(GL_ARRAY_BUFFER, nullptr, 0);
    indices = CreateBuffer(GL_ELEMENT_ARRAY_BUFFER, nullptr, 0);
    EnableAttribute(0, 2, GL_FLOAT, false, stride, offsetof(ImDrawVert, pos), 0);
    EnableAttribute(1, 2, GL_FLOAT, false, stride, offsetof(ImDrawVert, uv), 0);
    EnableAttribute(2, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(ImDrawVert, col), 0);
  }

  void DrawList(const ImDrawList& list, float height_px) const {
    glBindBuffer(GL_ARRAY_BUFFER, vertices);
    glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data, GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const ImVec4 clip = command.ClipRect;
      if (clip.z <= clip.x || clip.w <= clip.y) continue;
      glScissor(static_cast<GLint>(clip.x), static_cast<GLint>(height_px - clip.w), static_cast<GLsizei>(clip.z - clip.x),
                static_cast<GLsizei>(clip.w - clip.y));
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(size_t{command.IdxOffset} * sizeof(ImDrawIdx)));
    }
  }
};

Overlay::Overlay() : impl_(std::make_unique<Impl>()) {}
Overlay::~Overlay() = default;

Error Overlay::Create() {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::StyleColorsDark();
  if (Error e = BuildProgram(kOverlayVertex, kOverlayFragment, &impl_->program)) return e;
  impl_->CreateFont();
  impl_->CreateArrays();
  return Ok();
}

void Overlay::Begin(int width_px, int height_px, const OverlayInput& input) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width_px), static_cast<float>(height_px)};
  io.DeltaTime = input.passed_s > 0 ? input.passed_s : 1.0f / 60;
  io.MousePos = input.pointer_px.x >= 0 ? ImVec2{input.pointer_px.x, input.pointer_px.y} : ImVec2{-1e30f, -1e30f};
  io.MouseDown[0] = input.pressed;
  ImGui::NewFrame();
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
  glUseProgram(impl_->program);
  SetUniform(impl_->program, "u_size", Vec3{data.DisplaySize.x, data.DisplaySize.y, 0});
  BindTexture(kColorUnit, impl_->font);
  glBindVertexArray(impl_->array);
  for (int i = 0; i < data.CmdListsCount; ++i) impl_->DrawList(*data.CmdLists[i], data.DisplaySize.y);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

}  // namespace flaneur
