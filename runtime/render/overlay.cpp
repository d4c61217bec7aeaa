#include "runtime/render/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "runtime/render/font.h"
#include "runtime/render/gl_objects.h"

namespace flaneur {

struct Overlay::Impl {
  Program program;
  GLuint font = 0, array = 0, vertices = 0, indices = 0;
  float letter_px = 0;
  std::string texts;
  ImVector<ImWchar> letters;  // that the large font has; ImGui reads them later

  ~Impl() {
    if (ImGui::GetCurrentContext() != nullptr) ImGui::DestroyContext();
  }

  void CreateFont() {
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    if (font == 0) glGenTextures(1, &font);
    BindTexture(kColorUnit, font);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, pixels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
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
      glScissor(static_cast<GLint>(clip.x), static_cast<GLint>(height_px - clip.w),
                static_cast<GLsizei>(clip.z - clip.x), static_cast<GLsizei>(clip.w - clip.y));
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                     sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(size_t{command.IdxOffset} * sizeof(ImDrawIdx)));
    }
  }
};

Overlay::Overlay() : impl_(std::make_unique<Impl>()) {}
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

void Overlay::PrepareText(float letter_px, const std::string& texts) {
  Impl& o = *impl_;
  letter_px = std::max(4.0f, std::round(letter_px));
  if (letter_px == o.letter_px && texts == o.texts) return;
  o.letter_px = letter_px;
  o.texts = texts;
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  ImFontGlyphRangesBuilder builder;
  builder.AddRanges(fonts.GetGlyphRangesDefault());
  builder.AddText(texts.c_str());
  o.letters.clear();
  builder.BuildRanges(&o.letters);
  fonts.Clear();
  fonts.AddFontDefault();
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  const auto file = FontFile();
  // ImGui only reads the file, though it does not say so.
  fonts.AddFontFromMemoryTTF(const_cast<unsigned char*>(file.data()), static_cast<int>(file.size()), letter_px, &config,
                             o.letters.Data);
  o.CreateFont();
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
  BindTexture(kColorUnit, impl_->font);
  glBindVertexArray(impl_->array);
  for (int i = 0; i < data.CmdListsCount; ++i) impl_->DrawList(*data.CmdLists[i], data.DisplaySize.y);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

LargeText::LargeText() { ImGui::PushFont(ImGui::GetIO().Fonts->Fonts.back()); }
LargeText::~LargeText() { ImGui::PopFont(); }

}  // namespace flaneur
