// Captions of a program whose surroundings show them: a page, beside its picture.
#include "runtime/render/caption.h"
#include "runtime/text/fonts.h"

namespace flaneur {

struct Fonts::Impl {};
Fonts::~Fonts() = default;
Error CreateCaptionView(Fonts*, CaptionView*) { return Ok(); }
void DrawCaption(const FrameInput&, int, int, CaptionView*) {}

}  // namespace flaneur
