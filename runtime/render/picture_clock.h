// What the graphics card takes over pictures, without waiting for it at each. Internal to runtime/render.
#pragma once
#include <GLES3/gl3.h>

namespace flaneur {

struct PictureClock {
  GLuint query = 0;        // 0: the driver does not measure
  GLsync drawn = nullptr;  // reached once the last picture is there
  bool measured = false;   // the last picture, whose result has not been read yet
  double took_ms = 0;      // over the last picture that is known of; 0: none
};

// False where the driver does not measure.
bool CreatePictureClock(PictureClock* clock);
// Around the commands of a picture. The first waits for the picture before, so that no more than one is on its way.
void BeginPictureTime(PictureClock* clock);
void EndPictureTime(PictureClock* clock);
// Whether the last picture is still on its way. Never waits.
bool IsOnItsWay(const PictureClock& clock);

}  // namespace flaneur
