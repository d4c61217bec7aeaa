// The visitor's photo on a page, with the code that leads to it. Internal to runtime/visit; between an Overlay's Begin
// and Draw.
#pragma once
#include <string>

#include "runtime/base/jobs.h"
#include "runtime/render/overlay.h"
#include "runtime/visit/menu.h"
#include "runtime/visit/page_look.h"
#include "runtime/visit/photo.h"

namespace flaneur {

// The last photo that was taken.
struct TakenPhoto {
  Photo photo;
  std::string id, link;  // link: empty: none
  OverlayPicture shown = nullptr, code = nullptr;
  int code_px = 0;
  Error error;       // of keeping it, once that is done
  bool told = true;  // the error
  Job keeping;       // last, so that it ends first
};

// A button for the page's end, and what became of the photo. `names_file`: visitors may know where it is kept.
void ShowPhotoPage(const TakenPhoto& taken, const std::string& folder, bool names_file, const PageLook& look,
                   int width_px, int height_px, Menu* menu, Overlay* overlay);

}  // namespace flaneur
